//! Upper bounds of the votes in a small block from its intervals of ranges.
//!
//! A beam votes most for the range of an interval that lies nearest to its
//! reading. Intervals of adjacent directions lie side by side, so one table
//! look-up bounds a beam at 64 headings.

use super::bits;
use super::intervals::{self, BlockIntervals};
use super::sectors;
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
    beams: Vec<IntervalBeam>,
    /// What all beams from each sector on can give.
    possible_from: Vec<u16>,
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
    pub(crate) fn make(
        &mut self,
        program: &ScanProgram,
        directions: &Directions,
        steps: &BinSteps,
        instruction_set: InstructionSet,
    ) {
        self.directions = directions.count();
        self.instruction_set = instruction_set;
        self.beams.clear();
        self.possible_from.clear();
        let sectors = sectors::count(program.beams());
        self.possible_from.resize(sectors + 1, 0);
        for (place, beam) in sectors::order(program.beams()).enumerate() {
            self.possible_from[place / sectors::BEAMS] += program.peak(beam);
            let beam = IntervalBeam::new(program, beam, directions, steps);
            self.beams.push(beam);
        }
        for sector in (0..sectors).rev() {
            self.possible_from[sector] += self.possible_from[sector + 1];
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
        match self.instruction_set {
            // SAFETY: the processor has the instruction set, see its choice.
            #[cfg(target_arch = "x86_64")]
            InstructionSet::Avx512 => unsafe {
                self.bound_avx512(block, heading, among, least, bounds)
            },
            _ => self.bound_portable(block, heading, among, least, bounds),
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

    fn bound_portable(
        &self,
        block: &BlockIntervals,
        heading: usize,
        among: u64,
        least: u16,
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
        for (sector, beams) in self.beams.chunks(sectors::BEAMS).enumerate() {
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
            let missing = least.saturating_sub(self.possible_from[sector + 1]);
            if lanes.iter().all(|&lane| bounds.all[lane] < missing) {
                return false;
            }
        }
        lanes.iter().any(|&lane| bounds.all[lane] >= least)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,avx512bw,avx512vl,avx512vbmi")]
    fn bound_avx512(
        &self,
        block: &BlockIntervals,
        heading: usize,
        among: u64,
        least: u16,
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
        for (sector, beams) in self.beams.chunks(sectors::BEAMS).enumerate() {
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
            let missing =
                _mm512_set1_epi16(least.saturating_sub(self.possible_from[sector + 1]) as i16);
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
