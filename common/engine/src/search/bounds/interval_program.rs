//! A scan program laid out for bounds from intervals of ranges.

use super::sectors;
use crate::directions::Directions;
use crate::program::ScanProgram;
use crate::search::index::steps::BinSteps;
use crate::simd::Simd;
use crate::simd::headings::BinVotes;
use crate::tables::TABLE;

/// Number of beams whose votes, at most 16 each, fit a byte together.
const BEAMS_OF_A_BYTE: usize = 15;

/// A scan program laid out for bounds from intervals; made again for each scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct IntervalProgram {
    pub(in crate::search) directions: usize,
    pub(in crate::search) simd: Simd,
    pub(in crate::search) by_sector: Order,
    /// Beams in the groups of the bounds from sets.
    pub(in crate::search) by_group: Order,
    /// Most votes that all beams from each sector on give.
    pub(in crate::search) possible_from: Vec<u16>,
}

/// An order in which beams are added.
#[derive(Debug, Clone, Default)]
pub(in crate::search) struct Order {
    beams: Vec<IntervalBeam>,
    /// Pieces whose votes fit a byte: the end of each, and the number of sectors or groups that
    /// are complete there.
    pieces: Vec<(usize, usize)>,
}

/// A beam and its votes for ranges in bins: the table fills one cache line, the rest is in
/// the next.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(in crate::search) struct IntervalBeam {
    pub votes: BinVotes,
    pub bearing: u16,
}

impl IntervalProgram {
    /// Lays out a program. Its beams are in the order of [`sectors::order`]; `shifts` gives
    /// their groups, see [`SetProgram::shifts`](super::set_program::SetProgram::shifts).
    pub(crate) fn make(
        &mut self,
        (program, order): (&ScanProgram, &[usize]),
        directions: &Directions,
        steps: &BinSteps,
        shifts: impl Iterator<Item = u32>,
        simd: Simd,
    ) {
        self.directions = directions.count();
        self.simd = simd;
        let sectors = sectors::count(program.beams());
        self.possible_from.clear();
        self.possible_from.resize(sectors + 1, 0);
        self.by_sector.clear();
        for (place, &beam) in order.iter().enumerate() {
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
            let full = (start..end).step_by(BEAMS_OF_A_BYTE).skip(1);
            let pieces = full.map(|end| (end, group)).chain([(end, group + 1)]);
            self.by_group.pieces.extend(pieces);
        }
    }
}

impl Order {
    fn clear(&mut self) {
        self.beams.clear();
        self.pieces.clear();
    }

    #[inline(always)]
    pub(in crate::search) fn pieces(&self) -> impl Iterator<Item = (&[IntervalBeam], usize)> {
        let mut start = 0;
        self.pieces.iter().map(move |&(end, complete)| {
            let beams = &self.beams[std::mem::replace(&mut start, end)..end];
            (beams, complete)
        })
    }
}

impl IntervalBeam {
    fn new(program: &ScanProgram, beam: usize, directions: &Directions, steps: &BinSteps) -> Self {
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
                    let most = &mut most[usize::from(steps.bin(class, at))];
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
