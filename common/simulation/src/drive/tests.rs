use super::*;
use crate::testing::{config, room};

const PATH: &str = "1,1 9,1 9,7";

fn drive(options: &str) -> Vec<Snapshot> {
    let drive = Drive::new(&room(), &PATH.parse().unwrap(), &config(options)).unwrap();
    drive.collect()
}

#[test]
fn the_same_seed_gives_the_same_drive_and_another_does_not() {
    for sensor in ["", "--sonar --cross-talk 0.1"] {
        let options = |seed| format!("{sensor} --people 3 --outliers 0.1 --seed {seed}");
        let same = |a: &[Snapshot], b: &[Snapshot]| format!("{a:?}") == format!("{b:?}");
        let first = drive(&options(4));
        assert!(same(&first, &drive(&options(4))));
        let other = drive(&options(5));
        assert!(!same(&first, &other));
        let poses = |drive: Vec<Snapshot>| drive.into_iter().map(|scan| scan.map_from_base);
        assert!(poses(first).eq(poses(other)), "the path is not random");
    }
}

#[test]
fn a_scan_is_taken_at_each_tick_from_start_to_end() {
    // 14 m at 0.5 m/s and a quarter turn in two seconds, at 2 Hz.
    let drive = drive("--rate 2");
    assert_eq!(drive.len(), 61);
    assert_eq!(drive[3].wheels.time_ns, 1_500_000_000);
    let end = Pose::new(9.0, 7.0, std::f64::consts::FRAC_PI_2);
    assert!(drive[60].map_from_base.is_within(end, 1e-9, 1e-9));
}

#[test]
fn readings_without_noise_are_those_of_the_room() {
    let first = &drive("--noise 0 --field-of-view 360 --beams 8 --mount 0.5,0,90")[0];
    assert_eq!(first.map_from_laser.x, 1.5);
    // The laser is at 1.5, 1 and looks along y, its first beam to the rear: walls of 0.1 m at 0 and
    // 10 along x, at 0 and 8 along y.
    for (beam, expected) in [(0, 0.9), (2, 8.4), (4, 6.9), (6, 1.4)] {
        let reading = first.ranges[beam];
        // Readings are rounded to millimetres.
        assert!((reading - expected).abs() < 0.0006, "{beam}: {reading}");
    }
}

#[test]
fn each_laser_reads_from_its_own_place() {
    let options = "--noise 0 --field-of-view 180 --beams 3";
    let lasers = "--laser a=0.5,0,0 --laser b=-0.3,0,180 --laser c=0,0,0,180";
    let first = &drive(&format!("{options} {lasers}"))[0];
    assert_eq!(first.map_from_laser.x, 1.5);
    // The lasers are at x = 1.5, 0.7 and 1, and y = 1: walls of 0.1 m at 0 and 10 along x, at 0 and
    // 8 along y. A laser that looks ahead has a wall at 0.9 m to its right and one at 6.9 m to its
    // left; upside down it is the other way.
    let scans = [&first.ranges, &first.others[0], &first.others[1]];
    let expected = [[0.9, 8.4, 6.9], [6.9, 0.6, 0.9], [6.9, 8.9, 0.9]];
    for (scan, expected) in scans.into_iter().zip(expected) {
        for (reading, expected) in scan.iter().zip(expected) {
            // Readings are rounded to millimetres.
            assert!((reading - expected).abs() < 0.0006, "{scan:?}");
        }
    }
}

#[test]
fn more_lasers_change_nothing_of_the_first() {
    let options = "--people 3 --outliers 0.1";
    let alone = drive(&format!("{options} --mount 0.5,0,0"));
    let lasers = "--laser a=0.5,0,0 --laser b=-0.3,0,180";
    let joined = drive(&format!("{options} {lasers}"));
    assert_eq!(alone.len(), joined.len());
    for (alone, joined) in alone.into_iter().zip(joined) {
        assert_eq!(joined.others.len(), 1);
        let joined = Snapshot {
            others: Vec::new(),
            ..joined
        };
        assert_eq!(alone, joined);
    }
}

#[test]
fn the_robot_drives_on_while_a_scan_is_measured() {
    let options = "--noise 0 --odometry-noise-per-metre 0 --field-of-view 1 --beams 3";
    let moving = drive(&format!("{options} --scan-duration 0.1 --rate 5"));
    let first = &moving[0];
    // At 0.5 m/s the robot approaches the wall at 9.9 m by 5 cm within 0.1 s; the outer beams are
    // half a degree askew, which is less than a millimetre.
    for (reading, expected) in first.ranges.iter().zip([8.9, 8.875, 8.85]) {
        assert!((reading - expected).abs() < 0.0011, "{:?}", first.ranges);
    }
    let after = first.after.unwrap();
    // In 32 bits, 0.1 s is exact to some nanoseconds.
    assert!((after.time_ns - 100_000_000).abs() < 10, "{after:?}");
    let expected = Pose::new(0.05, 0.0, 0.0);
    assert!(
        after.odom_from_base.is_within(expected, 1e-7, 1e-9),
        "{after:?}"
    );
    assert!((after.twist.x - 0.5).abs() < 1e-9, "{after:?}");
    assert!(drive(options).iter().all(|instant| instant.after.is_none()));
}

#[test]
fn what_cannot_be_driven_is_refused_where() {
    let path = PATH.parse().unwrap();
    for (options, expected) in [
        (
            "--laser a=0,0,0 --laser b=0,0,0 --laser a=1,0,0",
            "two lasers are called a; allowed are lasers with names of their own",
        ),
        (
            "--scan-duration 0.2 --rate 5",
            "a scan takes 0.2 s and the next begins after 0.2 s",
        ),
        (
            "--mount -0.95,0,0",
            "the sensor comes into an obstacle at 0.05,1.00, where its mount puts it 0.00 s after the start",
        ),
        (
            "--mount -2,0,0",
            "the sensor comes off the map at -1.00,1.00, where its mount puts it 0.00 s after the start",
        ),
        (
            "--rate 1000 --speed 0.01",
            "the drive takes 1402 s, which is 1402001 scans; at most 864000 are simulated",
        ),
    ] {
        let error = Drive::new(&room(), &path, &config(options)).unwrap_err();
        assert!(error.to_string().starts_with(expected), "{error}");
    }
}

#[test]
fn people_are_seen_and_change_nothing_else() {
    let (alone, crowd) = (drive("--noise 0"), drive("--noise 0 --people 10"));
    let mut nearer = 0;
    for (alone, crowd) in alone.iter().zip(&crowd) {
        assert_eq!(alone.wheels, crowd.wheels);
        for (alone, crowd) in alone.ranges.iter().zip(&crowd.ranges) {
            assert!(crowd <= alone);
            nearer += u32::from(crowd < alone);
        }
    }
    assert!(nearer > 1000, "{nearer}");
}
