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
pub(crate) fn order(beams: usize) -> Vec<usize> {
    let full = beams / BEAMS;
    let mut sectors: Vec<usize> = (0..full).collect();
    sectors.sort_by_key(|&sector| (sector as u16).reverse_bits());
    sectors.push(full);
    let members = |sector: usize| self::beams(sector, beams);
    sectors.into_iter().flat_map(members).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_beam_comes_once_in_sectors_of_neighbours() {
        for count in [0, 1, 14, 15, 16, 180, 181, 400] {
            let order = order(count);
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
            order(60)[..31],
            (0..15).chain(30..45).chain([15]).collect::<Vec<_>>()
        );
    }
}
