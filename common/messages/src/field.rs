//! The intensity image of one scan.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Stamp;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// Header of topic `field`; the items are `width · height` intensities, row by
/// row from the lowest y.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("FieldHeader/v1")
)]
#[repr(C)]
pub struct FieldHeader {
    /// Of the scan.
    pub stamp: Stamp,
    /// The map that was searched.
    pub map_id: u64,
    /// Pixels along x.
    pub width: u32,
    /// Pixels along y.
    pub height: u32,
    /// Cells along each side of a pixel.
    pub block: u32,
    /// A [`FieldKind`].
    pub kind: u32,
    /// The highest intensity in the image.
    pub best: u32,
    /// What a pose would have if every beam agreed fully.
    pub highest_possible: u32,
    /// The heading of an exact image in the map frame, radians; else 0.
    pub heading: f64,
}

/// What a pixel of the field says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum FieldKind {
    /// The intensity of the cell at the known heading.
    Exact = 0,
    /// No pose in the block, at any heading, has more.
    UpperBound = 1,
}

impl FieldKind {
    /// The kind with this number, if there is one.
    #[must_use]
    pub fn from_code(code: u32) -> Option<Self> {
        [Self::Exact, Self::UpperBound]
            .into_iter()
            .find(|k| *k as u32 == code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(FieldHeader, size 64, align 8, {
        stamp: 0, map_id: 24, width: 32, height: 36, block: 40, kind: 44, best: 48,
        highest_possible: 52, heading: 56,
    });
}
