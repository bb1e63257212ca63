//! Key by which a kept index is found again.

use std::fmt;

use bytemuck::cast_slice;
use twox_hash::XxHash3_128;

use super::SearchIndex;
use crate::grid::{Grid, GridFrame};
use crate::limits::LimitsConfig;
use crate::space::Space;

/// A hash of all that an index is made of, and of [`SearchIndex::VERSION`]: equal keys
/// belong to equal indexes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IndexKey(u128);

impl IndexKey {
    /// Returns the key of the index of a grid that is searched within limits.
    pub(crate) fn of(grid: &Grid, space: &Space, frame: GridFrame, limits: &LimitsConfig) -> Self {
        let (version, headings) = (SearchIndex::VERSION, space.directions.count());
        let (width, height) = (grid.width(), grid.height());
        // Debug output tells all different numbers apart, and a new limit is in the text by itself.
        let settings = format!("{version} {width} {height} {headings} {frame:?} {limits:?}");
        let mut hash = XxHash3_128::new();
        hash.write(settings.as_bytes());
        hash.write(cast_slice(grid.cells()));
        hash.write(cast_slice(grid.free().words()));
        IndexKey(hash.finish_128())
    }

    /// Returns the bytes of the key, the most significant first.
    #[must_use]
    pub fn to_bytes(self) -> [u8; 16] {
        self.0.to_be_bytes()
    }
}

/// Writes the key as 32 hexadecimal digits.
impl fmt::Display for IndexKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}
