//! The map as the tracker reads it.

use engine::EngineError;
use engine::fit::{DistanceField, Ends, FitConfig};
use engine::grid::{CellRules, GridFrame};
use engine::space::Space;
use engine::tracking::Seen;
use messages::MapHeader;

/// Headings a turn that scans are thinned for, as the search does by default.
const HEADINGS: u32 = 360;

/// A map, ready for the fit of scans.
pub(crate) struct World {
    /// Its id in messages.
    pub(crate) map_id: u64,
    /// Distances to obstacles.
    pub(crate) distance_field: DistanceField,
    /// What scans are thinned for.
    pub(crate) space: Space,
}

impl World {
    /// Prepares a map.
    ///
    /// # Errors
    /// If the grid's sides, resolution or origin are out of range, or the number of
    /// cells is not what the sides say.
    pub(crate) fn new(header: &MapHeader, occupancy: &[u8]) -> Result<Self, EngineError> {
        let (frame, rules) = (GridFrame::of(header)?, CellRules::of(header)?);
        let (width, height) = (header.width as usize, header.height as usize);
        Ok(World {
            map_id: header.map_id,
            distance_field: DistanceField::new(frame, (width, height), occupancy, rules)?,
            space: Space::new(HEADINGS, frame.resolution_m, width, height)?,
        })
    }

    /// A scan on this map.
    pub(crate) fn seen<'a>(&'a self, ends: &'a Ends, fit: &'a FitConfig) -> Seen<'a> {
        Seen {
            distance_field: &self.distance_field,
            ends,
            fit,
        }
    }
}
