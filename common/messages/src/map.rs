//! The occupancy grid.

use std::hash::Hasher;

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use twox_hash::XxHash3_64;

#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;
use crate::{MapName, Pose2, Stamp};

/// The occupancy of a cell about which nothing is known.
pub const UNKNOWN: u8 = 255;

/// Occupancy from which a cell is occupied unless a map says otherwise, per cent: that of
/// map savers.
pub const OCCUPIED_FROM: u8 = 65;

/// Occupancy up to which a cell is free unless a map says otherwise, per cent.
pub const FREE_TO: u8 = 25;

/// Header of topic `map`; the items are `width · height` cells, row by row from
/// the lowest y: 0 free to 100 occupied, [`UNKNOWN`] unknown.
///
/// It carries the rules by which cells are classed, so that all who use the map class them in
/// the same way.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("MapHeader/v2"))]
#[repr(C)]
pub struct MapHeader {
    /// When the map was read; the counter counts the maps served.
    pub stamp: Stamp,
    /// Hash of the cells, their geometry and the name: equal maps have equal ids, unless they
    /// are two of a set.
    pub map_id: u64,
    /// Cells along x.
    pub width: u32,
    /// Cells along y.
    pub height: u32,
    /// Side of a cell, metres.
    pub resolution_m: f64,
    /// The lower left corner of cell (0, 0) in the map frame, and the turn of
    /// the grid's axes.
    pub map_from_grid: Pose2,
    /// Occupancy from which a cell is occupied, per cent, 1..=100.
    pub occupied_from: u32,
    /// Occupancy up to which a cell is free, per cent, 0..=99; what lies between counts as
    /// unknown.
    pub free_to: u32,
    /// 1 where unknown cells block rays, else 0.
    pub unknown_blocks: u64,
    /// What the map is called in its set; empty of one that is served alone.
    pub name: MapName,
}

impl Default for MapHeader {
    /// A map without cells and name, by the usual rules.
    fn default() -> Self {
        MapHeader {
            occupied_from: OCCUPIED_FROM.into(),
            free_to: FREE_TO.into(),
            ..MapHeader::zeroed()
        }
    }
}

/// The id of a map: a hash of geometry and cells (XXH3, 64 bits), the same on every machine.
///
/// Lengths and angles count to the nanometre and nanoradian, so that a map and its copy
/// in a recording have one id although they were written with different roundings.
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
        // Origins end at 1e8 m, 1e17 nanometres, well within an i64.
        hasher.write(&((value * 1e9).round() as i64).to_le_bytes());
    }
    hasher.write(cells);
    hasher.finish()
}

/// A map whose id is not that of its content: what is known of one map would be taken for
/// another one's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WrongMapId {
    /// As the header says.
    pub found: u64,
    /// Of the content.
    pub expected: u64,
}

impl std::fmt::Display for WrongMapId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let WrongMapId { found, expected } = self;
        write!(
            f,
            "its id {found:016x} is not that of its cells, {expected:016x}"
        )
    }
}

impl std::error::Error for WrongMapId {}

impl MapHeader {
    /// The id that a map with this geometry, this name and these cells has.
    #[must_use]
    pub fn id_of(&self, cells: &[u8]) -> u64 {
        let sides = (self.width, self.height);
        let id = map_id(sides, self.resolution_m, self.map_from_grid, cells);
        match self.name.as_str() {
            "" => id,
            // Floors may look alike, and are not the same.
            name => XxHash3_64::oneshot_with_seed(id, name.as_bytes()),
        }
    }

    /// Whether the id is that of the content: to be asked by whoever receives a map.
    ///
    /// # Errors
    /// It is another one.
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

    crate::pin_layout!(MapHeader, size 152, align 8, {
        stamp: 0, map_id: 24, width: 32, height: 36, resolution_m: 40, map_from_grid: 48,
        occupied_from: 72, free_to: 76, unknown_blocks: 80, name: 88,
    });
}
