//! Hints: poses at which the robot is expected.

use super::*;

/// Covariance of a pose that an operator points at in such a small building.
fn pointed() -> Covariance {
    Covariance::from_deviations(0.3, 0.3, 0.2)
}

/// The corresponding pose in the other half of the symmetric building [`ALIKE`].
fn twin(pose: Pose) -> Pose {
    let (width, height) = (ALIKE[0].len() as f64, ALIKE.len() as f64);
    let (x, y) = (
        width * RESOLUTION_M - pose.x,
        height * RESOLUTION_M - pose.y,
    );
    Pose::new(x, y, pose.yaw + PI)
}

/// Gives a tracker the scan of a standing robot, and the answers to all searches in time; returns
/// the search that was needed.
fn stand(building: &Building, tracker: &mut PlaceTracker, truth: Pose) -> Need {
    let still = Some(Pose::IDENTITY);
    building.see(tracker, &building.ends(truth), still, |need| {
        (need != Need::Nothing).then(|| building.found(truth))
    })
}

fn believes(tracker: &PlaceTracker, pose: Pose) -> bool {
    let state = tracker.report().state;
    matches!(state, Unique | Doubtful) && is_at(tracker, pose)
}

#[test]
fn an_expected_pose_is_believed_where_a_scan_confirms_it() {
    let building = building(&ALIKE);
    let mut tracker = PlaceTracker::new(TrackingConfig::default());
    tracker.expect((0, START), pointed());
    building.step(&mut tracker, START, None);
    assert_eq!(tracker.report().state, Unique);
    assert!(is_at(&tracker, START));
    let mut wrong = PlaceTracker::new(TrackingConfig::default());
    wrong.expect(
        (0, Pose::new(3.0, 0.3, 1.0)),
        Covariance::from_deviations(0.1, 0.1, 0.1),
    );
    building.step(&mut wrong, START, None);
    assert_eq!(wrong.report().state, Searching);
    building.drive(&mut wrong, START, 4);
    // It is one of the two places that look alike, or none is believed.
    assert_ne!(wrong.report().state, Unique);
}

#[test]
fn a_hint_near_the_pose_that_is_believed_changes_nothing() {
    let building = building(&UNLIKE);
    let (mut tracker, at) = building.followed(5);
    let before = tracker.report();
    for off in [Pose::new(0.3, -0.2, 0.1), Pose::new(-0.6, 0.0, 0.2)] {
        tracker.expect((0, at.then(off)), pointed());
        assert_eq!(stand(&building, &mut tracker, at), Need::Nothing);
        let after = tracker.report();
        assert_eq!(
            (after.state, after.since_ns),
            (before.state, before.since_ns)
        );
        assert!(is_at(&tracker, at));
    }
}

#[test]
fn a_hint_near_the_one_that_is_tried_starts_nothing_anew() {
    let building = building(&UNLIKE);
    let mut tracker = PlaceTracker::new(TrackingConfig::default());
    tracker.expect((0, START), pointed());
    let still = Some(Pose::IDENTITY);
    assert_eq!(
        unanswered(&building, &mut tracker, START, still),
        Need::ThisScan
    );
    tracker.expect((0, START.then(Pose::new(0.2, 0.1, 0.1))), pointed());
    // The robot stands, and the next key scan decides.
    assert_eq!(stand(&building, &mut tracker, START), Need::Nothing);
    let end = building.drive(&mut tracker, START, 2);
    assert_eq!(tracker.report().state, Unique);
    assert!(is_at(&tracker, end));
}

#[test]
fn wrong_hints_leave_the_pose_as_it_is() {
    let building = building(&UNLIKE);
    let (mut tracker, at) = building.followed(5);
    for i in 0..60 {
        let (row, column) = (i % 4, i / 4 % 5);
        let wrong = Pose::new(
            0.4 + 0.9 * f64::from(column),
            1.9 - 0.4 * f64::from(row),
            1.2 + f64::from(i),
        );
        tracker.expect((0, wrong), Covariance::from_deviations(0.1, 0.1, 0.1));
        stand(&building, &mut tracker, at);
        assert!(
            believes(&tracker, at),
            "{i}: {:?} {wrong:?}",
            tracker.report()
        );
    }
    let end = building.drive(&mut tracker, at, 6);
    assert_eq!(tracker.report().state, Unique);
    assert!(is_at(&tracker, end));
}

#[test]
fn a_hint_at_a_place_that_looks_alike_is_taken_up_and_a_pose_is_there_all_the_while() {
    let building = building(&ALIKE);
    let mut tracker = PlaceTracker::new(TrackingConfig::default());
    tracker.expect((0, START), pointed());
    stand(&building, &mut tracker, START);
    assert_eq!(tracker.report().state, Unique);
    let other = twin(START);
    tracker.expect((0, other.then(Pose::new(0.2, 0.0, 0.1))), pointed());
    let mut scans = 0;
    while !is_at(&tracker, other) {
        assert!(
            believes(&tracker, START) && scans < 4,
            "{:?}",
            tracker.report()
        );
        stand(&building, &mut tracker, START);
        scans += 1;
    }
    assert_eq!(tracker.report().state, Unique);
}

#[test]
fn a_robot_that_was_carried_away_is_believed_where_a_hint_says_it_is() {
    let building = building(&UNLIKE);
    let (mut tracker, _) = building.followed(5);
    let elsewhere = Pose::new(4.0, 1.9, PI);
    tracker.expect((0, elsewhere.then(Pose::new(0.2, 0.1, 0.1))), pointed());
    for _ in 0..3 {
        stand(&building, &mut tracker, elsewhere);
    }
    assert_eq!(tracker.report().state, Unique);
    assert!(is_at(&tracker, elsewhere));
}

#[test]
fn a_hint_is_not_taken_up_without_a_search() {
    let building = building(&ALIKE);
    let mut tracker = PlaceTracker::new(TrackingConfig::default());
    tracker.expect((0, START), pointed());
    stand(&building, &mut tracker, START);
    tracker.expect((0, twin(START)), pointed());
    for _ in 0..6 {
        unanswered(&building, &mut tracker, START, Some(Pose::IDENTITY));
        assert!(believes(&tracker, START));
    }
}
