//! Reads lines of CARMEN's laser logs; the format is described in `carmen`.

use std::str::SplitAsciiWhitespace;

use geometry::Pose;

use super::carmen::{Angles, Broken, Kind, Laser, Line, Odometry, Parameter, Poses, laser_named};

/// Largest number of ranges in a line: a full turn in steps of a hundredth of a degree.
const MAX_READINGS: usize = 36_000;

pub(super) fn parse(line: &str) -> Result<Line, Broken> {
    let mut words = Words {
        words: line.split_ascii_whitespace(),
    };
    let Some(name) = words.words.next() else {
        return Ok(Line::Nothing);
    };
    let parsed = match name {
        _ if name.starts_with('#') => Ok(Line::Nothing),
        "SYNC" => Ok(Line::Nothing),
        "PARAM" => Ok(words.parameter()),
        "ODOM" => words.odometry().map(Line::Odometry),
        _ => match laser_named(name) {
            Some((kind, number)) => words.laser(kind, number).map(Line::Laser),
            None => Ok(Line::Other(name.to_owned())),
        },
    };
    parsed.map_err(|(fault, reason)| Broken {
        name: name.to_owned(),
        fault,
        reason,
    })
}

type Refusal = (&'static str, String);

#[derive(Clone)]
struct Words<'a> {
    words: SplitAsciiWhitespace<'a>,
}

impl<'a> Words<'a> {
    fn laser(&mut self, kind: Kind, number: u8) -> Result<Laser, Refusal> {
        let (angles, range_max_m) = match kind {
            Kind::Old => (None, None),
            Kind::Raw | Kind::Robot => self.config()?,
        };
        let ranges = self.list("readings")?;
        let has_poses = kind == Kind::Robot || (kind == Kind::Old && number <= 2);
        // CARMEN's own notes on the format omit the remissions, and so do some programs that follow
        // them.
        let mut without = self.clone();
        let with = match kind {
            Kind::Old => Ok(Vec::new()),
            Kind::Raw | Kind::Robot => self.list("remissions"),
        };
        let rest = with.and_then(|_| self.rest(kind, has_poses));
        let (poses, time_ns) =
            rest.or_else(|refusal| without.rest(kind, has_poses).map_err(|_| refusal))?;
        Ok(Laser {
            kind,
            number,
            angles,
            range_max_m,
            ranges,
            poses,
            time_ns,
        })
    }

    fn rest(&mut self, kind: Kind, has_poses: bool) -> Result<(Option<Poses>, i64), Refusal> {
        let poses = match has_poses {
            true => Some(Poses {
                laser: self.pose("laser pose")?,
                robot: self.pose("robot pose")?,
            }),
            false => None,
        };
        if kind == Kind::Robot {
            self.numbers(&["velocity", "velocity", "safety distance", "safety distance"])?;
            self.numbers(&["turn axis"])?;
        }
        Ok((poses, self.time()?))
    }

    fn config(&mut self) -> Result<(Option<Angles>, Option<f64>), Refusal> {
        self.numbers(&["type"])?;
        let angles = Angles {
            start: self.number("start angle")?,
            field_of_view: self.number("field of view")?,
            step: self.number("step")?,
        };
        let range_max = self.number("greatest range")?;
        self.numbers(&["accuracy", "remission mode"])?;
        Ok((Some(angles), Some(range_max).filter(|range| *range > 0.0)))
    }

    fn odometry(&mut self) -> Result<Odometry, Refusal> {
        let robot = self.pose("pose")?;
        let velocities = (self.number("velocity")?, self.number("velocity")?);
        self.numbers(&["acceleration"])?;
        Ok(Odometry {
            robot,
            velocities,
            time_ns: self.time()?,
        })
    }

    fn parameter(&mut self) -> Line {
        match (self.words.next(), self.words.next()) {
            (Some(name), Some(value)) => Line::Parameter(Parameter {
                name: name.to_owned(),
                value: value.to_owned(),
            }),
            // A parameter without a value is ignored.
            _ => Line::Nothing,
        }
    }

    fn pose(&mut self, what: &str) -> Result<Pose, Refusal> {
        let (x, y, yaw) = (self.number(what)?, self.number(what)?, self.number(what)?);
        Ok(Pose::new(x, y, yaw))
    }

    fn list(&mut self, what: &str) -> Result<Vec<f32>, Refusal> {
        let word = self.next(what)?;
        let count = word.parse().ok().filter(|count| *count <= MAX_READINGS);
        let count: usize = count.ok_or_else(|| {
            let reason = format!("{word:?} is not a count of {what}; allowed: 0 to {MAX_READINGS}");
            ("with a wrong count", reason)
        })?;
        let mut values = Vec::new();
        for place in 1..=count {
            let word = self.words.next().ok_or_else(|| {
                let reason = format!("of {count} {what} {} are there", place - 1);
                ("cut short", reason)
            })?;
            values.push(reading(word));
        }
        Ok(values)
    }

    /// Reads a time in nanoseconds from its decimals; a 64-bit float would round it to a quarter of
    /// a microsecond.
    fn time(&mut self) -> Result<i64, Refusal> {
        let word = self.next("time")?;
        exact_ns(word).ok_or_else(|| {
            let allowed = "allowed: seconds from 0 to 9e9, as 976052857.3375";
            (
                "with a wrong time",
                format!("{word:?} is no time; {allowed}"),
            )
        })
    }

    fn numbers(&mut self, names: &[&str]) -> Result<(), Refusal> {
        names
            .iter()
            .try_for_each(|name| self.number(name).map(drop))
    }

    fn number(&mut self, what: &str) -> Result<f64, Refusal> {
        let word = self.next(what)?;
        let number = word.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| ("with what is no number", format!("{word:?} is no {what}")))
    }

    fn next(&mut self, what: &str) -> Result<&'a str, Refusal> {
        let cut = || ("cut short", format!("it ends before the {what}"));
        self.words.next().ok_or_else(cut)
    }
}

/// A range: NaN for a missing beam, infinite if nothing returned, which C on Windows writes as
/// `1.#INF`.
fn reading(word: &str) -> f32 {
    match word.parse() {
        Ok(range) => range,
        Err(_) if word.starts_with("1.#INF") => f32::INFINITY,
        Err(_) => f32::NAN,
    }
}

/// Converts seconds to nanoseconds; further digits are cut off.
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const FLASER: &str = "FLASER 3 1.0 81.83 2.5 0.1 0.2 0.3 0 0.2 0.3 976052857.337530 nohost 0.0";

    fn laser(line: &str) -> Laser {
        match parse(line) {
            Ok(Line::Laser(laser)) => laser,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn lines_of_all_generations_are_read() {
        let old = laser(FLASER);
        assert_eq!((old.kind, old.number, old.angles), (Kind::Old, 1, None));
        assert_eq!(old.ranges, [1.0, 81.83, 2.5]);
        let poses = old.poses.unwrap();
        assert_eq!((poses.laser.x, poses.robot.x), (0.1, 0.0));
        assert_eq!(old.time_ns, 976_052_857_337_530_000);
        let third = laser("LASER3 2 1.0 2.0 7.5 h 7.5");
        assert_eq!((third.kind, third.number), (Kind::Old, 3));
        assert_eq!((third.poses, third.time_ns), (None, 7_500_000_000));
        let new = laser(
            "ROBOTLASER1 4 -0.5 1.0 0.5 20 0.01 1 3 1 2 3 2 9 9 1 2 0.5 3 4 0.25 0 0 0.1 0.1 1e6 \
             7.5 host 7.6",
        );
        let angles = Angles {
            start: -0.5,
            field_of_view: 1.0,
            step: 0.5,
        };
        assert_eq!((new.angles, new.range_max_m), (Some(angles), Some(20.0)));
        let poses = Poses {
            laser: Pose::new(1.0, 2.0, 0.5),
            robot: Pose::new(3.0, 4.0, 0.25),
        };
        assert_eq!(new.poses, Some(poses));
        assert_eq!(new.time_ns, 7_500_000_000);
        for number in 1..=5 {
            let raw = laser(&format!(
                "RAWLASER{number} 0 -0.5 1.0 0.5 0 0.01 0 2 1 2 0 7.5 host 7.6"
            ));
            assert_eq!((raw.kind, raw.number, raw.poses), (Kind::Raw, number, None));
            assert_eq!((raw.angles, raw.range_max_m), (Some(angles), None));
            assert_eq!(raw.name(), format!("RAWLASER{number}"));
        }
        let bare = laser("RAWLASER1 0 -0.5 1.0 0.5 0 0.01 0 2 1 2 7.5 host 7.6");
        assert_eq!((bare.ranges.len(), bare.time_ns), (2, 7_500_000_000));
        let bare = laser(
            "ROBOTLASER1 4 -0.5 1.0 0.5 20 0.01 1 3 1 2 3 1 2 0.5 3 4 0.25 0 0 0.1 0.1 1e6 7.5 h 7",
        );
        assert_eq!((bare.poses, bare.time_ns), (Some(poses), 7_500_000_000));
        let Ok(Line::Odometry(odometry)) = parse("ODOM 1 2 3 0.5 0.1 0 7 h 7") else {
            panic!("it is odometry");
        };
        assert_eq!(
            (odometry.velocities, odometry.time_ns),
            ((0.5, 0.1), 7_000_000_000)
        );
        let parameter = Parameter {
            name: "robot_length".to_owned(),
            value: "0.8".to_owned(),
        };
        let line = parse("PARAM robot_length 0.8 ipc 0 h 0\r");
        assert_eq!(line, Ok(Line::Parameter(parameter)));
    }

    #[test]
    fn a_reading_that_is_no_number_is_one_missing_beam() {
        let readings = "nan 1.5 -nan 1.#QNAN ??? inf 1.#INF 0";
        let line = format!("FLASER 8 {readings} 0.1 0.2 0.3 0 0.2 0.3 7.5 h 0");
        let ranges = laser(&line).ranges;
        let missing: Vec<bool> = ranges.iter().map(|range| range.is_nan()).collect();
        let expected = [true, false, true, true, true, false, false, false];
        assert_eq!(missing, expected);
        assert_eq!(
            (ranges[1], ranges[5], ranges[6]),
            (1.5, f32::INFINITY, f32::INFINITY)
        );
    }

    #[test]
    fn other_lines_are_named_and_broken_ones_refused() {
        for nothing in ["", "# FLASER 1", "SYNC x", "PARAM alone", "\r"] {
            assert_eq!(parse(nothing), Ok(Line::Nothing), "{nothing}");
        }
        for other in "TRUEPOS RAWLASER6 RAWLASER LASER1 ROBOTLASER_ACK1 XLASER3".split(' ') {
            let line = parse(&format!("{other} 1 2"));
            assert_eq!(line, Ok(Line::Other(other.to_owned())));
        }
        for (line, fault, reason) in [
            (
                "FLASER 99999999999 1",
                "with a wrong count",
                "\"99999999999\" is not a count of readings; allowed: 0 to 36000",
            ),
            ("FLASER 2 1.0", "cut short", "of 2 readings 1 are there"),
            (
                "FLASER 1 1.0 0 0 nan",
                "with what is no number",
                "\"nan\" is no laser pose",
            ),
            ("ODOM 1 2 3 4 5 6", "cut short", "it ends before the time"),
            (
                "ODOM 1 2 3 4 5 6 -7",
                "with a wrong time",
                "\"-7\" is no time; allowed: seconds from 0 to 9e9, as 976052857.3375",
            ),
        ] {
            let broken = parse(line).unwrap_err();
            assert_eq!((broken.fault, &*broken.reason), (fault, reason));
        }
    }

    proptest! {
        #[test]
        fn no_line_makes_it_panic(
            text in "(FLASER|RLASER|LASER3|ODOM|PARAM|RAWLASER2|ROBOTLASER1|x)( [0-9.e-]{0,6}){0,30}",
        ) {
            let _ = parse(&text);
        }
    }
}
