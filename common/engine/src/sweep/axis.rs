//! Sweeps along one axis: all beams, batch by batch.

use std::ops::Range;

use super::rows::Rows;
use super::{Plane, SweptBeam, Workspace};
use crate::program::MOST_VOTES;
use crate::simd::{Kernel, Set};

/// Largest number of beams that are swept together: their votes fit a byte, and their rows stay in a
/// near cache.
const BEAMS: usize = 15;

const _: () = assert!(BEAMS * MOST_VOTES <= u8::MAX as usize);

/// Rows that all batches pass before the next ones, so that their sums stay in a near cache.
const TILE_ROWS: usize = 32;

/// Kernel that adds up the votes of all beams along one axis.
pub(super) struct Axis<'a> {
    pub plane: &'a Plane,
    pub x_major: bool,
    pub workspace: &'a mut Workspace,
    pub stop: &'a dyn Fn() -> bool,
}

impl Kernel for Axis<'_> {
    type Result = Option<()>;

    #[inline(always)]
    fn run<S: Set>(self, set: S) -> Option<()> {
        let Workspace {
            beams,
            profiles,
            near,
            far,
            votes,
            sums_along_y,
            sums_along_x,
        } = self.workspace;
        let sums = if self.x_major {
            sums_along_x
        } else {
            sums_along_y
        };
        sums.clear();
        sums.resize(self.plane.cells.len(), 0);
        let is_of_axis = |beams: &&[SweptBeam]| beams[0].direction.x_major == self.x_major;
        for beams in beams.chunk_by(SweptBeam::is_along).filter(is_of_axis) {
            near.start(beams.len() * (self.plane.stride + 2));
            far.start(beams.len() * (self.plane.stride + 2));
            for start in (0..self.plane.rows).step_by(TILE_ROWS) {
                if (self.stop)() {
                    return None;
                }
                for (number, beams) in beams.chunks(BEAMS).enumerate() {
                    let batch = Batch {
                        plane: self.plane,
                        beams,
                        first: number * BEAMS,
                        profiles,
                    };
                    let steps = start..(start + TILE_ROWS).min(self.plane.rows);
                    batch.sweep(set, steps, (near, far), votes, sums);
                }
            }
        }
        Some(())
    }
}

/// Beams that are swept together; the sum of their votes fits a byte.
struct Batch<'a> {
    plane: &'a Plane,
    beams: &'a [SweptBeam],
    /// Number of rows of other beams before theirs.
    first: usize,
    profiles: &'a [u8],
}

impl Batch<'_> {
    #[inline(always)]
    fn sweep<S: Set>(
        &self,
        set: S,
        steps: Range<usize>,
        (near, far): (&mut Rows<u8>, &mut Rows<u16>),
        votes: &mut Vec<u8>,
        sums: &mut [u16],
    ) {
        let (count, stride) = (self.plane.rows, self.plane.stride);
        let forward = self.beams[0].direction.step > 0;
        votes.resize(stride, 0);
        for step in steps {
            let major = if forward { count - 1 - step } else { step };
            let cells = &self.plane.cells[major * stride..][..stride];
            votes.fill(0);
            for (number, beam) in (self.first..).zip(self.beams) {
                let minor = |major: i64| beam.direction.minor(major);
                let shift = minor(major as i64 + beam.direction.step) - minor(major as i64);
                let profile = (&self.profiles[beam.profile.start..], beam.profile.len());
                let place = (number * (stride + 2), step, shift);
                match beam.is_far() {
                    false => near.move_on(set, place, (cells, beam.end), profile, votes),
                    true => far.move_on(set, place, (cells, beam.end), profile, votes),
                }
            }
            for (sum, &votes) in sums[major * stride..].iter_mut().zip(&*votes) {
                *sum += u16::from(votes);
            }
        }
    }
}
