//! Errors in a map: the value found, where, and what is allowed.

use std::io;
use std::path::PathBuf;

use geometry::Pose;

use crate::{MAX_CELLS, MAX_ORIGIN_M, MAX_RESOLUTION_M, MAX_SIDE, MIN_RESOLUTION_M};

/// Why a map could not be read, built or written.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// The description is not there or not readable.
    #[error("cannot read the map description {}", path.display())]
    Description {
        /// The YAML file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A set of maps is none.
    #[error("{}: {reason}", path.display())]
    Set {
        /// The folder or the file.
        path: PathBuf,
        /// What is wrong, and what is allowed.
        reason: String,
    },
    /// One of the maps of a set cannot be used.
    #[error("map {name}")]
    OfSet {
        /// Which one.
        name: String,
        /// What is wrong with it.
        source: Box<MapError>,
    },
    /// The graph could not hold the map.
    #[error(
        "a map of {width} x {height} cells takes about {needed_mb} MB in the graph{}; allowed are {limit_mb} MB (--memory-limit)",
        beside(*others_mb)
    )]
    Memory {
        /// Cells along x.
        width: u32,
        /// Cells along y.
        height: u32,
        /// What it takes, megabytes.
        needed_mb: u64,
        /// What the maps of its set that come before it take, megabytes.
        others_mb: u64,
        /// What the graph may use.
        limit_mb: u64,
    },
    /// The file is larger than any sound one of its kind.
    #[error("{} has {found} bytes; at most {allowed} are allowed", path.display())]
    FileSize {
        /// The file.
        path: PathBuf,
        /// Its bytes.
        found: u64,
        /// The most that are read.
        allowed: u64,
    },
    /// The description is not YAML of the expected form: bad syntax, a
    /// missing or repeated key, a list where a value should stand.
    #[error("{}:{line}:{column}: {reason}", path.display())]
    Yaml {
        /// The YAML file.
        path: PathBuf,
        /// Line, from 1; 0 where the whole document is meant.
        line: u64,
        /// Column, from 1.
        column: u64,
        /// What is wrong, and the keys or types that are allowed.
        reason: String,
    },
    /// A value of the description is not allowed.
    #[error("{}:{line}:{column}: {key} is {found}; allowed: {allowed}", path.display())]
    Value {
        /// The YAML file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// Column, from 1.
        column: u64,
        /// The key.
        key: &'static str,
        /// Its value.
        found: String,
        /// What it may be.
        allowed: String,
    },
    /// The image that the description names is not there or not readable.
    #[error("cannot read the image {}, named by {}:{line}:{column}", image.display(), yaml.display())]
    Image {
        /// The image file.
        image: PathBuf,
        /// The YAML file that names it.
        yaml: PathBuf,
        /// Line of the name, from 1.
        line: u64,
        /// Column of the name, from 1.
        column: u64,
        /// What the system says.
        source: io::Error,
    },
    /// The image is of a kind that is not read.
    #[error("{} holds {found}; allowed: PGM (P2 or P5), PNG and BMP", path.display())]
    ImageKind {
        /// The image file.
        path: PathBuf,
        /// The kind by its first bytes, or these.
        found: String,
    },
    /// The image claims a size that is not allowed.
    #[error("{} claims {width} x {height} cells; allowed: sides of 1..={MAX_SIDE} and at most {MAX_CELLS} cells", path.display())]
    ImageSize {
        /// The image file.
        path: PathBuf,
        /// Its columns.
        width: u32,
        /// Its rows.
        height: u32,
    },
    /// The image ends before its pixels do.
    #[error("{} is cut short: {width} x {height} cells need at least {needed} bytes, {found} are there", path.display())]
    ImageTruncated {
        /// The image file.
        path: PathBuf,
        /// Its columns.
        width: u32,
        /// Its rows.
        height: u32,
        /// Bytes that its pixels need.
        needed: u64,
        /// Bytes that follow its header.
        found: u64,
    },
    /// The image continues after its pixels: its header is most likely damaged.
    #[error("{} goes on for {surplus} bytes after the last of {width} x {height} cells; allowed: white space", path.display())]
    ImageSurplus {
        /// The image file.
        path: PathBuf,
        /// Its columns.
        width: u32,
        /// Its rows.
        height: u32,
        /// Bytes after the last pixel.
        surplus: u64,
    },
    /// A pixel of the image is not a number within its range.
    #[error("{}: pixel {x}, {y} from the top left is {found}; allowed: 0..={allowed}", path.display())]
    ImagePixel {
        /// The image file.
        path: PathBuf,
        /// Column of the pixel.
        x: u64,
        /// Row of the pixel, from the top.
        y: u64,
        /// What stands there.
        found: String,
        /// The highest value that the header allows.
        allowed: u32,
    },
    /// The image could not be decoded.
    #[error("{} is damaged or cut short", path.display())]
    ImageDecode {
        /// The image file.
        path: PathBuf,
        /// What the decoder says.
        source: image::ImageError,
    },
    /// A grid's sides are not allowed.
    #[error(
        "a grid of {width} x {height} cells; allowed: sides of 1..={MAX_SIDE} and at most {MAX_CELLS} cells"
    )]
    GridSize {
        /// Cells along x.
        width: u32,
        /// Cells along y.
        height: u32,
    },
    /// A grid's cells are not as many as its sides say.
    #[error("{found} cells for a grid of {width} x {height}; allowed: width times height")]
    CellCount {
        /// Cells along x.
        width: u32,
        /// Cells along y.
        height: u32,
        /// Cells given.
        found: usize,
    },
    /// A cell's occupancy is not allowed.
    #[error("cell {x}, {y} is {found}; allowed: 0..=100, and 255 for unknown")]
    CellValue {
        /// Column of the cell.
        x: u32,
        /// Row of the cell, from the lowest y.
        y: u32,
        /// Its occupancy.
        found: u8,
    },
    /// A cell's side is not allowed.
    #[error("a resolution of {found} m; allowed: {MIN_RESOLUTION_M}..={MAX_RESOLUTION_M} m")]
    Resolution {
        /// The side, metres.
        found: f64,
    },
    /// A grid's place in the map frame is not allowed.
    #[error("an origin at x {} m, y {} m, yaw {} rad; allowed: within {MAX_ORIGIN_M} m, and a yaw of at most a turn", found.x, found.y, found.yaw)]
    Origin {
        /// The place.
        found: Pose,
    },
    /// A map file could not be written.
    #[error("cannot write {}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

/// What the maps take that come before one, in words.
fn beside(others_mb: u64) -> String {
    match others_mb {
        0 => String::new(),
        _ => format!(", and the maps before it {others_mb} MB"),
    }
}
