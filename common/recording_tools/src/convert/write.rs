//! Lines for a log of CARMEN: `FLASER` where that says a scan's angles, else
//! `ROBOTLASER1`, and `ODOM`.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;

use super::angles::{HALF_TURN, step_over};
use super::carmen::{Odometry, Poses};

/// A scan to write, beams counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scan {
    pub(super) angle_min: f64,
    pub(super) angle_increment: f64,
    /// Readings of this much and more are no returns.
    pub(super) range_max_m: f64,
    pub(super) ranges: Vec<f32>,
    pub(super) poses: Poses,
    pub(super) time_ns: i64,
}

fn decimal(time_ns: i64) -> String {
    let (seconds, rest) = (
        time_ns.div_euclid(1_000_000_000),
        time_ns.rem_euclid(1_000_000_000),
    );
    format!("{seconds}.{rest:09}")
}

/// A scan as a line.
pub(super) fn scan(scan: &Scan) -> String {
    let beams = scan.ranges.len();
    // Angles of recordings have 32 bits.
    let is_near = |a: f64, b: f64| (a - b).abs() < 1e-6;
    let is_plain = is_near(scan.angle_min, -FRAC_PI_2)
        && beams > 1
        && is_near(scan.angle_increment, step_over(HALF_TURN, beams));
    let (l, r, time) = (scan.poses.laser, scan.poses.robot, decimal(scan.time_ns));
    let poses = format!("{} {} {} {} {} {}", l.x, l.y, l.yaw, r.x, r.y, r.yaw);
    let mut line = match is_plain {
        true => "FLASER".to_owned(),
        false => {
            let view = scan.angle_increment * beams.saturating_sub(1) as f64;
            let (start, step) = (scan.angle_min, scan.angle_increment);
            format!(
                "ROBOTLASER1 0 {start} {view} {step} {} 0 0",
                scan.range_max_m
            )
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
    use geometry::Pose;
    use proptest::prelude::*;

    use super::super::carmen::{Angles, Line};
    use super::super::read::parse;
    use super::*;

    #[test]
    fn angles_decide_the_kind_of_line() {
        let half = Scan {
            angle_min: -FRAC_PI_2,
            angle_increment: FRAC_PI_2,
            range_max_m: 80.0,
            ranges: vec![1.0, 81.83, 2.5],
            poses: Poses {
                laser: Pose::new(0.1, 0.2, 0.3),
                robot: Pose::IDENTITY,
            },
            time_ns: 7,
        };
        let line = scan(&half);
        assert!(
            line.starts_with("FLASER 3 1 81.83 2.5 0.1 0.2 0.3 0"),
            "{line}"
        );
        let narrow = Scan {
            angle_increment: 0.01,
            ..half
        };
        assert!(scan(&narrow).starts_with("ROBOTLASER1 0 -1.57"));
    }

    proptest! {
        #[test]
        fn what_is_written_is_read(
            ranges in proptest::collection::vec(0f32..100.0, 2..40),
            (step, x, yaw) in (0.001f64..0.2, -1e3f64..1e3, -3f64..3.0),
            time_ns in 0i64..2_000_000_000_000_000_000,
        ) {
            let written = Scan {
                angle_min: -1.0,
                angle_increment: step,
                range_max_m: 80.0,
                ranges,
                poses: Poses {
                    laser: Pose::new(x, 0.5, yaw),
                    robot: Pose::new(-x, 1.5, yaw),
                },
                time_ns,
            };
            let line = scan(&written);
            let Ok(Line::Laser(read)) = parse(line.trim_end()) else {
                panic!("{line}");
            };
            let angles = Angles {
                start: -1.0,
                field_of_view: step * (written.ranges.len() - 1) as f64,
                step,
            };
            prop_assert_eq!(read.angles, Some(angles));
            prop_assert_eq!((read.range_max_m, read.time_ns), (Some(80.0), time_ns));
            prop_assert_eq!((read.ranges, read.poses), (written.ranges, Some(written.poses)));
        }
    }
}
