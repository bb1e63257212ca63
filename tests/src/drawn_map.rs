//! A map that a test draws, in the form of a graph's message.

use messages::{MapHeader, topic};
use transport::Publisher;

/// A map with the header of its message.
#[derive(Debug, Clone)]
pub struct DrawnMap {
    /// Header of the message, with the id of the cells.
    pub header: MapHeader,
    /// Occupancy in per cent, row by row from the lowest y.
    pub cells: Vec<u8>,
}

impl DrawnMap {
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

    /// Makes two rows of three cells: free, occupied and unknown ones.
    pub fn small() -> Self {
        DrawnMap::new(3, 0.05, vec![0, 100, 255, 0, 0, 100])
    }

    pub fn send(&self, maps: &Publisher<topic::Map>) {
        maps.send(self.header, &self.cells).unwrap();
    }
}
