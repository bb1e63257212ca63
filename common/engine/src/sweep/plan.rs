//! Batches of beams that are swept together, and the places of their rows of cells.

use std::ops::Range;

use crate::accumulator::Query;
use crate::directions::Direction;
use crate::simd::Set;
use crate::simd::bytes::{Lanes, Lookup, MAX_REACH};

/// Bytes of rows that are swept together: they must stay in the nearest cache, along with
/// the votes.
const NEAR_BYTES: usize = 32 << 10;

/// Largest number of beams that are swept together.
pub(super) const MAX_BEAMS: usize = 32;

/// Number of groups of directions, each with one major axis and one sense along it.
pub(super) const GROUPS: usize = 4;

/// A beam at a heading.
#[derive(Debug, Clone)]
pub(super) struct SweptBeam {
    pub direction: Direction,
    pub lookup: Lookup,
    /// Steps left in an obstacle: those from there to the taper's end.
    pub end: u16,
    /// True if the end takes 16 bits.
    pub is_far: bool,
    /// Most votes of the beam.
    pub peak: u8,
    /// Start of the beam's row in the store of rows.
    pub row: usize,
}

/// Beams that are swept together; the sum of their votes fits a byte.
#[derive(Debug, Clone)]
pub(super) struct Batch {
    pub beams: Range<usize>,
    pub is_far: bool,
}

/// All beams of a scan at a heading, in the order in which they are swept.
#[derive(Debug, Clone, Default)]
pub(super) struct Plan {
    pub beams: Vec<SweptBeam>,
    /// Batches of each group; those whose ends take 8 bits come first.
    pub batches: [Vec<Batch>; GROUPS],
    /// Beams whose tapers are too wide for a [`Lookup`].
    pub wide: Vec<usize>,
    /// Number of cache lines that the rows of all beams take.
    pub lines: usize,
}

pub(super) fn group(direction: &Direction) -> usize {
    2 * usize::from(direction.x_major) + usize::from(direction.step > 0)
}

impl Plan {
    /// Plans a scan at a heading on a grid of this many cells.
    pub(super) fn make<S: Set>(
        &mut self,
        set: S,
        query: Query<'_>,
        (width, height): (usize, usize),
    ) {
        self.beams.clear();
        self.wide.clear();
        for i in 0..query.program.beams() {
            let (direction, taper) = query.beam(i);
            let reach = taper.profile.len();
            if reach > MAX_REACH {
                self.wide.push(i);
            } else if reach > 0 {
                let end = taper.centre + reach as u16;
                let highest = end.min(255) as u8;
                self.beams.push(SweptBeam {
                    direction: *direction,
                    lookup: S::Bytes::lookup(set, &taper, highest),
                    end,
                    is_far: end > 255,
                    peak: taper.profile[0],
                    row: 0,
                });
            }
        }
        self.beams
            .sort_unstable_by_key(|beam| (group(&beam.direction), beam.is_far, beam.lookup.kind));
        self.split::<S::Bytes>((width, height));
    }

    /// Splits the beams into batches and gives each beam its row.
    fn split<L: Lanes>(&mut self, (width, height): (usize, usize)) {
        self.batches.iter_mut().for_each(Vec::clear);
        let (mut line, mut votes) = (0, 0);
        for i in 0..self.beams.len() {
            let beam = &mut self.beams[i];
            let (_, columns) = beam.direction.swap((width, height));
            let lines = row_bytes::<L>(columns, beam.is_far).div_ceil(64);
            beam.row = 64 * line;
            line += lines;
            let most = (NEAR_BYTES / (64 * lines)).clamp(1, MAX_BEAMS);
            let peak = u32::from(beam.peak);
            let batches = &mut self.batches[group(&beam.direction)];
            match batches.last_mut() {
                Some(batch)
                    if batch.is_far == beam.is_far
                        && batch.beams.len() < most
                        && votes + peak <= 255 =>
                {
                    batch.beams.end = i + 1;
                    votes += peak;
                }
                _ => {
                    batches.push(Batch {
                        beams: i..i + 1,
                        is_far: beam.is_far,
                    });
                    votes = peak;
                }
            }
        }
        self.lines = line;
    }
}

/// Bytes that a beam's row takes: its cells, a vector for moving them to and fro, and a
/// margin on either side.
fn row_bytes<L: Lanes>(columns: usize, is_far: bool) -> usize {
    (columns.div_ceil(L::WIDTH) + 3) * L::WIDTH * (1 + usize::from(is_far))
}
