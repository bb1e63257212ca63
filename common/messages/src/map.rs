//! Occupancy grid.

use std::hash::Hasher;

use bytemuck::Zeroable;
use twox_hash::XxHash3_64;

use crate::{MapName, Pose2, Stamp};

/// Occupancy of an unknown cell.
pub const UNKNOWN: u8 = 255;

/// Default occupancy from which a cell is occupied, in per cent; map savers use the same.
pub const OCCUPIED_FROM: u8 = 65;

/// Default occupancy up to which a cell is free, in per cent.
pub const FREE_TO: u8 = 25;

crate::message! {
    #[type_name("MapHeader/v2")]
    /// Header of topic `map`; the items are `width · height` cells, row by row from the lowest y: 0
    /// free to 100 occupied, [`UNKNOWN`] unknown.
    ///
    /// It includes the rules for classifying cells, so that all users of the map classify them in
    /// the same way.
    pub struct MapHeader {
        /// Time at which the map was read; the counter counts the maps served.
        pub stamp: Stamp,
        /// Hash of the cells, their geometry and the name: equal maps have equal ids, unless their
        /// names in a set differ.
        pub map_id: u64,
        /// Width in cells (along x).
        pub width: u32,
        /// Height in cells (along y).
        pub height: u32,
        /// Side of a cell in metres.
        pub resolution_m: f64,
        /// Pose of the grid in the map frame: the lower left corner of cell (0, 0), and the
        /// rotation of the grid's axes.
        pub map_from_grid: Pose2,
        /// Occupancy from which a cell is occupied, in per cent, 1..=100.
        pub occupied_from: u32,
        /// Occupancy up to which a cell is free, in per cent, 0..=99; values in between are
        /// unknown.
        pub free_to: u32,
        /// 1 if unknown cells block rays, else 0.
        pub unknown_blocks: u64,
        /// Name of the map in its set; empty without a set.
        pub name: MapName,
    }
}

impl Default for MapHeader {
    /// Creates a map without cells and name, with the default rules.
    fn default() -> Self {
        MapHeader {
            occupied_from: OCCUPIED_FROM.into(),
            free_to: FREE_TO.into(),
            ..MapHeader::zeroed()
        }
    }
}

/// Returns the id of a map: a hash of geometry and cells (XXH3, 64 bits), the same on every
/// machine.
///
/// Lengths and angles are rounded to the nanometre and nanoradian, so that a map and its copy in a
/// recording have one id in spite of rounding errors.
#[must_use]
pub fn map_id(
    (width, height): (u32, u32),
    resolution_m: f64,
    map_from_grid: Pose2,
    cells: &[u8],
) -> u64 {
    let mut hasher = XxHash3_64::new();
    hasher.write(&width.to_le_bytes());
    hasher.write(&height.to_le_bytes());
    let Pose2 { x, y, yaw } = map_from_grid;
    for value in [resolution_m, x, y, yaw] {
        // Origins are below 1e8 m, which is 1e17 nanometres and fits an i64.
        hasher.write(&((value * 1e9).round() as i64).to_le_bytes());
    }
    hasher.write(cells);
    hasher.finish()
}

/// Error of a map whose id does not match its content; it could be confused with another map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("its id {found:016x} is not that of its cells, {expected:016x}")]
pub struct WrongMapId {
    /// Id in the header.
    pub found: u64,
    /// Id of the content.
    pub expected: u64,
}

impl MapHeader {
    /// Returns the id of a map with this geometry, name and cells.
    #[must_use]
    pub fn id_of(&self, cells: &[u8]) -> u64 {
        let sides = (self.width, self.height);
        let id = map_id(sides, self.resolution_m, self.map_from_grid, cells);
        match self.name.as_str() {
            "" => id,
            // Equal floors of a building are still different maps.
            name => XxHash3_64::oneshot_with_seed(id, name.as_bytes()),
        }
    }

    /// Checks that the id matches the content; every receiver of a map should do so.
    ///
    /// # Errors
    /// The id does not match.
    pub fn check_id(&self, cells: &[u8]) -> Result<(), WrongMapId> {
        let (found, expected) = (self.map_id, self.id_of(cells));
        match found == expected {
            true => Ok(()),
            false => Err(WrongMapId { found, expected }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_with_the_id_of_another_is_refused() {
        let mut map = MapHeader {
            width: 3,
            height: 1,
            resolution_m: 0.05,
            ..MapHeader::zeroed()
        };
        map.map_id = map.id_of(&[0, 100, UNKNOWN]);
        assert_eq!(map.check_id(&[0, 100, UNKNOWN]), Ok(()));
        let error = map.check_id(&[0, 100, 0]).unwrap_err();
        assert_eq!(error.found, map.map_id);
        assert!(
            error.to_string().contains("is not that of its cells"),
            "{error}"
        );
        let named = MapHeader {
            name: MapName::new("ground"),
            ..map
        };
        assert!(named.check_id(&[0, 100, UNKNOWN]).is_err(), "one of a set");
        map.map_from_grid.x = 1.0;
        assert!(
            map.check_id(&[0, 100, UNKNOWN]).is_err(),
            "it lies elsewhere"
        );
    }
}
