//! Where the beams of a scan end, seen from the laser.

use super::BeamClass;
use crate::EngineError;
use crate::beams::{self, BeamConfig};
use crate::scan::Scan;
use crate::space::Space;

/// The end points of a scan's beams, in cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Ends {
    pub(super) ends: Vec<End>,
    /// The weights of all beams together.
    pub(super) weight: f64,
}

/// Where a beam ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
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
        scan.check()?;
        let chosen = beams::choose(scan, 0.0, space, config).beams;
        let ends: Vec<End> = chosen
            .iter()
            .map(|beam| {
                let (sin, cos) = beam.angle.sin_cos();
                End {
                    towards: (cos, sin),
                    reading: beam.reading_m / space.resolution_m,
                    weight: beam.weight,
                }
            })
            .collect();
        Ok(Ends {
            weight: ends.iter().map(|end| end.weight).sum(),
            ends,
        })
    }
}

impl Ends {
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
    /// The direction of the beam where the laser is turned.
    #[inline]
    pub(super) fn direction(&self, (sin, cos): (f64, f64)) -> (f64, f64) {
        let (x, y) = self.towards;
        (x * cos - y * sin, x * sin + y * cos)
    }
}
