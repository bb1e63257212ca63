//! The order in which a block's beams are counted.
//!
//! Neighbouring beams need neighbouring directions, so beams are counted in sectors of
//! neighbours. Sectors that can give most votes come first: they decide most about a pose,
//! and counting can stop early.

use std::cmp::Reverse;
use std::ops::Range;

use crate::program::ScanProgram;

/// Beams of a sector. With fewer a heading is given up sooner, with more there are fewer
/// comparisons; this number was fastest. Their votes, at most 16 each, fit a byte.
pub(crate) const BEAMS: usize = 10;

/// Number of sectors of this many beams.
pub(crate) fn count(beams: usize) -> usize {
    beams.div_ceil(BEAMS)
}

/// Returns the beams of a sector, as places in the order.
pub(crate) fn beams(sector: usize, beams: usize) -> Range<usize> {
    sector * BEAMS..((sector + 1) * BEAMS).min(beams)
}

/// Puts the beams of a program in order. Only the last sector may have fewer than
/// [`BEAMS`].
pub(crate) fn order(program: &ScanProgram, order: &mut Vec<usize>) {
    order.clear();
    order.extend(0..program.beams());
    let (full, _) = order.as_chunks_mut::<BEAMS>();
    full.sort_unstable_by_key(|sector| {
        let votes: u16 = sector.iter().map(|&beam| program.peak(beam)).sum();
        (Reverse(votes), sector[0])
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::VoteConfig;
    use crate::space::Space;
    use crate::testing::scan_from;

    #[test]
    fn each_beam_comes_once_in_sectors_of_neighbours_the_weightiest_first() {
        for count in [1, 14, 15, 16, 180, 181, 400] {
            // Near readings on the left, far ones, which weigh more, on the right.
            let ranges: Vec<f32> = (0..count).map(|i| 1.0 + 0.03 * i as f32).collect();
            let scan = scan_from(-3.0, 0.015, &ranges);
            let mut config = VoteConfig::default();
            config.beams.max_beams = 1000;
            let space = Space::new(360, 0.05, 1000, 1000).expect("a small map");
            let program = ScanProgram::new(&scan, 0.0, &space, &config).expect("a sound scan");
            let mut order = vec![7];
            super::order(&program, &mut order);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..program.beams()).collect::<Vec<_>>());
            let sectors = (0..self::count(program.beams()))
                .map(|sector| &order[beams(sector, program.beams())]);
            let (full, last): (Vec<_>, Vec<_>) = sectors.partition(|sector| sector.len() == BEAMS);
            for sector in full.iter().chain(&last) {
                assert!(
                    sector.windows(2).all(|pair| pair[1] == pair[0] + 1),
                    "{sector:?}"
                );
            }
            let votes =
                |sector: &[usize]| sector.iter().map(|&beam| program.peak(beam)).sum::<u16>();
            assert!(full.is_sorted_by(|a, b| votes(a) >= votes(b)));
            assert!(
                count < 180 || full[0][0] > full[full.len() - 1][0],
                "{full:?}"
            );
        }
    }
}
