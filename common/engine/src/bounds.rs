//! Upper bounds of the votes in a block, for all headings at once.
//!
//! A bound replaces the taper by a flat top and a straight flank that lie
//! nowhere below it. Such a bound is a few operations on 16-bit numbers, side
//! by side for all headings; they are compiled for several instruction sets and
//! chosen when the program runs.

use crate::directions::Directions;
use crate::program::{ScanProgram, Taper};

/// Fractional bits of a flank's slope.
const SLOPE_BITS: u32 = 4;

/// A flank longer than this is taken as this long: its product with the slope
/// must fit 16 bits.
const LONGEST_FLANK: u16 = 255;

/// A scan program laid out for bounds: for each beam and heading, what the
/// beam can give along the direction that it then has.
#[derive(Debug, Clone)]
pub(crate) struct BoundProgram {
    headings: usize,
    beams: Vec<BoundBeam>,
    /// By beam and heading.
    centre: Vec<u16>,
    reach: Vec<u16>,
    slope: Vec<u16>,
}

#[derive(Debug, Clone, Copy)]
struct BoundBeam {
    bearing: usize,
    peak: u16,
}

/// Buffers for the intervals of one block, each direction twice in a row, so
/// that any bearing's are one slice.
#[derive(Debug, Clone)]
pub(crate) struct BlockRanges {
    nearest: Vec<u16>,
    end: Vec<u16>,
}

impl BlockRanges {
    pub(crate) fn new(headings: usize) -> Self {
        BlockRanges {
            nearest: vec![0; 2 * headings],
            end: vec![0; 2 * headings],
        }
    }

    pub(crate) fn set(&mut self, (nearest, end): (&[u16], &[u16])) {
        for (twice, once) in [(&mut self.nearest, nearest), (&mut self.end, end)] {
            let (first, second) = twice.split_at_mut(once.len());
            first.copy_from_slice(once);
            second.copy_from_slice(once);
        }
    }
}

impl BoundProgram {
    pub(crate) fn new(program: &ScanProgram, directions: &Directions) -> Self {
        let headings = directions.count();
        let entries = program.beams() * headings;
        let mut bounds = BoundProgram {
            headings,
            beams: Vec::with_capacity(program.beams()),
            centre: Vec::with_capacity(entries),
            reach: Vec::with_capacity(entries),
            slope: Vec::with_capacity(entries),
        };
        for beam in 0..program.beams() {
            let tapers: Vec<Taper<'_>> = (0..directions.classes())
                .map(|class| program.taper(beam, class))
                .collect();
            let slopes: Vec<u16> = tapers.iter().map(slope_above).collect();
            let bearing = program.bearing(beam);
            for heading in 0..headings {
                let class = directions.get(heading + bearing).class;
                bounds.centre.push(tapers[class].centre);
                bounds.reach.push(tapers[class].profile.len() as u16);
                bounds.slope.push(slopes[class]);
            }
            let peak = tapers[0].profile.first().copied().unwrap_or(0);
            bounds.beams.push(BoundBeam {
                bearing,
                peak: u16::from(peak),
            });
        }
        bounds
    }

    /// Bounds of a block's votes by heading.
    pub(crate) fn bound(&self, ranges: &BlockRanges, bounds: &mut [u16]) {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512bw") {
                // SAFETY: the processor has the features that the function is compiled for.
                return unsafe { self.bound_avx512(ranges, bounds) };
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: as above.
                return unsafe { self.bound_avx2(ranges, bounds) };
            }
        }
        self.bound_portable(ranges, bounds);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512vl")]
    fn bound_avx512(&self, ranges: &BlockRanges, bounds: &mut [u16]) {
        self.bound_portable(ranges, bounds);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn bound_avx2(&self, ranges: &BlockRanges, bounds: &mut [u16]) {
        self.bound_portable(ranges, bounds);
    }

    #[inline(always)]
    fn bound_portable(&self, ranges: &BlockRanges, bounds: &mut [u16]) {
        let bounds = &mut bounds[..self.headings];
        bounds.fill(0);
        let rows = self
            .centre
            .chunks_exact(self.headings)
            .zip(self.reach.chunks_exact(self.headings))
            .zip(self.slope.chunks_exact(self.headings));
        for (beam, ((centre, reach), slope)) in self.beams.iter().zip(rows) {
            let nearest = &ranges.nearest[beam.bearing..][..self.headings];
            let end = &ranges.end[beam.bearing..][..self.headings];
            for heading in 0..self.headings {
                let short = nearest[heading].saturating_sub(centre[heading]);
                let long = (centre[heading] + 1).saturating_sub(end[heading]);
                let flank = reach[heading]
                    .saturating_sub(short.max(long))
                    .min(LONGEST_FLANK);
                let votes = flank.wrapping_mul(slope[heading]) >> SLOPE_BITS;
                bounds[heading] += votes.min(beam.peak);
            }
        }
    }
}

/// The gentlest slope, in 1/16 votes a step, of a straight flank from the
/// taper's end that lies nowhere below the taper.
fn slope_above(taper: &Taper<'_>) -> u16 {
    let reach = taper.profile.len();
    let slopes = taper.profile.iter().enumerate().map(|(distance, &votes)| {
        let flank = (reach - distance).min(usize::from(LONGEST_FLANK));
        (usize::from(votes) << SLOPE_BITS).div_ceil(flank) as u16
    });
    slopes.max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::testing::{any_grid, any_scan, space_of};

    proptest! {
        #[test]
        fn no_range_within_an_interval_has_more_votes_than_the_bound(
            grid in any_grid(), scan in any_scan(), nearest in 0u16..60, length in 1u16..30,
        ) {
            let space = space_of(&grid, 40);
            let program = scan.program(&space);
            let bounds = BoundProgram::new(&program, &space.directions);
            let mut ranges = BlockRanges::new(40);
            ranges.set((&[nearest; 40], &[nearest + length; 40]));
            let mut row = [0; 40];
            bounds.bound(&ranges, &mut row);
            for (heading, &bound) in row.iter().enumerate() {
                let most: u16 = (0..program.beams()).map(|beam| {
                    let class = space.directions.get(heading + program.bearing(beam)).class;
                    let taper = program.taper(beam, class);
                    (nearest..nearest + length).map(|range| u16::from(taper.votes(range))).max().unwrap_or(0)
                }).sum();
                prop_assert!(most <= bound && u32::from(bound) <= program.highest_possible(), "{most} {bound}");
            }
        }

        #[test]
        fn every_instruction_set_gives_the_same_bounds(scan in any_scan(), values in prop::collection::vec(0u16..60, 96)) {
            let space = crate::space::Space::new(48, 0.1, 40, 40).unwrap();
            let bounds = BoundProgram::new(&scan.program(&space), &space.directions);
            let mut ranges = BlockRanges::new(48);
            ranges.set((&values[..48], &values[48..]));
            let (mut portable, mut chosen) = ([0; 48], [0; 48]);
            bounds.bound_portable(&ranges, &mut portable);
            bounds.bound(&ranges, &mut chosen);
            prop_assert_eq!(portable, chosen);
            #[cfg(target_arch = "x86_64")]
            if is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has AVX2.
                unsafe { bounds.bound_avx2(&ranges, &mut chosen) };
                prop_assert_eq!(portable, chosen);
            }
        }
    }
}
