//! Where the grids of the last two maps lie.
//!
//! Votes are cells of the map that was searched, and those on their way when
//! the map changes are of the one before. The cells themselves are not kept.

use engine::EngineError;
use engine::grid::GridFrame;
use messages::MapHeader;

use crate::PeakError;

/// The size and place of a map's grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// The map.
    pub map_id: u64,
    /// Cells along x.
    pub width: u32,
    /// Cells along y.
    pub height: u32,
    /// In the map frame.
    pub frame: GridFrame,
}

/// The newest map's geometry and that of the one before.
#[derive(Debug, Clone, Copy, Default)]
pub struct Geometries {
    newest: Option<Geometry>,
    previous: Option<Geometry>,
}

impl Geometries {
    /// Takes note of a map; one that is refused changes nothing.
    ///
    /// # Errors
    /// If the grid's sides, resolution or origin are out of range.
    pub fn hear(&mut self, map: &MapHeader) -> Result<(), EngineError> {
        let geometry = Geometry {
            map_id: map.map_id,
            width: map.width,
            height: map.height,
            frame: GridFrame::of(map)?,
        };
        if self.newest.is_none_or(|newest| newest.map_id != map.map_id) {
            self.previous = self.newest;
        }
        self.newest = Some(geometry);
        Ok(())
    }

    /// The geometry of a map.
    ///
    /// # Errors
    /// If it is neither of the last two.
    pub fn get(&self, map_id: u64) -> Result<Geometry, PeakError> {
        let mut known = self.newest.iter().chain(&self.previous);
        known
            .find(|geometry| geometry.map_id == map_id)
            .copied()
            .ok_or_else(|| PeakError::UnknownMap {
                found: map_id,
                known: self.names(),
            })
    }

    fn names(&self) -> String {
        let known = self.newest.iter().chain(&self.previous);
        let names: Vec<String> = known
            .map(|geometry| format!("{:016x}", geometry.map_id))
            .collect();
        if names.is_empty() {
            return "none".into();
        }
        names.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use geometry::Pose;
    use messages::Pose2;

    use super::*;

    fn map(map_id: u64) -> MapHeader {
        MapHeader {
            map_id,
            width: 30,
            height: 20,
            resolution_m: 0.05,
            map_from_grid: Pose2 {
                x: -1.0,
                y: 2.0,
                yaw: 0.5,
            },
            ..Zeroable::zeroed()
        }
    }

    #[test]
    fn the_last_two_maps_are_known() {
        let mut geometries = Geometries::default();
        for map_id in [1, 2, 3] {
            geometries.hear(&map(map_id)).unwrap();
        }
        let found = geometries.get(2).unwrap();
        assert_eq!((found.map_id, found.width, found.height), (2, 30, 20));
        assert_eq!(found.frame.map_from_grid, Pose::new(-1.0, 2.0, 0.5));
        assert_eq!(geometries.get(3).unwrap().map_id, 3);
        let error = geometries.get(1).unwrap_err().to_string();
        assert!(error.contains("map 0000000000000001"), "{error}");
        let known = "before: 0000000000000003, 0000000000000002";
        assert!(error.ends_with(known), "{error}");
    }

    #[test]
    fn a_map_that_is_served_again_does_not_push_out_the_one_before() {
        let mut geometries = Geometries::default();
        for map_id in [1, 2, 2] {
            geometries.hear(&map(map_id)).unwrap();
        }
        assert!(geometries.get(1).is_ok() && geometries.get(2).is_ok());
    }

    #[test]
    fn a_map_that_is_not_sound_changes_nothing() {
        let mut geometries = Geometries::default();
        assert!(geometries.get(1).unwrap_err().to_string().ends_with("none"));
        geometries.hear(&map(1)).unwrap();
        let mut refuse = |change: fn(&mut MapHeader), expected: &str| {
            let mut broken = map(2);
            change(&mut broken);
            let error = geometries.hear(&broken).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        refuse(|map| map.width = 0, "0 x 20 cells");
        refuse(|map| map.height = 32_768, "30 x 32768 cells");
        refuse(|map| map.resolution_m = 0.0, "0.001..=10 m");
        refuse(|map| map.resolution_m = f64::NAN, "0.001..=10 m");
        refuse(|map| map.map_from_grid.x = f64::INFINITY, "an origin at");
        refuse(|map| map.map_from_grid.yaw = f64::NAN, "an origin at");
        assert!(geometries.get(1).is_ok() && geometries.get(2).is_err());
    }
}
