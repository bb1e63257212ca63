//! Scans without usable beams, as of a covered laser.

use super::*;

#[test]
fn a_robot_that_sees_nothing_goes_on_by_odometry_and_is_doubtful_once_it_may_be_elsewhere() {
    let building = building(&UNLIKE);
    let (mut tracker, start) = building.followed(4);
    let believed = tracker.report().pose.unwrap();
    let deviation = tracker.report().covariance.to_rows()[0].sqrt();
    let step = Pose::new(0.2, 0.0, 0.0);
    let see_nothing = |tracker: &mut PlaceTracker| {
        let need = building.see(tracker, &Ends::default(), Some(step), |_| None);
        assert_eq!(need, Need::Nothing);
        tracker.report()
    };
    for number in 1..=9 {
        let report = see_nothing(&mut tracker);
        let expected = believed.then(Pose::new(0.2 * f64::from(number), 0.0, 0.0));
        let pose = report.pose.unwrap();
        assert!(
            pose.is_within(expected, 1e-9, 1e-9),
            "{pose:?} {expected:?}"
        );
        assert_eq!(report.state, Unique);
    }
    let report = tracker.report();
    assert!(
        report.covariance.to_rows()[0].sqrt() > deviation.hypot(0.25),
        "{report:?}"
    );
    // The next usable scan finds the robot there.
    let end = start.then(Pose::new(2.0, 0.0, 0.0));
    building.step(&mut tracker, end, Some(step));
    assert!(is_at(&tracker, end), "{:?}", tracker.report());
    assert_eq!(tracker.report().state, Unique);
    // After 2.1 m the heading has a standard deviation of 7.5 degrees; two of them do not single
    // out a place.
    let states: Vec<_> = (0..14).map(|_| see_nothing(&mut tracker).state).collect();
    assert_eq!(states[..9], [Unique; 9]);
    assert_eq!(states[11..], [Doubtful; 3]);
    let report = tracker.report();
    assert_eq!((report.reason, report.score), (PoorFit, 0.0));
}

#[test]
fn a_robot_that_sees_nothing_and_has_no_odometry_is_doubtful_at_once() {
    let building = building(&UNLIKE);
    let (mut tracker, _) = building.followed(4);
    building.see(&mut tracker, &Ends::default(), None, |_| None);
    assert_eq!(tracker.report().state, Doubtful);
}
