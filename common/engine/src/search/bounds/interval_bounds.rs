//! Upper bounds of the votes in a small block from its intervals of ranges.
//!
//! A beam votes most for the range of an interval that is nearest to its reading. Intervals
//! of adjacent directions are adjacent in memory, so one table look-up bounds a beam at 64
//! headings.

use super::sectors;
use crate::directions::{Directions, turned};
use crate::program::ScanProgram;
use crate::search::index::bins::Bins;
use crate::search::index::bits::ones;
use crate::search::index::intervals::BlockIntervals;
use crate::simd::headings::{self, BinVotes, HEADINGS};
use crate::simd::{Kernel, Set, Simd, TABLE};

/// A scan program laid out for bounds from intervals; made again for each scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct IntervalProgram {
    directions: usize,
    simd: Simd,
    /// Beams by sector.
    beams: Vec<IntervalBeam>,
    /// Most votes that all beams after each sector give.
    rests: Vec<u16>,
}

/// A beam and its votes for ranges in bins: the table fills one cache line, the rest is in
/// the next.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
struct IntervalBeam {
    votes: BinVotes,
    bearing: u16,
}

impl IntervalProgram {
    /// Lays out a program. Its beams are in the order of [`sectors::order`].
    pub(crate) fn make(
        &mut self,
        (program, order): (&ScanProgram, &[usize]),
        directions: &Directions,
        bins: &Bins,
        simd: Simd,
    ) {
        self.directions = directions.count();
        self.simd = simd;
        self.beams.clear();
        let beams = order.iter();
        let beams = beams.map(|&beam| IntervalBeam::new(program, beam, directions, bins));
        self.beams.extend(beams);
        self.rests.clear();
        let mut rest = 0;
        for sector in order.chunks(sectors::BEAMS).rev() {
            self.rests.push(rest);
            rest += sector.iter().map(|&beam| program.peak(beam)).sum::<u16>();
        }
        self.rests.reverse();
    }

    /// Returns the beams of each sector, and the most votes that those after it give.
    #[inline(always)]
    fn sectors(&self) -> impl Iterator<Item = (&[IntervalBeam], u16)> {
        self.beams
            .chunks(sectors::BEAMS)
            .zip(self.rests.iter().copied())
    }

    /// Bounds the votes of a block at the 64 headings from `first` on. Returns true if any of
    /// these may have `least` votes; if not, the bounds are left unfinished. `DETAILED` finds the
    /// bounds of sectors and beams, too.
    pub(crate) fn bound<const DETAILED: bool>(
        &self,
        block: &BlockIntervals,
        first: usize,
        least: u16,
        bounds: &mut IntervalBounds,
    ) -> bool {
        self.simd.run(Bounding::<DETAILED> {
            program: self,
            block,
            first,
            least,
            bounds,
        })
    }
}

impl IntervalBeam {
    fn new(program: &ScanProgram, beam: usize, directions: &Directions, bins: &Bins) -> Self {
        // Most votes in each bin, over all classes of directions.
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
                    let most = &mut most[usize::from(bins.bin(class, at))];
                    *most = (*most).max(votes);
                }
            }
        }
        let peak = most.iter().copied().max().unwrap_or(0);
        let centre = most.iter().position(|&votes| votes == peak).unwrap_or(0);
        // Votes never rise away from the centre, so the nearest bin has most.
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
        // If the taper is wider than the table, the table holds its middle.
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
        let used = table.iter().rposition(|&votes| votes > 0);
        IntervalBeam {
            votes: BinVotes {
                table,
                used: used.map_or(0, |last| last + 1) as u8,
                centre: centre as u8,
                base: base as u8,
            },
            bearing: program.bearing(beam) as u16,
        }
    }
}

/// Upper bounds of a block's votes at adjacent headings.
#[derive(Debug, Clone)]
pub(crate) struct IntervalBounds {
    /// Bounds for all beams together.
    pub all: [u16; HEADINGS],
    /// Bounds for each sector of beams, in the order in which they are counted.
    pub sectors: Vec<[u8; HEADINGS]>,
    /// Headings at which each beam may vote, as bits, with the beams in that order.
    pub voting: Vec<u64>,
}

impl Default for IntervalBounds {
    fn default() -> Self {
        IntervalBounds {
            all: [0; HEADINGS],
            sectors: Vec::new(),
            voting: Vec::new(),
        }
    }
}

impl IntervalBounds {
    /// Returns the headings that a word selects with a bound of at least `least`, as bits, and
    /// the greatest of these bounds.
    pub(crate) fn reach(&self, least: u16, among: u64) -> (u64, u16) {
        let reaching = ones(among).filter(|&lane| self.all[lane] >= least);
        reaching.fold((0, 0), |(reach, most), lane| {
            (reach | 1 << lane, most.max(self.all[lane]))
        })
    }
}

/// Kernel that bounds a block; `DETAILED` finds the bounds of sectors and beams, too.
struct Bounding<'a, const DETAILED: bool> {
    program: &'a IntervalProgram,
    block: &'a BlockIntervals,
    first: usize,
    least: u16,
    bounds: &'a mut IntervalBounds,
}

impl<const DETAILED: bool> Kernel for Bounding<'_, DETAILED> {
    type Result = bool;

    #[inline(always)]
    fn run<S: Set>(self, set: S) -> bool {
        let Bounding {
            program,
            block,
            first,
            least,
            bounds,
        } = self;
        let rows = block.rows();
        bounds.all = [0; HEADINGS];
        bounds.sectors.clear();
        bounds.voting.clear();
        for (beams, rest) in program.sectors() {
            let mut votes = [0; HEADINGS];
            for beam in beams {
                let direction = turned(first, beam.bearing.into(), program.directions);
                let of_beam = beam.votes.add(set, rows.from(direction), &mut votes);
                if DETAILED {
                    bounds.voting.push(headings::present(set, of_beam));
                }
            }
            let mut most = 0;
            for (all, votes) in bounds.all.iter_mut().zip(votes) {
                *all += u16::from(votes);
                most = most.max(*all);
            }
            if DETAILED {
                bounds.sectors.push(votes);
            }
            if most + rest < least {
                return false;
            }
        }
        true
    }
}
