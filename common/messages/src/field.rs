//! Intensity image of one scan.

use crate::Stamp;

crate::message! {
    #[type_name("FieldHeader/v1")]
    /// Header of topic `field`; the items are `width · height` intensities, row by row from the
    /// lowest y.
    pub struct FieldHeader {
        /// Stamp of the scan.
        pub stamp: Stamp,
        /// Map that was searched.
        pub map_id: u64,
        /// Width in pixels (along x).
        pub width: u32,
        /// Height in pixels (along y).
        pub height: u32,
        /// Side of a pixel in cells.
        pub block: u32,
        /// Meaning of the pixels, a [`FieldKind`].
        pub kind: u32,
        /// Highest intensity in the image.
        pub best: u32,
        /// Intensity of a pose that agrees with every beam.
        pub highest_possible: u32,
        /// Heading of an exact image in the map frame, in radians; else 0.
        pub heading: f64,
    }
}

crate::codes! {
    /// Meaning of the pixels of a field.
    pub enum FieldKind: u32 {
        /// Intensity of the cell at the known heading.
        Exact = 0,
        /// Upper bound on the intensities of all poses in the block, over all headings.
        UpperBound = 1,
    }
}
