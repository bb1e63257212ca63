//! Scans that see nothing, as of a laser that is covered.

use super::*;

#[test]
fn a_robot_that_sees_nothing_goes_on_by_odometry_and_is_doubtful_soon() {
    let building = building(&UNLIKE);
    let mut tracker = Tracker::new(TrackingConfig::default());
    building.step(&mut tracker, START, None);
    let start = building.drive(&mut tracker, START, 4);
    let believed = tracker.report().pose.unwrap();
    let deviation = tracker.report().covariance[(0, 0)].sqrt();
    assert_eq!(tracker.report().state, TrackState::Unique);
    let (nothing, fit) = (Ends::default(), FitConfig::default());
    let seen = building.seen(&nothing, &fit);
    let step = Pose::new(0.2, 0.0, 0.0);
    let mut states = Vec::new();
    for number in 1..=10 {
        assert_eq!(tracker.begin(&[seen], 1, Some(step)), Need::Nothing);
        tracker.finish(&[seen], None);
        let report = tracker.report();
        let expected = believed.then(Pose::new(0.2 * f64::from(number), 0.0, 0.0));
        let pose = report.pose.unwrap();
        assert!(
            pose.is_within(expected, 1e-9, 1e-9),
            "{pose:?} {expected:?}"
        );
        states.push(report.state);
    }
    // Where a key scan is due, there is nothing to go by.
    assert_eq!(states[0], TrackState::Unique);
    assert_eq!(states[1..], [TrackState::Doubtful; 9]);
    let report = tracker.report();
    assert!(
        report.covariance[(0, 0)].sqrt() > deviation + 0.2,
        "{report:?}"
    );
    assert_eq!((report.reason, report.score), (TrackReason::PoorFit, 0.0));
    // The next scan that sees something finds it there.
    let end = start.then(Pose::new(2.2, 0.0, 0.0));
    building.step(&mut tracker, end, Some(step));
    assert!(is_at(&tracker, end), "{:?}", tracker.report());
    assert_eq!(tracker.report().state, TrackState::Unique);
}

#[test]
fn a_robot_that_sees_nothing_and_has_no_odometry_is_doubtful_at_once() {
    let building = building(&UNLIKE);
    let mut tracker = Tracker::new(TrackingConfig::default());
    building.step(&mut tracker, START, None);
    building.drive(&mut tracker, START, 4);
    let (nothing, fit) = (Ends::default(), FitConfig::default());
    let seen = building.seen(&nothing, &fit);
    tracker.begin(&[seen], 1, None);
    tracker.finish(&[seen], None);
    assert_eq!(tracker.report().state, TrackState::Doubtful);
}
