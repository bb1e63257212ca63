//! Names and contents of the supported lines of CARMEN's laser logs.
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
//! Units are metres, radians and seconds; laser 1 is the front one, 2 the rear one. The old lines
//! have no angles. (CARMEN, `logger/readlog.c` and the notes that its logger writes at the head of
//! each log.)

use geometry::Pose;

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Line {
    Laser(Laser),
    Odometry(Odometry),
    Parameter(Parameter),
    /// A line without data: a comment, a marker, an empty line.
    Nothing,
    /// A line of another kind, with the name of the kind.
    Other(String),
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Laser {
    pub(super) kind: Kind,
    /// Number of the laser; 1 is the front one.
    pub(super) number: u8,
    pub(super) angles: Option<Angles>,
    /// Ranges of this value or more are no returns, if the line has it.
    pub(super) range_max_m: Option<f64>,
    /// Ranges in metres; NaN if not a number.
    pub(super) ranges: Vec<f32>,
    pub(super) poses: Option<Poses>,
    /// Time given in the line, in nanoseconds.
    pub(super) time_ns: i64,
}

/// Format of a laser line, in increasing order of data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    /// `RAWLASER1`: angles, but no poses.
    Raw,
    /// `FLASER` or `LASER3`: no angles; poses for the first two lasers only.
    Old,
    /// `ROBOTLASER1`: angles and poses.
    Robot,
}

/// Angles in radians; the step is negative if beams run clockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Angles {
    pub(super) start: f64,
    pub(super) field_of_view: f64,
    pub(super) step: f64,
}

/// Poses in the frame of the odometry, or of the map if they were corrected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Poses {
    pub(super) laser: Pose,
    pub(super) robot: Pose,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Odometry {
    pub(super) robot: Pose,
    /// Forward velocity in m/s, and turn rate in rad/s.
    pub(super) velocities: (f64, f64),
    /// Time given in the line, in nanoseconds.
    pub(super) time_ns: i64,
}

/// A setting of the robot that wrote the log.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) value: String,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Broken {
    pub(super) name: String,
    /// Fault in words, after the name of the line.
    pub(super) fault: &'static str,
    pub(super) reason: String,
}

impl Laser {
    /// Creates an old line of laser `number`, without poses.
    #[cfg(test)]
    pub(super) fn old(number: u8, ranges: Vec<f32>) -> Self {
        Laser {
            kind: Kind::Old,
            number,
            angles: None,
            range_max_m: None,
            ranges,
            poses: None,
            time_ns: 0,
        }
    }

    pub(super) fn name(&self) -> String {
        name_of(self.kind, self.number)
    }
}

pub(super) fn name_of(kind: Kind, number: u8) -> String {
    match (kind, number) {
        (Kind::Robot, number) => format!("ROBOTLASER{number}"),
        (Kind::Raw, number) => format!("RAWLASER{number}"),
        (Kind::Old, 1) => "FLASER".to_owned(),
        (Kind::Old, 2) => "RLASER".to_owned(),
        (Kind::Old, number) => format!("LASER{number}"),
    }
}

/// True if logs of CARMEN have lines of this name; used to distinguish a log from other text.
pub(super) fn is_known(name: &str) -> bool {
    matches!(name, "ODOM" | "PARAM" | "SYNC" | "TRUEPOS") || laser_named(name).is_some()
}

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
