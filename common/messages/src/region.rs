//! Region of the search.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Stamp;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// Header of topic `region`; the items are the corners of a polygon in order, two opposite corners
/// of an axis-aligned rectangle, or none to search everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("RegionHeader/v1")
)]
#[repr(C)]
pub struct RegionHeader {
    /// Time of the request; the counter counts the requests.
    pub stamp: Stamp,
}

/// A corner of a region, in the map frame.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Corner/v1"))]
#[repr(C)]
pub struct Corner {
    /// Position along x in metres.
    pub x: f64,
    /// Position along y in metres.
    pub y: f64,
}
