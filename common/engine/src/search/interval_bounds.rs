//! Upper bounds of the votes in a small block from its intervals of ranges.
//!
//! A beam votes most for the range of an interval that lies nearest to its
//! reading. Intervals of adjacent directions lie side by side, so one table
//! look-up bounds a beam at 64 headings.

use super::bits;
use super::intervals::{self, BlockIntervals};
use super::sectors;
use super::set_bounds::Rests;
use super::steps::BinSteps;
use crate::directions::Directions;
use crate::instruction_set::InstructionSet;
use crate::program::ScanProgram;

/// Headings that are bounded at a time.
pub(crate) const HEADINGS: usize = intervals::READ;

/// Entries of a table; the first and the last stand for all bins beyond.
const TABLE: usize = 64;

/// Bounds of a block at adjacent headings.
#[derive(Debug, Clone)]
pub(crate) struct IntervalBounds {
    /// By all beams.
    pub all: [u16; HEADINGS],
    /// By each sector of beams, in the order in which they are counted.
    pub sectors: Vec<[u8; HEADINGS]>,
}

impl Default for IntervalBounds {
    fn default() -> Self {
        IntervalBounds {
            all: [0; HEADINGS],
            sectors: Vec::new(),
        }
    }
}

/// A scan program laid out for bounds from intervals; made anew for each scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct IntervalProgram {
    directions: usize,
    instruction_set: InstructionSet,
    by_sector: Order,
    /// By groups of beams as bounds from sets have them.
    by_group: Order,
    /// What all beams from each sector on can give.
    possible_from: Vec<u16>,
}

/// Some of the headings at which a block may matter, less than [`HEADINGS`] behind
/// the first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub first: u16,
    /// Those that may, from the first on.
    pub among: u64,
    /// What the beams from each group on give at most at any of them.
    pub rests: Rests,
}

/// An order in which beams are added.
#[derive(Debug, Clone, Default)]
struct Order {
    beams: Vec<IntervalBeam>,
    /// Pieces whose votes fit into a byte: where each ends, and how many sectors or
    /// groups are complete then.
    pieces: Vec<(usize, usize)>,
}

#[derive(Debug, Clone)]
#[repr(align(64))]
struct IntervalBeam {
    /// Most votes for a range in bins `base`, `base + 1`, …
    table: [u8; TABLE],
    bearing: u16,
    /// The bin of most votes.
    centre: u8,
    base: u8,
}

impl IntervalProgram {
    /// Lays out a program; `shifts` tell the groups of beams in their order, see
    /// [`SetProgram::shifts`](super::set_program::SetProgram::shifts).
    pub(crate) fn make(
        &mut self,
        program: &ScanProgram,
        directions: &Directions,
        steps: &BinSteps,
        shifts: impl Iterator<Item = u32>,
        instruction_set: InstructionSet,
    ) {
        self.directions = directions.count();
        self.instruction_set = instruction_set;
        let sectors = sectors::count(program.beams());
        self.possible_from.clear();
        self.possible_from.resize(sectors + 1, 0);
        self.by_sector.clear();
        for (place, beam) in sectors::order(program.beams()).enumerate() {
            self.possible_from[place / sectors::BEAMS] += program.peak(beam);
            let beam = IntervalBeam::new(program, beam, directions, steps);
            self.by_sector.beams.push(beam);
        }
        for sector in (0..sectors).rev() {
            self.possible_from[sector] += self.possible_from[sector + 1];
        }
        let ends = (0..sectors).map(|sector| sectors::beams(sector, program.beams()).end);
        self.by_sector.pieces.extend(ends.zip(1..));
        self.by_group.clear();
        for (group, shift) in shifts.enumerate() {
            let beams = self.by_sector.beams.iter();
            let beams = beams.filter(|beam| u32::from(beam.bearing % 8) == shift);
            let start = self.by_group.beams.len();
            self.by_group.beams.extend(beams.cloned());
            let end = self.by_group.beams.len();
            let full = (start..end).step_by(sectors::BEAMS).skip(1);
            let pieces = full.map(|end| (end, group)).chain([(end, group + 1)]);
            self.by_group.pieces.extend(pieces);
        }
    }

    /// Bounds the votes of a block at 64 headings from `heading` on, of which
    /// `among` matter. Whether any of those may have `least` votes; if not, the
    /// bounds are not finished.
    pub(crate) fn bound(
        &self,
        block: &BlockIntervals,
        heading: usize,
        among: u64,
        least: u16,
        bounds: &mut IntervalBounds,
    ) -> bool {
        let at = (block, heading, among);
        self.run(&self.by_sector, at, least, &self.possible_from, bounds)
    }

    /// The same at the headings of a window that is known of a block around it, but
    /// for the bounds of sectors. What is known of the beams that are missing tells
    /// sooner whether any heading may have so many votes.
    pub(crate) fn bound_within(
        &self,
        block: &BlockIntervals,
        window: &Window,
        least: u16,
        bounds: &mut IntervalBounds,
    ) -> bool {
        let at = (block, usize::from(window.first), window.among);
        self.run(&self.by_group, at, least, &window.rests, bounds)
    }

    /// `rests` has what the beams give at most that are missing when so many
    /// sectors or groups are complete.
    fn run(
        &self,
        order: &Order,
        at: (&BlockIntervals, usize, u64),
        least: u16,
        rests: &[u16],
        bounds: &mut IntervalBounds,
    ) -> bool {
        match self.instruction_set {
            // SAFETY: the processor has the instruction set, see its choice.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe { self.run_avx512(order, at, least, rests, bounds) },
            _ => self.run_portable(order, at, least, rests, bounds),
        }
    }

    /// The direction of a beam at a heading.
    #[inline(always)]
    fn direction(&self, beam: &IntervalBeam, heading: usize) -> usize {
        let direction = heading + usize::from(beam.bearing);
        if direction < self.directions {
            direction
        } else {
            direction - self.directions
        }
    }

    fn run_portable(
        &self,
        order: &Order,
        (block, heading, among): (&BlockIntervals, usize, u64),
        least: u16,
        rests: &[u16],
        bounds: &mut IntervalBounds,
    ) -> bool {
        bounds.all = [0; HEADINGS];
        bounds.sectors.clear();
        let [near_first, near_last, far_first, far_last] = &block.rows;
        let (mut lanes, mut count) = ([0; HEADINGS], 0);
        for lane in bits::ones(among) {
            lanes[count] = lane;
            count += 1;
        }
        let lanes = &lanes[..count];
        for (beams, complete) in order.pieces() {
            let mut bytes = [0u8; HEADINGS];
            for beam in beams {
                let start = self.direction(beam, heading);
                for &lane in lanes {
                    let d = start + lane;
                    let votes = |first: u8, last: u8| {
                        let bin = beam.centre.min(last).max(first);
                        let index = bin.saturating_sub(beam.base).min(TABLE as u8 - 1);
                        beam.table[usize::from(index)]
                    };
                    let most =
                        votes(near_first[d], near_last[d]).max(votes(far_first[d], far_last[d]));
                    bytes[lane] += most;
                }
            }
            for (all, &votes) in bounds.all.iter_mut().zip(&bytes) {
                *all += u16::from(votes);
            }
            bounds.sectors.push(bytes);
            let missing = least.saturating_sub(rests[complete]);
            if lanes.iter().all(|&lane| bounds.all[lane] < missing) {
                return false;
            }
        }
        lanes.iter().any(|&lane| bounds.all[lane] >= least)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512vbmi")]
    fn run_avx512(
        &self,
        order: &Order,
        (block, heading, among): (&BlockIntervals, usize, u64),
        least: u16,
        rests: &[u16],
        bounds: &mut IntervalBounds,
    ) -> bool {
        use std::arch::x86_64::*;
        let zero = _mm512_setzero_si512();
        let last = _mm512_set1_epi8(TABLE as i8 - 1);
        let [near_first, near_last, far_first, far_last] = &block.rows;
        let (mut low, mut high) = (zero, zero);
        // Widening puts lanes 0..8, 16..24, … into the low sums.
        let mut alive = false;
        bounds.sectors.clear();
        for (beams, complete) in order.pieces() {
            let mut bytes = zero;
            for beam in beams {
                let d = self.direction(beam, heading);
                // SAFETY: each slice is as long as what is read of it.
                let load = |row: &[u8]| unsafe {
                    _mm512_loadu_si512(row[d..d + HEADINGS].as_ptr().cast())
                };
                let centre = _mm512_set1_epi8(beam.centre as i8);
                let base = _mm512_set1_epi8(beam.base as i8);
                // SAFETY: the table has 64 entries.
                let table = unsafe { _mm512_load_si512(beam.table.as_ptr().cast()) };
                let votes = |first: __m512i, end: __m512i| {
                    let bin = _mm512_max_epu8(_mm512_min_epu8(centre, end), first);
                    let index = _mm512_min_epu8(_mm512_subs_epu8(bin, base), last);
                    _mm512_permutexvar_epi8(index, table)
                };
                let near = votes(load(near_first), load(near_last));
                let far = votes(load(far_first), load(far_last));
                bytes = _mm512_add_epi8(bytes, _mm512_max_epu8(near, far));
            }
            let mut stored = [0; HEADINGS];
            // SAFETY: the array holds the 64 bytes that are stored to it.
            unsafe { _mm512_storeu_si512(stored.as_mut_ptr().cast(), bytes) };
            bounds.sectors.push(stored);
            low = _mm512_add_epi16(low, _mm512_unpacklo_epi8(bytes, zero));
            high = _mm512_add_epi16(high, _mm512_unpackhi_epi8(bytes, zero));
            let missing = _mm512_set1_epi16(least.saturating_sub(rests[complete]) as i16);
            let reaching = unpacked_mask(
                _mm512_cmpge_epu16_mask(low, missing),
                _mm512_cmpge_epu16_mask(high, missing),
            );
            alive = reaching & among != 0;
            if !alive {
                break;
            }
        }
        let mut sums = [[0u16; HEADINGS / 2]; 2];
        // SAFETY: each half holds the 32 numbers that are stored to it.
        unsafe {
            _mm512_storeu_si512(sums[0].as_mut_ptr().cast(), low);
            _mm512_storeu_si512(sums[1].as_mut_ptr().cast(), high);
        }
        for (i, bounds) in bounds.all.chunks_exact_mut(8).enumerate() {
            bounds.copy_from_slice(&sums[i % 2][i / 2 * 8..][..8]);
        }
        alive
    }
}

/// The bits of 64 lanes in order, from those of the low and the high sums.
#[inline(always)]
fn unpacked_mask(low: u32, high: u32) -> u64 {
    let spread = |mask: u32| -> u64 {
        (0..4)
            .map(|i| u64::from(mask >> (8 * i) & 0xff) << (16 * i))
            .sum()
    };
    spread(low) | spread(high) << 8
}

impl Order {
    fn clear(&mut self) {
        self.beams.clear();
        self.pieces.clear();
    }

    #[inline(always)]
    fn pieces(&self) -> impl Iterator<Item = (&[IntervalBeam], usize)> {
        let mut start = 0;
        self.pieces.iter().map(move |&(end, complete)| {
            let beams = &self.beams[std::mem::replace(&mut start, end)..end];
            (beams, complete)
        })
    }
}

impl IntervalBeam {
    fn new(program: &ScanProgram, beam: usize, directions: &Directions, steps: &BinSteps) -> Self {
        // The most votes in each bin, over all classes of directions.
        let mut most = [0u8; 256];
        for class in 0..directions.classes() {
            let taper = program.taper(beam, class);
            let reach = taper.profile.len() as u16;
            // From the outside in, where votes only grow.
            for (distance, &votes) in (0..reach).zip(taper.profile).rev() {
                for at in [
                    taper.centre.saturating_sub(distance),
                    taper.centre + distance,
                ] {
                    let most = &mut most[usize::from(steps.bin(class, at))];
                    *most = (*most).max(votes);
                }
            }
        }
        let peak = most.iter().copied().max().unwrap_or(0);
        let centre = most.iter().position(|&votes| votes == peak).unwrap_or(0);
        // Never rising away from the centre, so that the nearest bin has most.
        for bin in 1..centre {
            most[bin] = most[bin].max(most[bin - 1]);
        }
        for bin in (centre + 1..most.len() - 1).rev() {
            most[bin] = most[bin].max(most[bin + 1]);
        }
        let first = most.iter().position(|&votes| votes > 0).unwrap_or(0);
        let end = most
            .iter()
            .rposition(|&votes| votes > 0)
            .map_or(0, |last| last + 1);
        // Where the taper is wider than the table, its middle lies there.
        let base = if end - first <= TABLE - 2 {
            first.saturating_sub(1)
        } else {
            centre
                .saturating_sub(TABLE / 2)
                .max(first.saturating_sub(1))
        };
        let mut table: [u8; TABLE] =
            std::array::from_fn(|i| most.get(base + i).copied().unwrap_or(0));
        // Nearer bins look up the first entry, farther ones the last: no bin
        // beyond them has more votes.
        table[0] = table[0].max(most[base]);
        IntervalBeam {
            table,
            bearing: program.bearing(beam) as u16,
            centre: centre as u8,
            base: base as u8,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::bits::Row;
    use super::super::descent::quarters;
    use super::super::index::SearchIndex;
    use super::super::set_bounds::{CHUNK, SetBounds};
    use super::super::task::{Programs, Shared, Task};
    use super::*;
    use crate::testing::{any_grid, any_scan, space_of};
    use crate::votes::CollectConfig;

    proptest! {
        #[test]
        fn what_is_known_of_the_block_around_changes_no_bound(
            grid in any_grid(), scan in any_scan(), headings in prop_oneof![1usize..8, Just(80)],
            share in 0.5..=1.0f64,
        ) {
            let space = space_of(&grid, 8 * headings as u32);
            let program = scan.program(&space);
            let index = SearchIndex::new(&grid, &space);
            let SearchIndex { coarse, fine, intervals, .. } = &index;
            let mut read = BlockIntervals::default();
            for instruction_set in InstructionSet::available() {
                let mut shared = Shared::default();
                let scan = (&program, &space);
                let task = Task::new(&mut shared, instruction_set, &index, &grid, scan, CollectConfig::default());
                let Programs { coarse: outer, fine: inner, interval, .. } = task.programs;
                let (mut outer_bounds, mut inner_bounds) = (SetBounds::default(), SetBounds::default());
                outer_bounds.fit(outer, task.headings());
                inner_bounds.fit(inner, task.headings());
                let (mut alone, mut known) = (IntervalBounds::default(), IntervalBounds::default());
                for block in 0..fine.blocks() {
                    let (x, y) = (block % fine.columns / 2, block / fine.columns / 2);
                    let around = outer.bound((coarse, y * coarse.columns + x), &mut outer_bounds);
                    let [found, ..] = inner.bound_within((fine, &[block]), 1, around, &mut inner_bounds);
                    if !found {
                        continue;
                    }
                    let within = &inner_bounds.blocks[0];
                    let least = (f64::from(within.greatest()) * share) as u16;
                    let masks: Vec<Row> = within.at_least(least.max(1), around).collect();
                    for (chunk, mut mask) in masks.into_iter().enumerate() {
                        while let Some((first, among)) = bits::take_window(&mut mask) {
                            let rests = inner.rests(within, chunk, bits::row_of((first, among)));
                            let first = chunk * CHUNK + first;
                            let window = Window { first: first as u16, among, rests };
                            let sides = (intervals.columns, intervals.rows);
                            for small in quarters(block, fine.columns, sides) {
                                intervals.read(small, &mut read);
                                let plain = interval.bound(&read, first, among, least, &mut alone);
                                let found = interval.bound_within(&read, &window, least, &mut known);
                                prop_assert_eq!(found, plain);
                                for lane in bits::ones(among).filter(|_| plain) {
                                    prop_assert_eq!(known.all[lane], alone.all[lane]);
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}
