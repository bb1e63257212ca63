//! Lines of CARMEN's laser logs (`.log`, and `.clf` where poses were corrected).
//!
//! | line | words after its name |
//! |---|---|
//! | `FLASER`, `RLASER` | count, readings, laser pose (x y θ), odometry (x y θ), time, host, time in the log |
//! | `ROBOTLASER1`, `ROBOTLASER2` | type, start angle, field of view, step, greatest range, accuracy, remission mode, count, readings, count, remissions, laser pose, robot pose, velocities (2), safety distances (2), turn axis, time, host, time in the log |
//! | `ODOM` | x y θ, velocities (2), acceleration, time, host, time in the log |
//!
//! Metres, radians and seconds. `FLASER` tells no angles: its beams cover half a
//! turn, from the right to the left. Other lines, and comments after `#`, are
//! none of this module's business.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

use geometry::Pose;

/// Most readings of a line: a turn in steps of a hundredth of a degree.
const MAX_READINGS: usize = 36_000;

/// A line that is understood.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Line {
    Laser(Laser),
    Odometry(Odometry),
}

/// A scan with the poses that were known of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Laser {
    /// The line's name.
    pub(super) name: String,
    pub(super) angle_min: f64,
    pub(super) angle_increment: f64,
    /// Readings above are no returns; `None` where the line does not say.
    pub(super) range_max_m: Option<f64>,
    pub(super) ranges: Vec<f32>,
    /// In the frame of the odometry, or of the map where it was corrected.
    pub(super) laser: Pose,
    pub(super) robot: Pose,
    /// As the line says it, nanoseconds.
    pub(super) time_ns: i64,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Odometry {
    pub(super) robot: Pose,
    /// Forward m/s and rad/s.
    pub(super) velocities: (f64, f64),
    /// As the line says it, nanoseconds.
    pub(super) time_ns: i64,
}

/// Reads a line; `None` where it is of another kind.
///
/// # Errors
/// Says what a line of a known kind lacks.
pub(super) fn parse(line: &str) -> Result<Option<Line>, String> {
    let mut words = Words(line.split_ascii_whitespace());
    let Some(name) = words.0.next() else {
        return Ok(None);
    };
    match name {
        "FLASER" | "RLASER" => words.laser(name).map(|laser| Some(Line::Laser(laser))),
        "ROBOTLASER1" | "ROBOTLASER2" => words
            .robot_laser(name)
            .map(|laser| Some(Line::Laser(laser))),
        "ODOM" => words
            .odometry()
            .map(|odometry| Some(Line::Odometry(odometry))),
        _ => Ok(None),
    }
}

struct Words<'a>(std::str::SplitAsciiWhitespace<'a>);

impl Words<'_> {
    fn laser(&mut self, name: &str) -> Result<Laser, String> {
        let ranges = self.list("readings")?;
        let (laser, robot) = (self.pose("laser pose")?, self.pose("odometry")?);
        let start = if name == "RLASER" {
            FRAC_PI_2
        } else {
            -FRAC_PI_2
        };
        Ok(Laser {
            name: name.to_owned(),
            angle_min: start,
            angle_increment: half_turn_step(ranges.len()),
            range_max_m: None,
            ranges,
            laser,
            robot,
            time_ns: self.time()?,
        })
    }

    fn robot_laser(&mut self, name: &str) -> Result<Laser, String> {
        let _laser_type = self.number("type")?;
        let angle_min = self.number("start angle")?;
        let _field_of_view = self.number("field of view")?;
        let angle_increment = self.number("step")?;
        let range_max = self.number("greatest range")?;
        let _accuracy = self.number("accuracy")?;
        let _mode = self.number("remission mode")?;
        let ranges = self.list("readings")?;
        let _remissions = self.list("remissions")?;
        let (laser, robot) = (self.pose("laser pose")?, self.pose("robot pose")?);
        for what in [
            "velocity",
            "velocity",
            "safety distance",
            "safety distance",
            "turn axis",
        ] {
            self.number(what)?;
        }
        Ok(Laser {
            name: name.to_owned(),
            angle_min,
            angle_increment,
            range_max_m: Some(range_max),
            ranges,
            laser,
            robot,
            time_ns: self.time()?,
        })
    }

    fn odometry(&mut self) -> Result<Odometry, String> {
        let robot = self.pose("pose")?;
        let velocities = (self.number("velocity")?, self.number("velocity")?);
        let _acceleration = self.number("acceleration")?;
        Ok(Odometry {
            robot,
            velocities,
            time_ns: self.time()?,
        })
    }

    fn pose(&mut self, what: &str) -> Result<Pose, String> {
        let (x, y, yaw) = (self.number(what)?, self.number(what)?, self.number(what)?);
        Ok(Pose::new(x, y, yaw))
    }

    fn list(&mut self, what: &str) -> Result<Vec<f32>, String> {
        let word = self.0.next().unwrap_or_default();
        let count = word.parse().ok().filter(|count| *count <= MAX_READINGS);
        let count = count.ok_or_else(|| {
            format!("{word:?} is no count of {what}; allowed: 0 to {MAX_READINGS}")
        })?;
        // Readings may be infinite, where nothing returned.
        let reading = |word: &str| word.parse::<f32>().ok().filter(|range| !range.is_nan());
        let mut values = Vec::new();
        for place in 1..=count {
            let word = self.0.next().unwrap_or_default();
            let value = reading(word);
            values.push(value.ok_or_else(|| {
                format!("{word:?} is none of the {count} {what} (the {place}th)")
            })?);
        }
        Ok(values)
    }

    /// A time in decimals, which a number of 64 bits would round to a quarter of a
    /// microsecond.
    fn time(&mut self) -> Result<i64, String> {
        let word = self.0.next().unwrap_or_default();
        exact_ns(word).ok_or_else(|| {
            format!("{word:?} is no time; allowed: seconds from 0 to 9e9, as 976052857.3375")
        })
    }

    fn number(&mut self, what: &str) -> Result<f64, String> {
        let word = self.0.next().unwrap_or_default();
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| format!("{word:?} is no {what}"))
    }
}

/// Seconds as nanoseconds; digits beyond are cut.
fn exact_ns(text: &str) -> Option<i64> {
    let (seconds, fraction) = text.split_once('.').unwrap_or((text, ""));
    let is_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    if !is_digits(seconds) || !is_digits(fraction) {
        return None;
    }
    let seconds = seconds
        .parse()
        .ok()
        .filter(|seconds: &i64| *seconds <= 9_000_000_000)?;
    let nine: String = fraction
        .chars()
        .chain("000000000".chars())
        .take(9)
        .collect();
    Some(seconds * 1_000_000_000 + nine.parse::<i64>().ok()?)
}

fn decimal(time_ns: i64) -> String {
    let (seconds, rest) = (
        time_ns.div_euclid(1_000_000_000),
        time_ns.rem_euclid(1_000_000_000),
    );
    format!("{seconds}.{rest:09}")
}

/// The step of so many beams over half a turn: an odd number of them has one at
/// either end, of an even number the last one is missing.
fn half_turn_step(beams: usize) -> f64 {
    match beams {
        0 | 1 => PI,
        odd if odd % 2 == 1 => PI / (odd - 1) as f64,
        even => PI / even as f64,
    }
}

/// A scan as a line, `FLASER` where that says its angles, else `ROBOTLASER1`.
pub(super) fn laser(scan: &Laser) -> String {
    let beams = scan.ranges.len();
    // Angles of recordings have 32 bits.
    let is_near = |a: f64, b: f64| (a - b).abs() < 1e-6;
    let is_plain = is_near(scan.angle_min, -FRAC_PI_2)
        && beams > 1
        && is_near(scan.angle_increment, half_turn_step(beams));
    let (l, r, time) = (scan.laser, scan.robot, decimal(scan.time_ns));
    let poses = format!("{} {} {} {} {} {}", l.x, l.y, l.yaw, r.x, r.y, r.yaw);
    let mut line = match is_plain {
        true => "FLASER".to_owned(),
        false => {
            let view = scan.angle_increment * beams.saturating_sub(1) as f64;
            let range_max = scan.range_max_m.unwrap_or(0.0);
            let (start, step) = (scan.angle_min, scan.angle_increment);
            format!("ROBOTLASER1 0 {start} {view} {step} {range_max} 0 0")
        }
    };
    // Writing to a string cannot fail.
    let _ = write!(line, " {beams}");
    for range in &scan.ranges {
        let _ = write!(line, " {range}");
    }
    let between = if is_plain { "" } else { " 0" };
    let after = if is_plain { "" } else { " 0 0 0 0 0" };
    line + &format!("{between} {poses}{after} {time} backcast {time}\n")
}

/// Odometry as a line.
pub(super) fn odometry(odometry: &Odometry) -> String {
    let Odometry {
        robot,
        velocities: (forward, turn),
        time_ns,
    } = odometry;
    let (x, y, yaw, time) = (robot.x, robot.y, robot.yaw, decimal(*time_ns));
    format!("ODOM {x} {y} {yaw} {forward} {turn} 0 {time} backcast {time}\n")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const FLASER: &str = "FLASER 3 1.0 81.83 2.5 0.1 0.2 0.3 0 0.2 0.3 976052857.337530 nohost 0.0";

    #[test]
    fn lines_of_both_generations_are_read() {
        let Ok(Some(Line::Laser(old))) = parse(FLASER) else {
            panic!("{:?}", parse(FLASER));
        };
        assert_eq!(old.ranges, [1.0, 81.83, 2.5]);
        assert_eq!(
            (old.angle_min, old.angle_increment),
            (-FRAC_PI_2, FRAC_PI_2)
        );
        assert_eq!((old.laser.x, old.robot.x), (0.1, 0.0));
        assert_eq!(old.time_ns, 976_052_857_337_530_000);
        let new = "ROBOTLASER1 4 -0.5 1.0 0.5 20 0.01 1 3 1 2 3 2 9 9 1 2 0.5 3 4 0.25 0 0 0.1 0.1 \
                   1e6 7.5 host 7.6";
        let Ok(Some(Line::Laser(new))) = parse(new) else {
            panic!("{:?}", parse(new));
        };
        assert_eq!(
            (new.angle_min, new.angle_increment, new.range_max_m),
            (-0.5, 0.5, Some(20.0))
        );
        assert_eq!(
            (new.laser, new.robot),
            (Pose::new(1.0, 2.0, 0.5), Pose::new(3.0, 4.0, 0.25))
        );
        assert_eq!(new.time_ns, 7_500_000_000);
        let Ok(Some(Line::Odometry(odometry))) = parse("ODOM 1 2 3 0.5 0.1 0 7 h 7") else {
            panic!("it is odometry");
        };
        assert_eq!(
            (odometry.velocities, odometry.time_ns),
            ((0.5, 0.1), 7_000_000_000)
        );
    }

    #[test]
    fn other_lines_are_left_out_and_broken_ones_refused() {
        for other in [
            "",
            "# FLASER 1",
            "PARAM robot_length 0.8 ipc 0 h 0",
            "SYNC x",
        ] {
            assert_eq!(parse(other), Ok(None), "{other}");
        }
        let refused = |line: &str| parse(line).unwrap_err();
        assert_eq!(
            refused("FLASER 99999999999 1"),
            "\"99999999999\" is no count of readings; allowed: 0 to 36000"
        );
        assert_eq!(
            refused("FLASER 2 1.0"),
            "\"\" is none of the 2 readings (the 2th)"
        );
        assert_eq!(refused("FLASER 1 1.0 0 0 nan"), "\"nan\" is no laser pose");
        assert_eq!(
            refused("ODOM 1 2 3 4 5 6"),
            "\"\" is no time; allowed: seconds from 0 to 9e9, as 976052857.3375"
        );
        assert!(refused("ODOM 1 2 3 4 5 6 -7").contains("\"-7\" is no time"));
    }

    #[test]
    fn angles_decide_the_kind_of_line() {
        let Ok(Some(Line::Laser(scan))) = parse(FLASER) else {
            panic!("it is a scan");
        };
        assert!(laser(&scan).starts_with("FLASER 3 1 81.83 2.5 0.1 0.2 0.3"));
        let narrow = Laser {
            angle_increment: 0.01,
            ..scan
        };
        assert!(laser(&narrow).starts_with("ROBOTLASER1 0 -1.57"));
    }

    proptest! {
        #[test]
        fn no_line_makes_it_panic(text in "(FLASER|RLASER|ODOM|ROBOTLASER1|x)( [0-9.e-]{0,6}){0,30}") {
            let _ = parse(&text);
        }

        #[test]
        fn what_is_written_is_read(
            ranges in proptest::collection::vec(0f32..100.0, 2..40),
            (step, x, yaw) in (0.001f64..0.2, -1e3f64..1e3, -3f64..3.0),
            time_ns in 0i64..2_000_000_000_000_000_000,
        ) {
            let scan = Laser {
                name: "ROBOTLASER1".to_owned(),
                angle_min: -1.0,
                angle_increment: step,
                range_max_m: Some(80.0),
                ranges,
                laser: Pose::new(x, 0.5, yaw),
                robot: Pose::new(-x, 1.5, yaw),
                time_ns,
            };
            let Ok(Some(Line::Laser(back))) = parse(&laser(&scan)) else {
                panic!("{}", laser(&scan));
            };
            prop_assert_eq!(back, scan);
        }
    }
}
