//! Where the beams of a scan end, seen from the target frame.

use messages::Reading;

use super::BeamClass;
use super::lanes::{EndLanes, LANES};
use crate::EngineError;
use crate::beams::{BeamConfig, Chosen};
use crate::fit::readings::{Readings, is_sound};
use crate::observation::Observation;
use crate::space::Space;

/// The end points of a scan's beams, in cells; by default those of a scan
/// without beams. They can be found again for each scan, in the buffers of the one
/// before.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ends {
    chosen: Chosen,
    pub(crate) ends: Vec<End>,
    /// The same side by side.
    pub(super) lanes: Vec<EndLanes>,
    silent: Vec<f64>,
    readings: Readings,
    /// The weights of all beams together.
    pub(crate) weight: f64,
}

/// Where a beam ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct End {
    /// Where the laser was, cells in the target frame; its origin where the
    /// laser stood still.
    pub from: (f64, f64),
    /// In the target frame, radians.
    pub bearing: f64,
    /// Metres from the laser.
    pub reading_m: f64,
    /// The unit vector along the beam, in the target frame.
    pub towards: (f64, f64),
    /// Cells.
    pub reading: f64,
    /// How much the beam counts.
    pub weight: f64,
}

/// Ends farther off than this lie on no map that their pose is on, and have no say there, cells:
/// what is summed up of those that are nearer has room in 32 bits.
const FARTHEST: f64 = 1e6;

impl Ends {
    /// The ends of a scan's beams, thinned as for voting; bearings are not rounded.
    /// Where several lasers are joined, they are the beams of each, seen from its
    /// own place.
    ///
    /// # Errors
    /// If [`Observation::check`] refuses the scan.
    pub fn new<'a>(
        scan: impl Into<Observation<'a>>,
        space: &Space,
        config: &BeamConfig,
    ) -> Result<Self, EngineError> {
        let mut ends = Ends::default();
        ends.find(scan, space, config)?;
        Ok(ends)
    }

    /// The same in the buffers of a scan before; where it is refused, that scan
    /// stays.
    ///
    /// # Errors
    /// See [`Ends::new`].
    pub fn find<'a>(
        &mut self,
        scan: impl Into<Observation<'a>>,
        space: &Space,
        config: &BeamConfig,
    ) -> Result<(), EngineError> {
        let scan = scan.into();
        match scan {
            Observation::Still(scan) => {
                scan.check()?;
                self.clear();
                self.chosen.choose((&scan).into(), 0.0, space, config);
                let cell_m = space.resolution_m;
                self.ends.extend(self.chosen.beams.iter().map(|beam| {
                    let reading = (beam.reading_m, beam.reading_m / cell_m);
                    End::new((0.0, 0.0), beam.angle, reading, beam.weight)
                }));
                self.silent.extend_from_slice(&self.chosen.silent);
                self.sum_up();
                Ok(())
            }
            Observation::Carried(_) => {
                let mut readings = std::mem::take(&mut self.readings);
                let found = readings.find(scan, space, config);
                let taken = found.and_then(|()| self.take(&readings.found, space.resolution_m));
                self.readings = readings;
                taken
            }
        }
    }

    /// Beams that end somewhere.
    #[must_use]
    pub fn beams(&self) -> usize {
        self.ends.len()
    }

    fn clear(&mut self) {
        self.ends.clear();
        self.lanes.clear();
        self.silent.clear();
        self.weight = 0.0;
    }

    /// Fills in what follows from the ends.
    fn sum_up(&mut self) {
        self.weight = self.ends.iter().map(|end| end.weight).sum();
        self.lanes.clear();
        self.lanes.extend(self.ends.chunks(LANES).map(|ends| {
            let mut lanes = EndLanes::default();
            for (i, end) in ends.iter().enumerate() {
                let x = end.from.0 + end.reading * end.towards.0;
                let y = end.from.1 + end.reading * end.towards.1;
                if x.abs() <= FARTHEST && y.abs() <= FARTHEST {
                    (lanes.x[i], lanes.y[i]) = (x as f32, y as f32);
                    lanes.weight[i] = end.weight as f32;
                }
            }
            lanes
        }));
    }

    /// Takes the beams from a message, in the buffers of a scan before.
    ///
    /// # Errors
    /// If a number is not finite, or a beam has no length or a weight that none can
    /// have; nothing is left then.
    pub fn take(&mut self, readings: &[Reading], resolution_m: f64) -> Result<(), EngineError> {
        self.clear();
        for (beam, reading) in readings.iter().enumerate() {
            if !is_sound(reading) {
                self.clear();
                return Err(EngineError::Reading { beam });
            }
            if reading.range_m == f64::INFINITY {
                self.silent.push(reading.bearing);
                continue;
            }
            let from = (reading.from_x / resolution_m, reading.from_y / resolution_m);
            let range = (reading.range_m, reading.range_m / resolution_m);
            let end = End::new(from, reading.bearing, range, reading.weight);
            self.ends.push(end);
        }
        self.sum_up();
        Ok(())
    }

    #[cfg(test)]
    pub(super) fn of(ends: Vec<End>) -> Self {
        let mut all = Ends {
            ends,
            ..Ends::default()
        };
        all.sum_up();
        all
    }
}

/// A beam, and what became of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JudgedBeam {
    /// Where it ends, seen from the origin of the target frame (the laser's
    /// where it stood still): counter-clockwise from ahead, radians.
    pub bearing: f64,
    /// Metres from there.
    pub reading_m: f64,
    /// How much it counted.
    pub weight: f64,
    /// What became of it.
    pub class: BeamClass,
}

impl Ends {
    /// The beams that voted, with their classes: those of
    /// [`DistanceField::classes`](super::DistanceField::classes).
    pub fn judged(&self, classes: &[BeamClass]) -> impl Iterator<Item = JudgedBeam> {
        let both = self.ends.iter().zip(classes);
        both.map(|(end, &class)| {
            let (bearing, reading_m) = end.seen_from_origin();
            JudgedBeam {
                bearing,
                reading_m,
                weight: end.weight,
                class,
            }
        })
    }

    /// How many beams of equal weight would make scores that chance moves as much:
    /// Kish's effective sample size, (Σ w)² / Σ w².
    #[must_use]
    pub fn effective_beams(&self) -> f64 {
        self.effective(self.ends.iter().map(|end| end.weight))
    }

    /// How many pieces of equal weight the scan sees, where neighbouring readings
    /// that differ by more than this many metres lie on different pieces: Kish's
    /// effective sample size, as for [`Ends::effective_beams`]. The beams of one
    /// piece fit, or do not fit, together.
    #[must_use]
    pub fn effective_pieces(&self, apart_m: f64) -> f64 {
        let together = |a: &End, b: &End| (a.reading_m - b.reading_m).abs() <= apart_m;
        let pieces = self.ends.chunk_by(together);
        self.effective(pieces.map(|piece| piece.iter().map(|end| end.weight).sum()))
    }

    /// Of how many parts of equal weight a mean would be as uncertain; the weights of
    /// the parts are those of all beams together.
    fn effective(&self, weights: impl Iterator<Item = f64>) -> f64 {
        let squares: f64 = weights.map(|weight| weight * weight).sum();
        self.weight * self.weight / squares.max(f64::MIN_POSITIVE)
    }

    /// Bearings of the beams that say nothing, in the target frame, radians.
    #[must_use]
    pub fn silent(&self) -> &[f64] {
        &self.silent
    }

    /// Share of the beams by weight that are of a class, 0..=1; `classes` are
    /// those of [`DistanceField::classes`](super::DistanceField::classes).
    #[must_use]
    pub fn share(&self, classes: &[BeamClass], class: BeamClass) -> f64 {
        let both = self.ends.iter().zip(classes);
        let weights = both.filter(|&(_, &other)| other == class);
        let weight: f64 = weights.map(|(end, _)| end.weight).sum();
        weight / self.weight.max(f64::MIN_POSITIVE)
    }
}

impl End {
    /// An end at a bearing from a place in cells; the reading in metres and in cells.
    pub(super) fn new(
        from: (f64, f64),
        bearing: f64,
        (reading_m, reading): (f64, f64),
        weight: f64,
    ) -> Self {
        let (sin, cos) = bearing.sin_cos();
        End {
            from,
            bearing,
            reading_m,
            towards: (cos, sin),
            reading,
            weight,
        }
    }

    /// The direction of the beam where the target frame is turned.
    #[inline]
    pub(super) fn direction(&self, turn: (f64, f64)) -> (f64, f64) {
        turned(self.towards, turn)
    }

    /// Where the laser was from the target frame's origin, where that is turned.
    #[inline]
    pub(super) fn start(&self, turn: (f64, f64)) -> (f64, f64) {
        turned(self.from, turn)
    }

    /// Where the beam ends, seen from the origin of the target frame: bearing and
    /// metres.
    fn seen_from_origin(&self) -> (f64, f64) {
        if self.from == (0.0, 0.0) {
            return (self.bearing, self.reading_m);
        }
        let x = self.from.0 + self.reading * self.towards.0;
        let y = self.from.1 + self.reading * self.towards.1;
        let cell_m = self.reading_m / self.reading;
        (y.atan2(x), x.hypot(y) * cell_m)
    }
}

/// A vector that is turned by an angle, given as sine and cosine.
#[inline]
fn turned((x, y): (f64, f64), (sin, cos): (f64, f64)) -> (f64, f64) {
    (x * cos - y * sin, x * sin + y * cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scan_sees_another_piece_where_readings_leap() {
        let ends = |readings: &[(f64, f64)]| {
            let end = |&(reading_m, weight): &(f64, f64)| {
                End::new((0.0, 0.0), 0.0, (reading_m, 0.0), weight)
            };
            Ends::of(readings.iter().map(end).collect())
        };
        let check = |readings: &[(f64, f64)], expected: f64| {
            let pieces = ends(readings).effective_pieces(0.4);
            assert!((pieces - expected).abs() < 1e-12, "{readings:?}: {pieces}");
        };
        check(&[], 0.0);
        check(&[(2.0, 1.0), (2.3, 1.0), (2.6, 1.0), (2.9, 1.0)], 1.0);
        check(&[(2.0, 1.0), (2.3, 1.0), (4.0, 1.0), (4.0, 1.0)], 2.0);
        // Back at the same distance it is another piece, too; a small one counts
        // for less: (1 + 1 + 0.5)² / (1 + 1 + 0.25).
        check(&[(2.0, 1.0), (4.0, 0.5), (2.0, 1.0)], 6.25 / 2.25);
    }
}
