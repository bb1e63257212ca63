use std::f64::consts::FRAC_PI_2;

use bytemuck::Zeroable;
use messages::{FrameName, Pose2, Stamp};

use super::*;

const KEPT: usize = 5;
const SECOND_NS: i64 = 1_000_000_000;

fn turned(yaw: f64) -> Pose2 {
    Pose2::new(3.0, 4.0, yaw)
}

fn scan(measured_ns: i64) -> ScanHeader {
    ScanHeader {
        stamp: Stamp::measured_at(measured_ns),
        frame: FrameName::new("laser"),
        ..Zeroable::zeroed()
    }
}

fn odometry(child: &str, measured_ns: i64, yaw: f64) -> Odometry {
    Odometry {
        stamp: Stamp::measured_at(measured_ns),
        odom_from_child: turned(yaw),
        child_frame: FrameName::new(child),
        ..Zeroable::zeroed()
    }
}

fn truth(measured_ns: i64, yaw: f64) -> GroundTruth {
    GroundTruth {
        stamp: Stamp::measured_at(measured_ns),
        map_from_laser: turned(yaw),
        frame: FrameName::new("map"),
    }
}

const BY_ODOMETRY: HeadingSource = HeadingSource::Odometry {
    offset: 0.5,
    max_age_ns: SECOND_NS,
};

fn history(readings: &[(i64, f64)]) -> History {
    let mut history = History::keeping(KEPT, &MotionConfig::default());
    for &(measured_ns, yaw) in readings {
        history.on_odometry(&odometry("laser", measured_ns, yaw));
    }
    history
}

#[test]
fn the_delay_of_odometry_is_added_to_its_stamps() {
    let motion = MotionConfig {
        odometry_delay_s: 0.2,
        ..MotionConfig::default()
    };
    let mut history = History::keeping(KEPT, &motion);
    for (measured_ns, yaw) in [(0, 1.0), (100_000_000, 2.0)] {
        history.on_odometry(&odometry("laser", measured_ns, yaw));
    }
    // The second sample is of 0.3 s.
    assert_eq!(heading(BY_ODOMETRY, &scan(250_000_000), &history), 1.5);
    assert_eq!(heading(BY_ODOMETRY, &scan(300_000_000), &history), 2.5);
}

#[track_caller]
fn heading(source: HeadingSource, scan: &ScanHeader, history: &History) -> f64 {
    source.heading_of(scan, history).unwrap().unwrap()
}

#[test]
fn a_searched_heading_is_none_and_a_fixed_one_needs_no_history() {
    let nothing = history(&[]);
    let searched = HeadingSource::Searched.heading_of(&scan(5), &nothing);
    assert_eq!(searched.unwrap(), None);
    assert_eq!(heading(HeadingSource::Fixed(1.5), &scan(5), &nothing), 1.5);
}

#[test]
fn odometry_is_the_newest_that_was_measured_before_the_scan() {
    let history = history(&[(10, 0.1), (20, 0.2), (30, 0.3)]);
    let at = |measured_ns| heading(BY_ODOMETRY, &scan(measured_ns), &history);
    assert_eq!(at(20), 0.2 + 0.5);
    assert_eq!(at(29), 0.2 + 0.5);
    assert_eq!(at(1000), 0.3 + 0.5);
    // A recording that starts again.
    let history = self::history(&[(100, 0.1), (200, 0.2), (10, 0.7)]);
    assert_eq!(heading(BY_ODOMETRY, &scan(15), &history), 0.7 + 0.5);
}

#[test]
fn odometry_that_is_too_old_or_too_new_is_refused() {
    let history = history(&[(10, 0.1)]);
    let refused = |measured_ns| {
        let found = BY_ODOMETRY.heading_of(&scan(measured_ns), &history);
        found.unwrap_err()
    };
    assert_eq!(refused(9), HeadingError::NoOdometry { scan_ns: 9 });
    let limit = scan(10 + SECOND_NS);
    assert_eq!(heading(BY_ODOMETRY, &limit, &history), 0.1 + 0.5);
    let (age_ns, allowed_ns) = (SECOND_NS + 1, SECOND_NS);
    let old = HeadingError::OldOdometry { age_ns, allowed_ns };
    assert_eq!(refused(11 + SECOND_NS), old);
    // Times from corrupt input must not overflow.
    refused(i64::MIN);
    let ancient = self::history(&[(i64::MIN, 0.0)]);
    assert!(BY_ODOMETRY.heading_of(&scan(i64::MAX), &ancient).is_err());
}

#[test]
fn odometry_of_the_base_is_turned_by_the_mount() {
    let mut history = history(&[]);
    history.on_odometry(&odometry("base_link", 10, 0.25));
    let unknown = ScanHeader {
        base_from_laser: turned(1.0),
        ..scan(10)
    };
    assert_eq!(heading(BY_ODOMETRY, &unknown, &history), 0.75);
    let known = ScanHeader {
        mount_known: 1,
        ..unknown
    };
    assert_eq!(heading(BY_ODOMETRY, &known, &history), 1.75);
    history.on_odometry(&odometry("laser", 11, 0.25));
    let later = ScanHeader {
        stamp: Stamp::measured_at(11),
        ..known
    };
    assert_eq!(heading(BY_ODOMETRY, &later, &history), 0.75);
}

#[test]
fn the_laser_sits_on_what_the_odometry_is_about() {
    let mut history = history(&[]);
    history.on_odometry(&odometry("base_link", 10, FRAC_PI_2));
    let mounted = ScanHeader {
        base_from_laser: Pose2::new(0.5, 0.0, 0.25),
        mount_known: 1,
        ..scan(12)
    };
    let pose = history.odom_from_laser(&mounted, 2).unwrap();
    let expected = Pose::new(3.0, 4.5, FRAC_PI_2 + 0.25);
    assert!(pose.is_within(expected, 1e-12, 1e-12), "{pose:?}");
    let (age_ns, allowed_ns) = (2, 1);
    let old = HeadingError::OldOdometry { age_ns, allowed_ns };
    assert_eq!(history.odom_from_laser(&mounted, 1), Err(old));
}

#[test]
fn the_truth_has_exactly_the_time_of_the_scan() {
    let mut history = history(&[]);
    history.on_truth(&truth(10, 0.1));
    history.on_truth(&truth(20, 0.2));
    assert_eq!(heading(HeadingSource::Truth, &scan(10), &history), 0.1);
    let refused = HeadingSource::Truth.heading_of(&scan(11), &history);
    assert_eq!(refused, Err(HeadingError::NoTruth { scan_ns: 11 }));
}

#[test]
fn only_the_last_readings_are_kept() {
    let readings: Vec<(i64, f64)> = (0..=KEPT as i64).map(|i| (i, 0.0)).collect();
    let history = history(&readings);
    assert_eq!(history.odometry.len(), KEPT);
    assert!(BY_ODOMETRY.heading_of(&scan(0), &history).is_err());
    assert!(BY_ODOMETRY.heading_of(&scan(1), &history).is_ok());
}
