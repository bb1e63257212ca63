//! Upper bounds of the votes in a block from its sets of visible ranges.
//!
//! A beam's taper is covered by nested windows of distances, each with a share
//! of its votes. Where a block sees no range within a window, at a heading, its
//! share is missing there. The bits of a window are read at the beam's bearing:
//! the whole bytes of it by where reading starts, the rest by grouping beams
//! and shifting the sums of each group once.

use crate::bits::{self, BitSum, EMPTY, Planes, Row};
use crate::directions::Directions;
use crate::program::ScanProgram;
use crate::sets::{Bins, BlockSets};

/// Headings of a chunk: a row less what shifting takes up.
const CHUNK: usize = 504;

/// Windows of a taper: more follow its flanks closer and take longer.
const WINDOWS: u16 = 4;

/// A scan program laid out for bounds from sets.
#[derive(Debug, Clone)]
pub(crate) struct SetProgram {
    headings: usize,
    /// Beams by bearing modulo 8.
    groups: [Vec<SetBeam>; 8],
}

/// A beam and the windows of its taper, from the innermost to the outermost.
#[derive(Debug, Clone)]
struct SetBeam {
    /// Bearing divided by 8.
    byte: usize,
    windows: Vec<Window>,
}

/// Bins `first..end` and the votes that are lost without any of them.
#[derive(Debug, Clone, Copy)]
struct Window {
    first: usize,
    end: usize,
    votes: u16,
}

/// Bounds of a block for all headings.
#[derive(Debug, Clone)]
pub(crate) struct SetBounds {
    chunks: Vec<(Planes, Row)>,
}

impl SetBounds {
    /// The greatest bound.
    pub(crate) fn greatest(&self) -> u16 {
        self.chunks
            .iter()
            .map(|(sums, valid)| bits::greatest(sums, *valid))
            .max()
            .unwrap_or(0)
    }

    /// The headings at which this block and the one around it have a bound of
    /// at least `least`, ascending.
    pub(crate) fn at_least(&self, least: u16, around: &SetBounds) -> impl Iterator<Item = usize> {
        self.chunks.iter().zip(&around.chunks).enumerate().flat_map(
            move |(chunk, (here, around))| {
                let around = bits::at_least(&around.0, least, around.1);
                let both = bits::at_least(&here.0, least, around);
                bits::ones(both).map(move |heading| chunk * CHUNK + heading)
            },
        )
    }

    /// The bound at a heading.
    pub(crate) fn at(&self, heading: usize) -> u16 {
        bits::number(&self.chunks[heading / CHUNK].0, heading % CHUNK)
    }
}

impl SetProgram {
    pub(crate) fn new(program: &ScanProgram, directions: &Directions) -> Self {
        let bins = Bins::new(directions);
        let mut groups = [const { Vec::new() }; 8];
        for beam in 0..program.beams() {
            let bearing = program.bearing(beam);
            let windows = windows(program, beam, directions, &bins);
            groups[bearing % 8].push(SetBeam {
                byte: bearing / 8,
                windows,
            });
        }
        SetProgram {
            headings: directions.count(),
            groups,
        }
    }

    /// Room for the bounds of a block.
    pub(crate) fn bounds(&self) -> SetBounds {
        let chunks = (0..self.headings).step_by(CHUNK).map(|first| {
            let headings = CHUNK.min(self.headings - first);
            let valid = std::array::from_fn(|word| match headings.saturating_sub(64 * word) {
                0 => 0,
                bits @ 1..64 => (1 << bits) - 1,
                _ => u64::MAX,
            });
            ([EMPTY; bits::PLANES], valid)
        });
        SetBounds {
            chunks: chunks.collect(),
        }
    }

    /// Bounds the votes of a block at all headings.
    pub(crate) fn bound(&self, block: &BlockSets, bounds: &mut SetBounds) {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512bw") && is_x86_feature_detected!("avx512vl") {
                // SAFETY: the processor has the features that the function is compiled for.
                return unsafe { self.bound_avx512(block, bounds) };
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: as above.
                return unsafe { self.bound_avx2(block, bounds) };
            }
        }
        self.bound_portable(block, bounds);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512vl")]
    fn bound_avx512(&self, block: &BlockSets, bounds: &mut SetBounds) {
        self.bound_portable(block, bounds);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn bound_avx2(&self, block: &BlockSets, bounds: &mut SetBounds) {
        self.bound_portable(block, bounds);
    }

    #[inline(always)]
    fn bound_portable(&self, block: &BlockSets, bounds: &mut SetBounds) {
        let mut sum = BitSum::new();
        for (chunk, (sums, _)) in bounds.chunks.iter_mut().enumerate() {
            *sums = [EMPTY; bits::PLANES];
            for (shift, group) in (0..).zip(&self.groups) {
                if group.is_empty() {
                    continue;
                }
                for beam in group {
                    add_beam(&mut sum, beam, block, beam.byte + chunk * CHUNK / 8);
                }
                let mut group_sums = sum.take();
                bits::shift_down(&mut group_sums, shift);
                bits::add(sums, &group_sums);
            }
        }
    }
}

/// Adds what a beam can give, reading rows from a byte on.
#[inline(always)]
fn add_beam(sum: &mut BitSum, beam: &SetBeam, block: &BlockSets, byte: usize) {
    let mut seen = EMPTY;
    let mut covered = 0..0;
    for window in &beam.windows {
        let end = window.end.min(block.bins());
        let first = window.first.min(end);
        if covered.is_empty() {
            covered = first..first;
        }
        for bin in (first..covered.start).chain(covered.end..end) {
            seen = bits::or(seen, block.read(bin, byte));
        }
        covered = first..end;
        sum.add(window.votes, seen);
    }
}

/// Windows that cover the taper of a beam in all classes of directions.
fn windows(
    program: &ScanProgram,
    beam: usize,
    directions: &Directions,
    bins: &Bins,
) -> Vec<Window> {
    let peak = program
        .taper(beam, 0)
        .profile
        .first()
        .map_or(0, |&peak| u16::from(peak));
    let step = peak.div_ceil(WINDOWS).next_power_of_two();
    let mut windows = Vec::new();
    // Levels of votes from the highest: `below` are left for wider windows.
    let mut above = peak;
    while above > 0 {
        let below = (above - 1) / step * step;
        let window = (0..directions.classes()).filter_map(|class| {
            let taper = program.taper(beam, class);
            let reach = taper
                .profile
                .partition_point(|&votes| u16::from(votes) > below) as u16;
            let nearest = taper.centre.saturating_sub(reach.checked_sub(1)?);
            Some((
                bins.bin(class, nearest),
                bins.bin(class, taper.centre + reach - 1) + 1,
            ))
        });
        let (first, end) = window.fold((usize::MAX, 0), |(first, end), (a, b)| {
            (first.min(a), end.max(b))
        });
        windows.push(Window {
            first,
            end: end.max(first),
            votes: above - below,
        });
        above = below;
    }
    windows
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::reference;
    use crate::sets::RangeSets;
    use crate::testing::{any_grid, any_scan, space_of};

    proptest! {
        #[test]
        fn no_pose_of_a_block_has_more_votes_than_its_bound(
            grid in any_grid(), scan in any_scan(), headings in prop_oneof![1usize..8, Just(45), Just(80)],
        ) {
            let space = space_of(&grid, 8 * headings as u32);
            let program = scan.program(&space);
            let set_program = SetProgram::new(&program, &space.directions);
            let fine = RangeSets::new(&grid, 8, &space.directions);
            let mut block_sets = BlockSets::new();
            for sets in [&fine, &fine.joined()] {
                let bounds: Vec<SetBounds> = (0..sets.blocks()).map(|block| {
                    let mut bounds = set_program.bounds();
                    block_sets.set(sets, block);
                    set_program.bound(&block_sets, &mut bounds);
                    bounds
                }).collect();
                // Some headings, spread over the turn, are enough to meet any error.
                for heading in (0..space.directions.count()).step_by(1 + headings / 8) {
                    let field = reference::field(&grid, &program, &space, heading);
                    for (i, &votes) in field.iter().enumerate() {
                        let (x, y) = (i % grid.width(), i / grid.width());
                        let block = &bounds[y / sets.side * sets.columns + x / sets.side];
                        prop_assert!(votes <= block.at(heading) && block.at(heading) <= block.greatest());
                        prop_assert!(votes == 0 || block.at_least(votes, block).any(|h| h == heading));
                    }
                }
                prop_assert!(bounds.iter().all(|block| u32::from(block.greatest()) <= program.highest_possible()));
            }
        }
    }
}
