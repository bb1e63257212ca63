//! The readings of a scan that was brought to one time and place.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Stamp;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// Header of topic `readings`; the items are the beams that the second stage judges.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("ReadingsHeader/v1")
)]
#[repr(C)]
pub struct ReadingsHeader {
    /// Of the scan.
    pub stamp: Stamp,
}

/// One beam, in the target frame: that of the laser at the scan's
/// stamp or, where several lasers are joined, that of the base.
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Reading/v1"))]
#[repr(C)]
pub struct Reading {
    /// Where the laser was when it measured, metres.
    pub from_x: f64,
    /// Where the laser was when it measured, metres.
    pub from_y: f64,
    /// Direction of the beam, radians counter-clockwise.
    pub bearing: f64,
    /// From the laser to where the beam ends, metres; infinity where nothing
    /// returned.
    pub range_m: f64,
    /// How much the beam counts; 0 where nothing returned.
    pub weight: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    crate::pin_layout!(ReadingsHeader, size 24, align 8, { stamp: 0 });

    mod reading {
        use super::*;
        crate::pin_layout!(Reading, size 40, align 8, {
            from_x: 0, from_y: 8, bearing: 16, range_m: 24, weight: 32,
        });
    }
}
