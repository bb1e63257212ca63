//! End points of the beams of a scan, seen from the target frame.

use messages::Reading;

use super::distance_field::LANES;
use super::pull::EndLanes;
use crate::EngineError;
use crate::beams::BeamConfig;
use crate::fit::readings::{Readings, is_sound, still};
use crate::observation::Observation;
use crate::space::Space;

/// End points of a scan's beams, in cells; the default has no beams. The buffers are reused from
/// scan to scan.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ends {
    pub(crate) ends: Vec<End>,
    /// Copy of `ends` in groups of eight.
    pub(super) lanes: Vec<EndLanes>,
    silent: Vec<f64>,
    readings: Readings,
    /// Total weight of the beams.
    pub(crate) weight: f64,
}

/// End point of a beam.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct End {
    /// Position of the laser at the beam's time, in cells in the target frame; (0, 0) without
    /// motion compensation.
    pub from: (f64, f64),
    /// Bearing in the target frame, in radians.
    pub bearing: f64,
    /// Distance from the laser, in metres.
    pub reading_m: f64,
    /// Unit vector along the beam, in the target frame.
    pub towards: (f64, f64),
    /// Distance from the laser, in cells.
    pub reading: f64,
    /// Weight of the beam.
    pub weight: f64,
}

/// Largest coordinate of an end that counts, in cells: farther ends are off any map that contains
/// their pose, and sums over nearer ones fit in 32 bits.
const FARTHEST: f64 = 1e6;

impl Ends {
    /// Finds the ends of a scan's beams, thinned as for voting; bearings are not rounded. With
    /// several lasers, each beam is seen from its own laser's pose.
    ///
    /// # Errors
    /// If [`Observation::check`] rejects the scan.
    pub fn new<'a>(
        scan: impl Into<Observation<'a>>,
        space: &Space,
        config: &BeamConfig,
    ) -> Result<Self, EngineError> {
        let mut ends = Ends::default();
        ends.find(scan, space, config)?;
        Ok(ends)
    }

    /// Does the same in the buffers of the scan before, which is kept if the scan is rejected.
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
        scan.check()?;
        let mut readings = std::mem::take(&mut self.readings);
        match scan {
            Observation::Still(scan) => readings.collect(&[still(scan)], space, config),
            Observation::Carried(scans) => readings.collect(scans, space, config),
        }
        let taken = self.take(&readings.found, space.resolution_m);
        self.readings = readings;
        taken
    }

    /// Number of beams with an end.
    pub fn beams(&self) -> usize {
        self.ends.len()
    }

    fn clear(&mut self) {
        self.ends.clear();
        self.lanes.clear();
        self.silent.clear();
        self.weight = 0.0;
    }

    /// Computes what follows from the ends.
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

    /// Takes the beams from a message, in the buffers of the scan before.
    ///
    /// # Errors
    /// If a position, bearing or weight is not finite, a range is not above 0, or a weight is not
    /// within 0..=2; no beams are left then.
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

/// Class of a beam at a pose, by its agreement with the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BeamClass {
    /// The beam ends at an obstacle.
    Hit,
    /// The beam ends in the open, at something that is not on the map.
    Short,
    /// The beam passes through an obstacle of the map.
    Through,
    /// The beam ends behind unknown space, where the map has no information.
    Unknown,
}

/// A beam with its class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JudgedBeam {
    /// Bearing of the end, seen from the origin of the target frame (the laser, without motion
    /// compensation): counter-clockwise from ahead, in radians.
    pub bearing: f64,
    /// Distance of the end from there, in metres.
    pub reading_m: f64,
    /// Weight of the beam.
    pub weight: f64,
    /// Agreement of the beam with the map.
    pub class: BeamClass,
}

impl Ends {
    /// Pairs the beams that voted with their classes from
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

    /// Returns the number of beams of equal weight whose score would vary as much by chance: Kish's
    /// effective sample size, (Σ w)² / Σ w².
    pub fn effective_beams(&self) -> f64 {
        self.effective(self.ends.iter().map(|end| end.weight))
    }

    /// Returns the effective number of pieces of equal weight that the scan sees, by Kish's formula
    /// as in [`Ends::effective_beams`]. A new piece begins where neighbouring readings differ by
    /// more than `apart_m` metres. The beams of one piece fit, or do not fit, together.
    #[must_use]
    pub fn effective_pieces(&self, apart_m: f64) -> f64 {
        let together = |a: &End, b: &End| (a.reading_m - b.reading_m).abs() <= apart_m;
        let pieces = self.ends.chunk_by(together);
        self.effective(pieces.map(|piece| piece.iter().map(|end| end.weight).sum()))
    }

    /// Returns the number of parts of equal weight whose mean would be as uncertain; the weights of
    /// the parts add up to that of all beams.
    fn effective(&self, weights: impl Iterator<Item = f64>) -> f64 {
        let squares: f64 = weights.map(|weight| weight * weight).sum();
        self.weight * self.weight / squares.max(f64::MIN_POSITIVE)
    }

    /// Bearings of the silent beams in the target frame, in radians.
    pub fn silent(&self) -> &[f64] {
        &self.silent
    }

    /// Returns the share of the beams, by weight, that are of a class, 0..=1; `classes` are those
    /// of [`DistanceField::classes`](super::DistanceField::classes).
    #[must_use]
    pub fn share(&self, classes: &[BeamClass], class: BeamClass) -> f64 {
        let both = self.ends.iter().zip(classes);
        let weights = both.filter(|&(_, &other)| other == class);
        let weight: f64 = weights.map(|(end, _)| end.weight).sum();
        weight / self.weight.max(f64::MIN_POSITIVE)
    }
}

impl End {
    /// Makes an end at a bearing from a position in cells, with the reading in metres and in cells.
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

    /// Direction of the beam when the target frame is turned.
    #[inline]
    pub(super) fn direction(&self, turn: (f64, f64)) -> (f64, f64) {
        turned(self.towards, turn)
    }

    /// Position of the laser from the target frame's origin when that frame is turned.
    #[inline]
    pub(super) fn start(&self, turn: (f64, f64)) -> (f64, f64) {
        turned(self.from, turn)
    }

    /// Bearing and distance in metres of the end, seen from the origin of the target frame.
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

/// Turns a vector by an angle, given as sine and cosine.
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
        // A return to the same distance is a new piece, too, and a small piece counts for less:
        // (1 + 1 + 0.5)² / (1 + 1 + 0.25).
        check(&[(2.0, 1.0), (4.0, 0.5), (2.0, 1.0)], 6.25 / 2.25);
    }
}
