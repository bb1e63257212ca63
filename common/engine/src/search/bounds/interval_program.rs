//! A scan program laid out for bounds from intervals of ranges.

use super::sectors;
use crate::directions::Directions;
use crate::program::ScanProgram;
use crate::search::index::bins::Bins;
use crate::simd::Simd;
use crate::simd::headings::BinVotes;
use crate::tables::TABLE;

/// A scan program laid out for bounds from intervals; made again for each scan.
#[derive(Debug, Clone, Default)]
pub(crate) struct IntervalProgram {
    pub(in crate::parts::search) directions: usize,
    pub(in crate::parts::search) simd: Simd,
    /// Beams by sector.
    beams: Vec<IntervalBeam>,
    /// Most votes that all beams after each sector give.
    rests: Vec<u16>,
}

/// A beam and its votes for ranges in bins: the table fills one cache line, the rest is in
/// the next.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(in crate::parts::search) struct IntervalBeam {
    pub votes: BinVotes,
    pub bearing: u16,
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
    pub(in crate::parts::search) fn sectors(&self) -> impl Iterator<Item = (&[IntervalBeam], u16)> {
        self.beams
            .chunks(sectors::BEAMS)
            .zip(self.rests.iter().copied())
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
