use std::f64::consts::{FRAC_PI_2, PI};

use super::*;
use crate::localizer::Settings;
use crate::occupancy_map::Map;
use crate::testing::{RESOLUTION_M, scan_from};
use messages::TrackState;

const SIDES: (usize, usize) = (120, 80);
const PERIOD_NS: i64 = 100_000_000;

/// A hall of 12 m × 8 m with a store room in a corner; no turn and no mirror makes it look alike.
/// Walls are a cell thick: a scan fits anywhere in a thicker one.
fn is_wall(x: f64, y: f64) -> bool {
    let (x, y) = ((x / RESOLUTION_M) as usize, (y / RESOLUTION_M) as usize);
    let is_store_room = (x == 76 && y > 50) || (y == 51 && x > 75);
    x == 0 || y == 0 || x == SIDES.0 - 1 || y == SIDES.1 - 1 || is_store_room
}

fn localizer() -> Localizer {
    let (width, height) = SIDES;
    let centre = |cell: usize| (cell as f64 + 0.5) * RESOLUTION_M;
    let occupied = |i: usize| is_wall(centre(i % width), centre(i / width));
    let cells: Vec<u8> = (0..width * height)
        .map(|i| 100 * u8::from(occupied(i)))
        .collect();
    let map = Map::new(RESOLUTION_M, Pose::IDENTITY, SIDES, &cells);
    Localizer::new(map, Settings::default()).unwrap()
}

fn tracker() -> Tracker {
    Tracker::new(localizer(), TrackerSettings::default())
}

/// Ranges of a laser with a beam a degree in the half turn ahead of it.
fn ranges_at(laser: Pose) -> Vec<f32> {
    let range = |beam: i32| {
        let (sin, cos) = (laser.yaw - FRAC_PI_2 + f64::from(beam).to_radians()).sin_cos();
        let mut ranges = (0..).map(|step| 0.02 * f64::from(step));
        ranges.find(|r| is_wall(laser.x + r * cos, laser.y + r * sin))
    };
    (0..=180).map(|beam| range(beam).unwrap() as f32).collect()
}

fn scan(ranges: &[f32], stamp_ns: i64, base_from_laser: Option<Pose>) -> TimedScan<'_> {
    TimedScan {
        scan: scan_from(-FRAC_PI_2, 1f64.to_radians(), ranges),
        stamp_ns,
        time_increment_s: 0.0,
        base_from_laser,
    }
}

fn check_near(found: Option<(Pose, Covariance)>, truth: Pose) {
    let (pose, _) = found.unwrap();
    // A cell, and two degrees: ranges are rounded to 2 cm.
    assert!(
        pose.is_within(truth, 0.1, 0.035),
        "{pose:?} is not {truth:?}"
    );
}

/// Drives along y = 2.5 m by 0.3 m a scan, with odometry; returns the last pose of the base.
fn drive(tracker: &mut Tracker, mounts: &[Option<Pose>], steps: i64) -> (Pose, TrackedPose) {
    let mut last = None;
    for step in 0..steps {
        let base = Pose::new(2.0 + 0.3 * step as f64, 2.5, 0.0);
        let stamp_ns = step * PERIOD_NS;
        let odometry = Pose::new(base.x - 2.0, 0.0, 0.0);
        tracker.add_odometry(stamp_ns, odometry).unwrap();
        let at = |mount: &Option<Pose>| ranges_at(base.then(mount.unwrap_or_default()));
        let ranges: Vec<Vec<f32>> = mounts.iter().map(at).collect();
        let scans = ranges.iter().zip(mounts);
        let scans: Vec<_> = scans
            .map(|(ranges, mount)| scan(ranges, stamp_ns, *mount))
            .collect();
        last = Some((base, tracker.update(&scans).unwrap()));
    }
    last.unwrap()
}

const FRONT: Option<Pose> = Some(Pose::new(0.3, 0.0, 0.0));
const REAR: Option<Pose> = Some(Pose::new(-0.3, 0.0, PI));

#[test]
fn a_robot_is_found_and_tracked() {
    let mut tracker = tracker();
    let (truth, tracked) = drive(&mut tracker, &[None], 14);
    assert_eq!(tracked.report.state, TrackState::Unique);
    assert_eq!((tracked.base(), tracked.stamp_ns), (None, 13 * PERIOD_NS));
    check_near(tracked.laser(), truth);
    let origin = tracked.map_from_odom().unwrap();
    assert!(origin.is_within(Pose::new(2.0, 2.5, 0.0), 0.1, 0.035));
    tracker.reset();
    let (_, tracked) = drive(&mut tracker, &[None], 1);
    assert_eq!(tracked.report.state, TrackState::Searching);
    assert!(tracked.is_searched && tracked.left_out.is_empty());
}

#[test]
fn scans_of_two_lasers_give_the_pose_of_the_base() {
    let mut tracker = tracker();
    let (truth, tracked) = drive(&mut tracker, &[FRONT, REAR], 14);
    assert_eq!(tracked.report.state, TrackState::Unique);
    check_near(tracked.base(), truth);
    check_near(tracked.laser(), truth.then(FRONT.unwrap()));
    // The rear laser measures at half the rate: its last scan is carried on by odometry.
    let at = |step: i64| Pose::new(2.0 + 0.3 * step as f64, 2.5, 0.0);
    let rear = ranges_at(at(13).then(REAR.unwrap()));
    for (step, left_out) in [(14, 0), (15, 1)] {
        tracker
            .add_odometry(step * PERIOD_NS, Pose::new(0.3 * step as f64, 0.0, 0.0))
            .unwrap();
        let front = ranges_at(at(step).then(FRONT.unwrap()));
        let scans = [
            scan(&front, step * PERIOD_NS, FRONT),
            scan(&rear, 13 * PERIOD_NS, REAR),
        ];
        let tracked = tracker.update(&scans).unwrap();
        assert_eq!(tracked.left_out.len(), left_out, "{:?}", tracked.left_out);
        check_near(tracked.base(), at(step));
    }
}

#[test]
fn a_search_that_is_stopped_gives_no_pose_and_the_next_scan_is_searched() {
    let (mut tracker, truth) = (tracker(), Pose::new(2.0, 2.5, 0.0));
    let ranges = ranges_at(truth);
    let stopped = tracker.update_unless(&[scan(&ranges, 0, None)], &|| true);
    assert_eq!(stopped, Ok(None));
    let tracked = tracker.update(&[scan(&ranges, PERIOD_NS, None)]).unwrap();
    assert!(tracked.is_searched);
    check_near(tracked.laser(), truth);
}

#[test]
fn scans_that_are_rejected_change_nothing() {
    let mut tracker = tracker();
    let ranges = ranges_at(Pose::new(2.0, 2.5, 0.0));
    let (front, rear) = (scan(&ranges, 5 * PERIOD_NS, FRONT), scan(&ranges, 0, REAR));
    let mut rejected = |scans: &[TimedScan<'_>]| tracker.update(scans).unwrap_err();
    let lasers = |given, lasers| EngineError::Lasers { given, lasers };
    assert_eq!(rejected(&[]), lasers(0, 1));
    let laser = "1".to_owned();
    assert_eq!(
        rejected(&[front, scan(&ranges, 0, None)]),
        EngineError::NoMount { laser }
    );
    let late = TimedScan {
        stamp_ns: front.stamp_ns + 1_000_000_001,
        ..rear
    };
    let apart = |error: &EngineError| matches!(error, EngineError::StampsApart { laser: 1, .. });
    assert!(apart(&rejected(&[front, late])));
    let odd = TimedScan {
        time_increment_s: f64::INFINITY,
        ..front
    };
    assert_eq!(rejected(&[odd]), EngineError::TimeIncrement(f64::INFINITY));
    tracker.update(&[front, rear]).unwrap();
    let mut rejected = |scans: &[TimedScan<'_>]| tracker.update(scans).unwrap_err();
    assert_eq!(rejected(&[front]), lasers(1, 2));
    let same = EngineError::StampOrder {
        laser: 0,
        stamp_ns: front.stamp_ns,
        later_ns: 0,
    };
    assert_eq!(rejected(&[front, rear]), same);
    let lost = Pose::new(f64::NAN, 0.0, 0.0);
    assert!(tracker.add_odometry(0, lost).is_err());
    tracker.reset();
    tracker.update(&[front]).unwrap();
}

#[test]
fn an_expected_pose_is_tried_first_and_must_be_on_the_map() {
    let mut tracker = tracker();
    let near = Covariance::from_deviations(0.5, 0.5, 0.26);
    let truth = Pose::new(2.0, 2.5, 0.0);
    for (map, pose) in [(0, Pose::new(-0.1, 2.5, 0.0)), (1, truth)] {
        let off = EngineError::ExpectedPose { map, pose };
        assert_eq!(tracker.expect((map, pose), near), Err(off));
    }
    let flat = Covariance::from_deviations(0.5, 0.5, 0.0);
    assert!(matches!(
        tracker.expect((0, truth), flat),
        Err(EngineError::Covariance(_))
    ));
    tracker.expect((0, truth), near).unwrap();
    let (_, tracked) = drive(&mut tracker, &[None], 1);
    check_near(tracked.laser(), truth);
}
