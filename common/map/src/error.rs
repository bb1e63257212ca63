//! Errors of maps, with the value found, its place, and what is allowed.

use std::io;
use std::path::PathBuf;

use geometry::Pose;

use crate::{MAX_CELLS, MAX_ORIGIN_M, MAX_RESOLUTION_M, MAX_SIDE, MIN_RESOLUTION_M};

/// Error of reading, building or writing a map.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// The description does not exist or cannot be read.
    #[error("cannot read the map description {}", path.display())]
    Description {
        /// Path of the file.
        path: PathBuf,
        source: io::Error,
    },
    /// The file is a map of another program.
    #[error("{} is {name}: {advice}", path.display())]
    Foreign {
        path: PathBuf,
        name: &'static str,
        /// Commands that make a map of it.
        advice: String,
    },
    /// A set of maps is invalid.
    #[error("{}: {reason}", path.display())]
    Set {
        /// Folder or file of the set.
        path: PathBuf,
        /// Error, with what is allowed.
        reason: String,
    },
    /// A map of a set cannot be used.
    #[error("map {name}")]
    OfSet {
        /// Name of the map.
        name: String,
        source: Box<MapError>,
    },
    /// The map needs more memory than the graph may use.
    #[error(
        "a map of {width} x {height} cells takes about {needed_mb} MB in the graph{}; allowed are {limit_mb} MB (--memory-limit)",
        beside(*others_mb)
    )]
    Memory {
        width: u32,
        height: u32,
        /// Memory needed in megabytes.
        needed_mb: u64,
        /// Memory of the maps before it in its set, in megabytes.
        others_mb: u64,
        /// Memory limit in megabytes.
        limit_mb: u64,
    },
    /// The file exceeds the largest valid size of its format.
    #[error("{} has {found} bytes; at most {allowed} are allowed", path.display())]
    FileSize {
        path: PathBuf,
        /// Size found, in bytes.
        found: u64,
        /// Largest size allowed, in bytes.
        allowed: u64,
    },
    /// The description is not YAML of the expected form: a syntax error, a missing or repeated key,
    /// or a list in place of a value.
    #[error("{}:{line}:{column}: {reason}", path.display())]
    Yaml {
        path: PathBuf,
        /// Line, from 1; 0 for the whole document.
        line: u64,
        /// Column, from 1.
        column: u64,
        /// Error, with the allowed keys or types.
        reason: String,
    },
    /// A value of the description is not allowed.
    #[error("{}:{line}:{column}: {key} is {found}; allowed: {allowed}", path.display())]
    Value {
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Column, from 1.
        column: u64,
        key: &'static str,
        found: String,
        /// Description of the allowed values.
        allowed: String,
    },
    /// The image of a description does not exist or cannot be read.
    #[error("cannot read the image {}, named by {}:{line}:{column}", image.display(), yaml.display())]
    Image {
        image: PathBuf,
        /// Path of the description.
        yaml: PathBuf,
        /// Line of the image's name, from 1.
        line: u64,
        /// Column of the image's name, from 1.
        column: u64,
        source: io::Error,
    },
    /// The image has an unsupported format.
    #[error("{} holds {found}; allowed: PGM (P2 or P5), PNG and BMP", path.display())]
    ImageKind {
        path: PathBuf,
        /// Format by the first bytes, or these bytes.
        found: String,
    },
    /// The image has an invalid size in its header.
    #[error("{} claims {width} x {height} cells; allowed: sides of 1..={MAX_SIDE} and at most {MAX_CELLS} cells", path.display())]
    ImageSize {
        path: PathBuf,
        width: u32,
        height: u32,
    },
    /// The image ends before its last pixel.
    #[error("{} is cut short: {width} x {height} cells need at least {needed} bytes, {found} are there", path.display())]
    ImageTruncated {
        path: PathBuf,
        width: u32,
        height: u32,
        /// Bytes needed for the pixels.
        needed: u64,
        /// Bytes after the header.
        found: u64,
    },
    /// The image has data after its last pixel: its header is probably damaged.
    #[error("{} goes on for {surplus} bytes after the last of {width} x {height} cells; allowed: white space", path.display())]
    ImageSurplus {
        path: PathBuf,
        width: u32,
        height: u32,
        /// Number of these bytes.
        surplus: u64,
    },
    /// A pixel of the image is not a number or out of range.
    #[error("{}: pixel {x}, {y} from the top left is {found}; allowed: 0..={allowed}", path.display())]
    ImagePixel {
        path: PathBuf,
        /// Column of the pixel.
        x: u64,
        /// Row of the pixel from the top.
        y: u64,
        found: String,
        /// Highest value by the header.
        allowed: u32,
    },
    /// The image could not be decoded.
    #[error("{} is damaged or cut short", path.display())]
    ImageDecode {
        path: PathBuf,
        source: image::ImageError,
    },
    /// A grid has invalid sides.
    #[error(
        "a grid of {width} x {height} cells; allowed: sides of 1..={MAX_SIDE} and at most {MAX_CELLS} cells"
    )]
    GridSize {
        /// Width in cells (along x).
        width: u32,
        height: u32,
    },
    /// The number of cells differs from the sides of the grid.
    #[error("{found} cells for a grid of {width} x {height}; allowed: width times height")]
    CellCount {
        width: u32,
        height: u32,
        found: usize,
    },
    /// A cell has an invalid occupancy.
    #[error("cell {x}, {y} is {found}; allowed: 0..=100, and 255 for unknown")]
    CellValue {
        x: u32,
        /// Row of the cell from the lowest y.
        y: u32,
        /// Occupancy of the cell.
        found: u8,
    },
    /// The side of a cell is out of range.
    #[error("a resolution of {found} m; allowed: {MIN_RESOLUTION_M}..={MAX_RESOLUTION_M} m")]
    Resolution {
        /// Side of a cell in metres.
        found: f64,
    },
    /// The origin of a grid is out of range.
    #[error("an origin at x {} m, y {} m, yaw {} rad; allowed: within {MAX_ORIGIN_M} m, and a yaw of at most a turn", found.x, found.y, found.yaw)]
    Origin {
        /// Pose of the grid in the map frame.
        found: Pose,
    },
    /// A map file could not be written.
    #[error("cannot write {}", path.display())]
    Write {
        /// Path of the file.
        path: PathBuf,
        source: io::Error,
    },
}

/// Describes the memory of the maps before one; empty without any.
fn beside(others_mb: u64) -> String {
    match others_mb {
        0 => String::new(),
        _ => format!(", and the maps before it {others_mb} MB"),
    }
}
