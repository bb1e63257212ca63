//! A map that a test draws, as a graph has it.

use messages::{MapHeader, topic};
use transport::Publisher;

/// A map, and what its message says of it.
#[derive(Debug, Clone)]
pub struct DrawnMap {
    /// With the id of the cells.
    pub header: MapHeader,
    /// Per cent, row by row from the lowest y.
    pub cells: Vec<u8>,
}

impl DrawnMap {
    /// Rows of `width` cells.
    #[must_use]
    pub fn new(width: u32, resolution_m: f64, cells: Vec<u8>) -> Self {
        let mut header = MapHeader {
            width,
            height: cells.len() as u32 / width,
            resolution_m,
            ..MapHeader::default()
        };
        header.map_id = header.id_of(&cells);
        DrawnMap { header, cells }
    }

    /// Two rows of three cells: free, occupied and unknown ones.
    #[must_use]
    pub fn small() -> Self {
        DrawnMap::new(3, 0.05, vec![0, 100, 255, 0, 0, 100])
    }

    /// Sends it.
    pub fn send(&self, maps: &Publisher<topic::Map>) {
        let mut loan = maps.loan(self.cells.len()).unwrap();
        *loan.header_mut() = self.header;
        loan.items_mut().copy_from_slice(&self.cells);
        loan.send().unwrap();
    }
}
