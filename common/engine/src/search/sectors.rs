//! The order in which a block's beams are counted.
//!
//! Neighbouring beams need neighbouring directions, so beams are counted in
//! sectors of neighbours. Sectors far from each other come first: they tell
//! most about a pose, and counting can stop early.

use std::ops::Range;

/// Beams of a sector: as many votes of at most 16 as fit into a byte.
pub(crate) const BEAMS: usize = 15;

/// How many sectors there are.
pub(crate) fn count(beams: usize) -> usize {
    beams.div_ceil(BEAMS)
}

/// The beams of a sector, as places in the order.
pub(crate) fn beams(sector: usize, beams: usize) -> Range<usize> {
    sector * BEAMS..((sector + 1) * BEAMS).min(beams)
}

/// The beams in order. Only the last sector may have less than [`BEAMS`].
pub(crate) fn order(beams: usize) -> impl Iterator<Item = usize> {
    let full = beams / BEAMS;
    // Numbers in the order of their bits from the last to the first.
    let digits = full.next_power_of_two().ilog2();
    let reversed = move |place: usize| (0..digits).fold(0, |all, i| 2 * all + (place >> i & 1));
    let sectors = (0..1 << digits).map(reversed);
    let sectors = sectors.filter(move |&sector| sector < full);
    let members = move |sector: usize| self::beams(sector, beams);
    sectors.chain([full]).flat_map(members)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_beam_comes_once_in_sectors_of_neighbours() {
        for count in [0, 1, 14, 15, 16, 180, 181, 400] {
            let order: Vec<usize> = order(count).collect();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..count).collect::<Vec<_>>());
            for sector in 0..self::count(count) {
                let members = &order[beams(sector, count)];
                assert!(
                    members.windows(2).all(|pair| pair[1] == pair[0] + 1),
                    "{members:?}"
                );
            }
        }
        assert_eq!(
            order(60).take(31).collect::<Vec<_>>(),
            (0..15).chain(30..45).chain([15]).collect::<Vec<_>>()
        );
    }
}
