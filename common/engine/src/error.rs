//! Errors of the engine.

use geometry::Pose;
use messages::limits::{MAX_CELLS, MAX_ORIGIN_M, MAX_RESOLUTION_M, MAX_SIDE, MIN_RESOLUTION_M};

use crate::joined::MAX_APART_NS;
use crate::tracker::MIN_PERIOD_NS;

/// Reason why the engine rejects a map, a scan or a setting.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    /// A side of the grid is out of range.
    #[error("a grid of {width} x {height} cells: each side must have 1 to {MAX_SIDE} cells")]
    GridSides {
        /// Cells along x.
        width: usize,
        /// Cells along y.
        height: usize,
    },
    /// The grid has more than [`MAX_CELLS`] cells.
    #[error("a grid of {width} x {height} cells: at most {MAX_CELLS} cells are allowed")]
    GridSize {
        /// Cells along x.
        width: usize,
        /// Cells along y.
        height: usize,
    },
    /// The number of occupancies is not width times height.
    #[error("a grid of {width} x {height} cells came with {cells} occupancies instead of {}", width * height)]
    GridCells {
        /// Cells along x.
        width: usize,
        /// Cells along y.
        height: usize,
        /// Occupancies given.
        cells: usize,
    },
    /// The side of a cell is out of range.
    #[error("a resolution of {0} m; allowed: {MIN_RESOLUTION_M}..={MAX_RESOLUTION_M} m")]
    Resolution(f64),
    /// The origin of the grid in the map frame is out of range or not finite.
    #[error(
        "an origin at x {} m, y {} m, yaw {} rad; allowed: within {MAX_ORIGIN_M} m, and a yaw of \
         at most a turn", .0.x, .0.y, .0.yaw
    )]
    Origin(Pose),
    /// A threshold of the cell rules is out of range.
    #[error(transparent)]
    Rule(#[from] messages::InvalidRule),
    /// The map has no occupied cell to project from.
    #[error("the map has no occupied cell: there is nothing that a laser could see")]
    NoOccupiedCell,
    /// The map has no free cell in which the robot could be.
    #[error("the map has no free cell: there is nowhere that the robot could be")]
    NoFreeCell,
    /// A cell of a boundary is not an obstacle.
    #[error("cell {x}, {y} of the boundary is not an occupied cell of the map")]
    BoundaryCell {
        /// Column of the cell.
        x: u16,
        /// Row of the cell.
        y: u16,
    },
    /// The limits exclude every cell.
    #[error(
        "no open cell of the map lies in the region that is searched, near enough to a free cell \
         and as far from obstacles as the robot's radius asks"
    )]
    NoCellWithin,
    /// The limits exclude every heading.
    #[error("none of the {0} headings a turn lies in the interval that is searched")]
    NoHeadingWithin(u32),
    /// Preparing the map needs more memory than is allowed.
    #[error(
        "preparing the map takes about {needed_mb} MB and the memory limit allows {limit_mb}: a larger \
         search cell, fewer headings or a smaller region take less"
    )]
    Memory {
        /// Memory needed, in megabytes of 10⁶ bytes.
        needed_mb: u64,
        /// Memory allowed, in megabytes of 10⁶ bytes.
        limit_mb: u32,
    },
    /// No pose with finite numbers is given at which particles could start.
    #[error("no pose is given, with finite numbers, at which particles could start")]
    NoStart,
    /// The number of headings is not supported.
    #[error("{0} headings a turn: it must be a multiple of 8 from 8 to 3600")]
    Headings(u32),
    /// The scan has no ranges.
    #[error("the scan is empty: it has no ranges")]
    EmptyScan,
    /// The scan has more than 65536 ranges.
    #[error("the scan has {0} ranges: at most 65536 are allowed")]
    TooManyRanges(usize),
    /// A pose of the odometry is not finite.
    #[error(
        "the odometry is at x {} m, y {} m, yaw {} rad: each must be finite",
        .0.x, .0.y, .0.yaw
    )]
    Odometry(Pose),
    /// Several lasers are to be joined, and the mount of one of them is unknown.
    #[error(
        "the pose of laser {laser} on the base is unknown: joining several lasers needs it, from \
         /tf_static or as a mount"
    )]
    NoMount {
        /// Name of the laser.
        laser: String,
    },
    /// The scans of two lasers that are to be joined are too far apart in time.
    #[error(
        "the scan of laser {laser} has stamp {stamp_ns}, {later_ns} ns after that of laser 0: within \
         {MAX_APART_NS} ns are needed"
    )]
    StampsApart {
        /// Number of the laser, from 0.
        laser: usize,
        /// Stamp of its scan, in nanoseconds.
        stamp_ns: i64,
        /// Nanoseconds after the stamp of the first laser's scan.
        later_ns: i64,
    },
    /// The stamps of a laser do not rise.
    #[error(
        "the scan of laser {laser} has stamp {stamp_ns}, {later_ns} ns after that of the last one: at \
         least {MIN_PERIOD_NS} ns are needed, or a reset for another drive"
    )]
    StampOrder {
        /// Number of the laser, from 0.
        laser: usize,
        /// Stamp of its scan, in nanoseconds.
        stamp_ns: i64,
        /// Nanoseconds after the stamp of its last scan.
        later_ns: i64,
    },
    /// An update of a tracker has not as many scans as the first.
    #[error("scans given: {given}; lasers of the robot: {lasers}; a scan of each laser is needed")]
    Lasers {
        /// Number of scans given.
        given: usize,
        /// Number of lasers of the robot.
        lasers: usize,
    },
    /// The time from one range to the next is not finite.
    #[error("time_increment is {0}: it must be finite, in seconds")]
    TimeIncrement(f64),
    /// The pose at which a robot is expected is off the map.
    #[error(
        "the expected pose is at x {} m, y {} m, yaw {} rad: it must be on map {map}", .pose.x,
        .pose.y, .pose.yaw
    )]
    ExpectedPose {
        /// Number of the map.
        map: u32,
        /// Pose in the map.
        pose: Pose,
    },
    /// The covariance of the pose at which a robot is expected is not one.
    #[error(
        "the covariance of the expected pose is {0:?}: it must be symmetric and positive definite"
    )]
    Covariance([f64; 9]),
    /// The pose of the laser on the base is not finite.
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
        /// Index of the reading in the message.
        beam: usize,
    },
    /// A carried scan does not have one laser pose for each range.
    #[error("{places} places of the laser for {ranges} ranges: as many are needed")]
    Places {
        /// Number of laser poses.
        places: usize,
        /// Number of ranges.
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
        /// Angle from one reading to the next, in radians.
        angle_increment: f64,
        /// Field of view, in turns.
        turns: f64,
    },
    /// The scan's range limits contradict each other.
    #[error("range_min {min} and range_max {max}: 0 <= range_min < range_max is needed, in metres")]
    RangeLimits {
        /// Smallest range, in metres.
        min: f32,
        /// Largest range, in metres.
        max: f32,
    },
    /// There is no map to search.
    #[error("no map is given: at least one is needed")]
    NoMap,
    /// The map was prepared for known headings, and none is given.
    #[error("no heading is given, and the map was prepared for scans that come with one")]
    HeadingMissing,
    /// The map was prepared for unknown headings, and one is given.
    #[error("a heading of {0} rad is given, and the map was prepared for unknown headings")]
    HeadingGiven(f64),
    /// The given heading is not finite.
    #[error("the known heading is {0}: it must be finite, in radians")]
    Heading(f64),
}
