//! Where the beams of a scan end, seen from the laser.

use super::BeamClass;
use crate::EngineError;
use crate::beams::{Beam, BeamConfig, Chosen};
use crate::scan::Scan;
use crate::space::Space;

/// The end points of a scan's beams, in cells; by default those of a scan
/// without beams. They can be found anew for each scan, in the room of the one
/// before.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ends {
    chosen: Chosen,
    pub(super) ends: Vec<End>,
    /// The weights of all beams together.
    pub(super) weight: f64,
}

/// Where a beam ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
    /// In the laser's frame, radians.
    pub bearing: f64,
    /// Metres.
    pub reading_m: f64,
    /// The unit vector along the beam, in the laser's frame.
    pub towards: (f64, f64),
    /// Cells.
    pub reading: f64,
    /// How much the beam counts.
    pub weight: f64,
}

impl Ends {
    /// The ends of the beams that vote, of the scan as it is: bearings are not
    /// rounded.
    ///
    /// # Errors
    /// If [`Scan::check`] refuses the scan.
    pub fn new(scan: &Scan<'_>, space: &Space, config: &BeamConfig) -> Result<Self, EngineError> {
        let mut ends = Ends::default();
        ends.find(scan, space, config)?;
        Ok(ends)
    }

    /// The same in the room of a scan before; where it is refused, that scan
    /// stays.
    ///
    /// # Errors
    /// See [`Ends::new`].
    pub fn find(
        &mut self,
        scan: &Scan<'_>,
        space: &Space,
        config: &BeamConfig,
    ) -> Result<(), EngineError> {
        scan.check()?;
        self.chosen.choose(scan, 0.0, space, config);
        let end = |beam: &Beam| {
            let reading = beam.reading_m / space.resolution_m;
            End::new(beam.angle, (beam.reading_m, reading), beam.weight)
        };
        self.ends.clear();
        self.ends.extend(self.chosen.beams.iter().map(end));
        self.weight = self.ends.iter().map(|end| end.weight).sum();
        Ok(())
    }

    #[cfg(test)]
    pub(super) fn of(ends: Vec<End>) -> Self {
        Ends {
            weight: ends.iter().map(|end| end.weight).sum(),
            ends,
            chosen: Chosen::default(),
        }
    }
}

/// A beam, and what became of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JudgedBeam {
    /// In the laser's frame, counter-clockwise from ahead, radians.
    pub bearing: f64,
    /// Metres.
    pub reading_m: f64,
    /// How much it counted.
    pub weight: f64,
    /// What became of it.
    pub class: BeamClass,
}

impl Ends {
    /// The beams that voted, with their classes: those of
    /// [`Terrain::classes`](super::Terrain::classes).
    pub fn judged(&self, classes: &[BeamClass]) -> impl Iterator<Item = JudgedBeam> {
        let both = self.ends.iter().zip(classes);
        both.map(|(end, &class)| JudgedBeam {
            bearing: end.bearing,
            reading_m: end.reading_m,
            weight: end.weight,
            class,
        })
    }

    /// How many beams of equal weight would make scores that chance moves as much:
    /// Kish's effective sample size, (Σ w)² / Σ w².
    #[must_use]
    pub fn effective_beams(&self) -> f64 {
        self.effective(self.ends.iter().map(|end| end.weight))
    }

    /// How many pieces of equal weight the scan sees, where neighbouring readings
    /// that differ by more than so many metres lie on different pieces: Kish's
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

    /// Bearings of the beams that say nothing, in the laser's frame, radians.
    #[must_use]
    pub fn silent(&self) -> &[f64] {
        &self.chosen.silent
    }

    /// Share of the beams by weight that are of a class, 0..=1; `classes` are
    /// those of [`Terrain::classes`](super::Terrain::classes).
    #[must_use]
    pub fn share(&self, classes: &[BeamClass], class: BeamClass) -> f64 {
        let both = self.ends.iter().zip(classes);
        let weights = both.filter(|&(_, &other)| other == class);
        let weight: f64 = weights.map(|(end, _)| end.weight).sum();
        weight / self.weight.max(f64::MIN_POSITIVE)
    }
}

impl End {
    /// An end at a bearing; the reading in metres and in cells.
    pub(super) fn new(bearing: f64, (reading_m, reading): (f64, f64), weight: f64) -> Self {
        let (sin, cos) = bearing.sin_cos();
        End {
            bearing,
            reading_m,
            towards: (cos, sin),
            reading,
            weight,
        }
    }

    /// The direction of the beam where the laser is turned.
    #[inline]
    pub(super) fn direction(&self, (sin, cos): (f64, f64)) -> (f64, f64) {
        let (x, y) = self.towards;
        (x * cos - y * sin, x * sin + y * cos)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scan_sees_another_piece_where_readings_leap() {
        let ends = |readings: &[(f64, f64)]| {
            let end = |&(reading_m, weight): &(f64, f64)| End::new(0.0, (reading_m, 0.0), weight);
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
