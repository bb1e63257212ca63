//! Region of the search.

use crate::Stamp;

crate::message! {
    #[type_name("RegionHeader/v1")]
    /// Header of topic `region`; the items are the corners of a polygon in order, two opposite
    /// corners of an axis-aligned rectangle, or none to search everywhere.
    #[derive(Eq)]
    pub struct RegionHeader {
        /// Time of the request; the counter counts the requests.
        pub stamp: Stamp,
    }

    #[type_name("Corner/v1")]
    /// A corner of a region, in the map frame.
    pub struct Corner {
        /// Position along x in metres.
        pub x: f64,
        /// Position along y in metres.
        pub y: f64,
    }
}
