//! Readings of a scan after motion correction or joining of lasers.

use bytemuck::{Pod, Zeroable};
use serde::{Deserialize, Serialize};

use crate::Stamp;
#[cfg(feature = "iceoryx2")]
use crate::zero_copy::ZeroCopySend;

/// Header of topic `readings`; the items are the beams for the second stage.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(
    feature = "iceoryx2",
    derive(ZeroCopySend),
    type_name("ReadingsHeader/v1")
)]
#[repr(C)]
pub struct ReadingsHeader {
    /// Stamp of the scan.
    pub stamp: Stamp,
}

/// One beam in the target frame: that of the laser at the scan's stamp or, with several lasers,
/// that of the base.
#[derive(Debug, Clone, Copy, PartialEq, Default, Pod, Zeroable, Serialize, Deserialize)]
#[cfg_attr(feature = "iceoryx2", derive(ZeroCopySend), type_name("Reading/v1"))]
#[repr(C)]
pub struct Reading {
    /// Position of the laser at the measurement along x, in metres.
    pub from_x: f64,
    /// Position of the laser at the measurement along y, in metres.
    pub from_y: f64,
    /// Direction of the beam, in radians counter-clockwise.
    pub bearing: f64,
    /// Distance from the laser to the end of the beam, in metres; infinity without a return.
    pub range_m: f64,
    /// Weight of the beam; 0 without a return.
    pub weight: f64,
}
