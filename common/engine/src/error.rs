//! Errors of the engine: inputs that it rejects.

use geometry::Pose;

use crate::grid::{MAX_CELLS, MAX_ORIGIN_M, MAX_RESOLUTION_M, MAX_SIDE, MIN_RESOLUTION_M};

/// A map, a scan or a setting that the engine cannot work with.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EngineError {
    /// A side of the grid is out of range.
    #[error("a grid of {width} x {height} cells: each side must have 1 to {MAX_SIDE} cells")]
    GridSides {
        /// Cells along x.
        width: usize,
        /// Cells along y.
        height: usize,
    },
    /// The grid has more cells than are believed.
    #[error("a grid of {width} x {height} cells: at most {MAX_CELLS} cells are allowed")]
    GridSize {
        /// Cells along x.
        width: usize,
        /// Cells along y.
        height: usize,
    },
    /// The cells do not fill the grid.
    #[error("a grid of {width} x {height} cells came with {cells} occupancies instead of {}", width * height)]
    GridCells {
        /// Cells along x.
        width: usize,
        /// Cells along y.
        height: usize,
        /// Occupancies given.
        cells: usize,
    },
    /// A cell's side is out of range.
    #[error("a resolution of {0} m; allowed: {MIN_RESOLUTION_M}..={MAX_RESOLUTION_M} m")]
    Resolution(f64),
    /// The grid's place in the map frame is out of range, or none.
    #[error(
        "an origin at x {} m, y {} m, yaw {} rad; allowed: within {MAX_ORIGIN_M} m, and a yaw of \
         at most a turn", .0.x, .0.y, .0.yaw
    )]
    Origin(Pose),
    /// A rule by which cells are read is out of range.
    #[error(transparent)]
    Rule(#[from] messages::InvalidRule),
    /// There is no obstacle to project from.
    #[error("the map has no occupied cell: there is nothing that a laser could see")]
    NoOccupiedCell,
    /// There is no place to stand.
    #[error("the map has no free cell: there is nowhere that the robot could be")]
    NoFreeCell,
    /// The limits leave nowhere to stand.
    #[error(
        "no open cell of the map lies in the region that is searched, near enough to a free cell \
         and as far from obstacles as the robot's radius asks"
    )]
    NoCellWithin,
    /// The limits leave no heading.
    #[error("none of the {0} headings a turn lies in the interval that is searched")]
    NoHeadingWithin(u32),
    /// More memory would be needed than is allowed.
    #[error(
        "preparing the map takes about {needed_mb} MB and --memory-limit allows {limit_mb}: larger \
         cells (--search-cell), fewer headings (--headings) or a part of the map (--region) take \
         less"
    )]
    Memory {
        /// Megabytes of 10⁶ bytes.
        needed_mb: u64,
        /// The same.
        limit_mb: u32,
    },
    /// There is no pose at which particles could start.
    #[error("no pose is given, with finite numbers, at which particles could start")]
    NoStart,
    /// The number of headings is not supported.
    #[error("{0} headings a turn: it must be a multiple of 8 from 8 to 3600")]
    Headings(u32),
    /// The scan has no readings.
    #[error("the scan is empty: it has no ranges")]
    EmptyScan,
    /// The scan has more readings than a scan can have.
    #[error("the scan has {0} ranges: at most 65536 are allowed")]
    TooManyRanges(usize),
    /// The scan is none of a ring of sonars.
    #[error(
        "the scan has {found} readings: a ring of sonars, as which it is to be read, has at most \
         {allowed}"
    )]
    TooManyEchoes {
        /// That returned.
        found: usize,
        /// That are taken.
        allowed: usize,
    },
    /// The odometry says no pose.
    #[error(
        "the odometry is at x {} m, y {} m, yaw {} rad: each must be finite",
        .0.x, .0.y, .0.yaw
    )]
    Odometry(Pose),
    /// Several lasers are to be joined, and it is not known where one sits.
    #[error(
        "it is not known where laser {laser} sits on the base: to join several, /tf_static or \
         --mount must say so"
    )]
    NoMount {
        /// Its name.
        laser: String,
    },
    /// The mount says no pose.
    #[error(
        "the laser sits at x {} m, y {} m, yaw {} rad of the base: each must be finite",
        .0.x, .0.y, .0.yaw
    )]
    Mount(Pose),
    /// A reading of a message is unusable.
    #[error(
        "reading {beam} is unusable: place, bearing and weight must be finite, the range above \
         zero, the weight 0 to 2"
    )]
    Reading {
        /// Its number in the message.
        beam: usize,
    },
    /// A carried scan lacks places of its laser.
    #[error("{places} places of the laser for {ranges} ranges: as many are needed")]
    Places {
        /// Poses of the laser.
        places: usize,
        /// Ranges of the scan.
        ranges: usize,
    },
    /// The scan's first bearing is unusable.
    #[error("angle_min is {0}: it must be finite, in radians, within two turns")]
    AngleMin(f64),
    /// The scan's angular step is unusable.
    #[error(
        "angle_increment is {0}: it must be finite and not zero, in radians; below zero is \
         clockwise"
    )]
    AngleIncrement(f64),
    /// The scan covers more than a turn.
    #[error(
        "{beams} beams of {angle_increment} rad cover {turns:.2} turns: at most one is allowed"
    )]
    FieldOfView {
        /// Readings of the scan.
        beams: usize,
        /// Radians from one to the next.
        angle_increment: f64,
        /// What they cover.
        turns: f64,
    },
    /// The scan's range limits contradict each other.
    #[error("range_min {min} and range_max {max}: 0 <= range_min < range_max is needed, in metres")]
    RangeLimits {
        /// Least range, metres.
        min: f32,
        /// Greatest range, metres.
        max: f32,
    },
    /// The given heading is no number.
    #[error("the known heading is {0}: it must be finite, in radians")]
    Heading(f64),
}
