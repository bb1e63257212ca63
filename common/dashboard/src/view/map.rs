//! The map: description and cells.

use std::io::Write;
use std::sync::OnceLock;

use answers::map_id;
use flate2::Compression;
use flate2::write::GzEncoder;
use messages::{MapHeader, Pose2};
use serde::Serialize;

/// Description of a map; the cells are requested separately.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct MapInfo {
    /// Hash of cells and geometry, in hexadecimal.
    pub(crate) map_id: String,
    /// Name in its map set; empty for a single map.
    pub(crate) name: String,
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Side of a cell.
    pub(crate) resolution_m: f64,
    /// Pose of the grid: its lower left corner and the rotation of its axes.
    pub(crate) map_from_grid: Pose2,
}

#[derive(Debug)]
pub(crate) struct Map {
    pub(crate) info: MapInfo,
    cells: Vec<u8>,
    packed: OnceLock<Vec<u8>>,
}

impl Map {
    /// Converts a message of `map`; `None` if it contradicts itself.
    pub(crate) fn new(header: &MapHeader, cells: &[u8]) -> Option<Self> {
        let sides = (header.width as usize).checked_mul(header.height as usize);
        let is_sound = sides == Some(cells.len())
            && !cells.is_empty()
            && header.resolution_m > 0.0
            && header.resolution_m.is_finite()
            && geometry::Pose::from(header.map_from_grid).is_finite()
            && header.check_id(cells).is_ok();
        is_sound.then(|| Map {
            info: MapInfo {
                map_id: map_id(header.map_id),
                name: header.name.to_string(),
                width: header.width,
                height: header.height,
                resolution_m: header.resolution_m,
                map_from_grid: header.map_from_grid,
            },
            cells: cells.to_vec(),
            packed: OnceLock::new(),
        })
    }

    /// One byte per cell, row by row from the lowest y: 0 free to 100 occupied, 255 unknown.
    pub(crate) fn cells(&self) -> &[u8] {
        &self.cells
    }

    /// Gzip-compressed cells; compresses on the first call.
    pub(crate) fn packed(&self) -> &[u8] {
        self.packed.get_or_init(|| {
            let mut packer = GzEncoder::new(Vec::new(), Compression::fast());
            // Writing to memory cannot fail; if it did, the reader would notice missing cells.
            let _ = packer.write_all(&self.cells);
            packer.finish().unwrap_or_default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(width: u32, height: u32, resolution_m: f64, cells: &[u8]) -> MapHeader {
        let mut header = MapHeader {
            width,
            height,
            resolution_m,
            ..MapHeader::default()
        };
        header.map_id = header.id_of(cells);
        header
    }

    #[test]
    fn contradictions_are_refused() {
        let refused = |width, height, resolution_m, cells: &[u8]| {
            Map::new(&header(width, height, resolution_m, cells), cells).is_none()
        };
        assert!(!refused(3, 2, 0.05, &[0; 6]));
        assert!(refused(3, 2, 0.05, &[0; 5]));
        assert!(refused(0, 0, 0.05, &[]));
        assert!(refused(1, 1, f64::NAN, &[0]));
        assert!(refused(1, 1, 0.0, &[0]));
        assert!(refused(u32::MAX, u32::MAX, 0.05, &[0]));
        let other = header(1, 1, 0.05, &[100]);
        assert!(Map::new(&other, &[0]).is_none(), "the id is another map's");
    }
}
