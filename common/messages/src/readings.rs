//! Readings of a scan after motion correction or joining of lasers.

use crate::Stamp;

crate::message! {
    #[type_name("ReadingsHeader/v1")]
    /// Header of topic `readings`; the items are the beams for the second stage.
    pub struct ReadingsHeader {
        /// Stamp of the scan.
        pub stamp: Stamp,
    }

    #[type_name("Reading/v1")]
    /// One beam in the target frame: that of the laser at the scan's stamp or, with several lasers,
    /// that of the base.
    #[derive(Default)]
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
}
