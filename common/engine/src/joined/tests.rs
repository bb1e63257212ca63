use bytemuck::Zeroable;
use messages::{Pose2, Stamp};

use super::*;

const MS: i64 = 1_000_000;

fn stamp(ms: i64) -> Stamp {
    Stamp::measured_at(ms * MS)
}

/// A laser ahead at 0.5 m or behind at -0.5 m, with three beams at 0, 90 and 180 degrees.
fn scan(laser: &str, ms: i64) -> ScanHeader {
    let ahead = laser != "rear";
    ScanHeader {
        stamp: stamp(ms),
        angle_increment: std::f64::consts::FRAC_PI_2,
        range_max_m: 30.0,
        base_from_laser: match ahead {
            true => Pose2::new(0.5, 0.0, 0.0),
            false => Pose2::new(-0.5, 0.0, std::f64::consts::PI),
        },
        mount_known: 1,
        laser: Name::new(laser),
        frame: FrameName::new(laser),
        ..ScanHeader::zeroed()
    }
}

/// Odometry of a robot that drives ahead at 1 m/s.
fn odometry(ms: i64) -> Odometry {
    Odometry {
        stamp: stamp(ms),
        odom_from_child: Pose2::new(ms as f64 / 1000.0, 0.0, 0.0),
        child_frame: FrameName::new("base_link"),
        ..Odometry::zeroed()
    }
}

fn pair() -> Joiner {
    Joiner::new(JoinConfig {
        scans: vec!["front".into(), "rear".into()],
        ..JoinConfig::default()
    })
}

/// x of each laser in the target frame at each beam.
fn places(joiner: &Joiner) -> Vec<Vec<f64>> {
    match joiner.seen() {
        Seen::Still(_) => Vec::new(),
        Seen::Carried(scans) => {
            let xs = |scan: &CarriedScan<'_>| scan.target_from_laser.iter().map(|p| p.x).collect();
            scans.iter().map(xs).collect()
        }
    }
}

/// Compares with a tolerance for sums and rotations of numbers near 1.
#[track_caller]
fn check_places(joiner: &Joiner, expected: &[&[f64]]) {
    let found = places(joiner);
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(*expected) {
            assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
        }
    }
}

const RANGES: [f32; 3] = [2.0, 2.0, 2.0];

#[test]
fn the_motion_within_a_scan_is_taken_out() {
    let mut joiner = Joiner::new(JoinConfig::default());
    let moving = ScanHeader {
        time_increment_s: 0.02,
        ..scan("", 100)
    };
    assert_eq!(joiner.on_scan(&moving, &RANGES), Role::Trigger);
    assert!(!joiner.lacks_odometry(), "none flows");
    assert_eq!(joiner.bring().unwrap().motion, MotionKnown::Unknown);
    assert!(matches!(joiner.seen(), Seen::Still(_)));
    joiner.on_odometry(&odometry(50));
    joiner.on_odometry(&odometry(120));
    assert!(joiner.lacks_odometry());
    assert_eq!(joiner.bring().unwrap().motion, MotionKnown::LastTwist);
    joiner.on_odometry(&odometry(150));
    assert!(!joiner.lacks_odometry());
    assert_eq!(joiner.bring().unwrap().motion, MotionKnown::ByOdometry);
    check_places(&joiner, &[&[-0.02, 0.0, 0.02]]);
    assert!(!joiner.targets_base());
}

#[test]
fn odometry_of_the_stamp_of_a_scan_counts_for_it_to_the_nanosecond() {
    for odd in [0, 1] {
        let at = |ms: i64| Stamp::measured_at(ms * MS + odd);
        let mut joiner = Joiner::new(JoinConfig::default());
        for ms in [0, 1000] {
            joiner.on_odometry(&Odometry {
                stamp: at(ms),
                ..odometry(ms)
            });
        }
        let header = ScanHeader {
            stamp: at(1000),
            ..scan("", 1000)
        };
        joiner.on_scan(&header, &RANGES);
        let by_odometry = joiner.by_odometry().unwrap();
        let odom_from_base = by_odometry.odom_from_target.then(Pose::new(-0.5, 0.0, 0.0));
        assert_eq!(odom_from_base, Pose::new(1.0, 0.0, 0.0), "{odd}");
    }
}

#[test]
fn the_stamp_may_be_of_another_beam_and_odometry_late() {
    let mut joiner = Joiner::new(JoinConfig {
        motion: MotionConfig {
            scan_stamp: ScanStamp::Last,
            odometry_delay_s: 0.05,
            ..MotionConfig::default()
        },
        ..JoinConfig::default()
    });
    for ms in [0, 50, 100] {
        joiner.on_odometry(&odometry(ms));
    }
    let moving = ScanHeader {
        time_increment_s: 0.02,
        ..scan("", 100)
    };
    joiner.on_scan(&moving, &RANGES);
    assert_eq!(joiner.bring().unwrap().motion, MotionKnown::ByOdometry);
    check_places(&joiner, &[&[-0.02, 0.0, 0.02]]);
    let still = ScanHeader {
        time_increment_s: 0.0,
        ..moving
    };
    joiner.on_scan(&still, &RANGES);
    assert_eq!(joiner.bring().unwrap().motion, MotionKnown::NotNeeded);
    assert!(matches!(joiner.seen(), Seen::Still(_)));
}

#[test]
fn several_lasers_are_seen_from_the_base_at_the_time_of_the_first() {
    let mut joiner = pair();
    for ms in [0, 50, 100] {
        joiner.on_odometry(&odometry(ms));
    }
    assert_eq!(joiner.on_scan(&scan("rear", 40), &RANGES), Role::Kept);
    assert_eq!(joiner.on_scan(&scan("side", 40), &RANGES), Role::Other);
    assert_eq!(joiner.on_scan(&scan("front", 100), &RANGES), Role::Trigger);
    let brought = joiner.bring().unwrap();
    assert_eq!((brought.lasers, brought.left_out.len()), (2, 0));
    check_places(&joiner, &[&[0.5; 3], &[-0.56; 3]]);
    assert!(joiner.targets_base());
}

#[test]
fn a_laser_that_cannot_be_joined_is_left_out_and_named() {
    let mut joiner = pair();
    let left_out = |joiner: &mut Joiner| {
        let brought = joiner.bring().unwrap();
        assert_eq!(brought.lasers + brought.left_out.len() as u32, 2);
        let reasons = brought.left_out.into_iter();
        reasons.map(|(laser, why)| format!("{laser}: {why}")).next()
    };
    joiner.on_scan(&scan("front", 100), &RANGES);
    assert_eq!(left_out(&mut joiner).unwrap(), "rear: no scan received");
    joiner.on_scan(&scan("rear", 100), &RANGES);
    assert_eq!(left_out(&mut joiner), None, "no odometry, nothing moves");
    // One scan every 50 ms from now on.
    joiner.on_scan(&scan("rear", 150), &RANGES);
    joiner.on_scan(&scan("front", 225), &RANGES);
    assert_eq!(left_out(&mut joiner), None);
    joiner.on_scan(&scan("front", 226), &RANGES);
    let old = "rear: its newest scan is 76 ms older, more than 1.5 scan periods";
    assert_eq!(left_out(&mut joiner).unwrap(), old);
    let lost = ScanHeader {
        mount_known: 0,
        ..scan("rear", 226)
    };
    joiner.on_scan(&lost, &RANGES);
    assert_eq!(
        left_out(&mut joiner).unwrap(),
        "rear: its mount on the base is not known"
    );
    joiner.on_scan(&scan("rear", 226), &[]);
    assert!(left_out(&mut joiner).unwrap().contains("no ranges"));
    // The robot moved when odometry ended, long ago.
    joiner.on_odometry(&odometry(300));
    joiner.on_odometry(&odometry(400));
    joiner.on_scan(&scan("rear", 990), &RANGES);
    joiner.on_scan(&scan("front", 1000), &RANGES);
    assert_eq!(
        left_out(&mut joiner).unwrap(),
        "rear: no odometry for the robot's motion since"
    );
}

#[test]
fn the_first_laser_must_be_sound() {
    let mut joiner = pair();
    joiner.on_scan(&scan("front", 0), &[]);
    assert_eq!(joiner.bring(), Err(EngineError::EmptyScan));
    let lost = ScanHeader {
        mount_known: 0,
        ..scan("front", 0)
    };
    joiner.on_scan(&lost, &RANGES);
    let error = joiner.bring().unwrap_err().to_string();
    assert!(error.contains("pose of laser front on the base"), "{error}");
}

#[test]
fn odometry_that_begins_anew_says_nothing_of_the_motion_since_before() {
    let mut joiner = Joiner::new(JoinConfig::default());
    let at = |joiner: &mut Joiner, ms| {
        joiner.on_odometry(&odometry(ms));
        joiner.on_scan(&scan("", ms), &RANGES);
        joiner.by_odometry().unwrap()
    };
    let (one, two) = (at(&mut joiner, 3000), at(&mut joiner, 3500));
    let moved = two.moved_since(&one).unwrap();
    assert!(moved.is_within(Pose::new(0.5, 0.0, 0.0), 1e-9, 1e-9));
    // Odometry restarts; the robot has not moved.
    joiner.on_odometry(&Odometry {
        odom_from_child: Pose::IDENTITY.into(),
        ..odometry(4000)
    });
    joiner.on_scan(&scan("", 4000), &RANGES);
    let anew = joiner.by_odometry().unwrap();
    assert_eq!(anew.moved_since(&two), None);
    assert_eq!(joiner.by_newest_odometry(), Some(anew));
}
