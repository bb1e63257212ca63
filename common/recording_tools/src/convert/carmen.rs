//! Lines of CARMEN's laser logs, as far as they are understood: what they are called
//! and what they hold.
//!
//! | line | words after its name |
//! |---|---|
//! | `FLASER`, `RLASER` | count, readings, laser pose (x y θ), odometry (x y θ), time, host, time in the log |
//! | `LASER3`, `LASER4`, `LASER5` | count, readings, time, host, time in the log |
//! | `RAWLASER1` to `RAWLASER5` | type, start angle, field of view, step, greatest range, accuracy, remission mode, count, readings, count, remissions, time, host, time in the log |
//! | `ROBOTLASER1` to `ROBOTLASER5` | as `RAWLASER1` up to the remissions, then laser pose, robot pose, velocities (2), safety distances (2), turn axis, time, host, time in the log |
//! | `ODOM` | x y θ, velocities (2), acceleration, time, host, time in the log |
//! | `PARAM` | name, value, and then no further words, or time, host, time in the log |
//!
//! Metres, radians and seconds; laser 1 is the front one, 2 the rear one. The old
//! lines have no angles. (CARMEN, `logger/readlog.c` and the notes that its logger
//! writes at the head of each log.)

use geometry::Pose;

/// A line that is understood.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Line {
    Laser(Laser),
    Odometry(Odometry),
    Parameter(Parameter),
    /// Nothing that matters: a comment, a mark, an empty line.
    Nothing,
    /// Of another kind, with the kind's name.
    Other(String),
}

/// A scan as its line has it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Laser {
    pub(super) kind: Kind,
    /// From 1, the front laser.
    pub(super) number: u8,
    /// If the line has them.
    pub(super) angles: Option<Angles>,
    /// Readings of this much and more are no returns, if the line has it.
    pub(super) range_max_m: Option<f64>,
    /// One that is no number is NaN.
    pub(super) ranges: Vec<f32>,
    /// If the line has them.
    pub(super) poses: Option<Poses>,
    /// As the line says it, nanoseconds.
    pub(super) time_ns: i64,
}

/// What a line has besides its readings; kinds with more are greater.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    /// `RAWLASER1`: angles, and no poses.
    Raw,
    /// `FLASER` or `LASER3`: no angles, and poses of the first two.
    Old,
    /// `ROBOTLASER1`: both.
    Robot,
}

/// Radians; the step is negative where beams run clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Angles {
    pub(super) start: f64,
    pub(super) field_of_view: f64,
    pub(super) step: f64,
}

/// In the frame of the odometry, or of the map where they were corrected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Poses {
    pub(super) laser: Pose,
    pub(super) robot: Pose,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Odometry {
    pub(super) robot: Pose,
    /// Forward m/s and rad/s.
    pub(super) velocities: (f64, f64),
    /// As the line says it, nanoseconds.
    pub(super) time_ns: i64,
}

/// A setting of the robot that wrote the log.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) value: String,
}

/// A line of a known kind that cannot be read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Broken {
    /// Its name.
    pub(super) name: String,
    /// What is wrong, in words that suit many such lines.
    pub(super) fault: Fault,
    /// What was found, and what is allowed.
    pub(super) reason: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Fault {
    CutShort,
    Count,
    Number,
    Time,
    Angles,
}

impl Laser {
    /// The name that its line has, as [`name_of`] finds it.
    pub(super) fn name(&self) -> String {
        name_of(self.kind, self.number)
    }
}

/// How lines of a kind begin.
pub(super) fn name_of(kind: Kind, number: u8) -> String {
    match (kind, number) {
        (Kind::Robot, number) => format!("ROBOTLASER{number}"),
        (Kind::Raw, number) => format!("RAWLASER{number}"),
        (Kind::Old, 1) => "FLASER".to_owned(),
        (Kind::Old, 2) => "RLASER".to_owned(),
        (Kind::Old, number) => format!("LASER{number}"),
    }
}

/// Whether a line of this name is of a kind that logs of CARMEN have; used to distinguish
/// such a log from other text.
pub(super) fn is_known(name: &str) -> bool {
    matches!(name, "ODOM" | "PARAM" | "SYNC" | "TRUEPOS") || laser_named(name).is_some()
}

/// The laser whose scans a line of this name holds.
pub(super) fn laser_named(name: &str) -> Option<(Kind, u8)> {
    match name {
        "FLASER" => return Some((Kind::Old, 1)),
        "RLASER" => return Some((Kind::Old, 2)),
        "LASER3" | "LASER4" | "LASER5" => {}
        _ if name.starts_with("RAWLASER") || name.starts_with("ROBOTLASER") => {}
        _ => return None,
    }
    let (kind, number) = name.split_once("LASER")?;
    let number = number.parse().ok().filter(|n| (1..=5).contains(n))?;
    match kind {
        "" => Some((Kind::Old, number)),
        "RAW" => Some((Kind::Raw, number)),
        "ROBOT" => Some((Kind::Robot, number)),
        _ => None,
    }
}
