//! Scans without usable beams, as of a covered laser.

use super::*;

#[test]
fn a_robot_that_sees_nothing_goes_on_by_odometry_and_is_doubtful_once_it_may_be_elsewhere() {
    let mut robot = Robot::followed(4);
    let believed = robot.tracker.report().pose.unwrap();
    let deviation = |robot: &Robot| robot.tracker.report().covariance.to_rows()[0].sqrt();
    let before = deviation(&robot);
    let step = Pose::new(0.2, 0.0, 0.0);
    let see_nothing = |robot: &mut Robot| {
        let need = robot.see_ends(&Ends::default(), Some(step), |_, _| None);
        assert_eq!(need, Need::Nothing);
        robot.tracker.report()
    };
    for number in 1..=9 {
        let report = see_nothing(&mut robot);
        let expected = believed.then(Pose::new(0.2 * f64::from(number), 0.0, 0.0));
        let pose = report.pose.unwrap();
        assert!(
            pose.is_within(expected, 1e-9, 1e-9),
            "{pose:?} {expected:?}"
        );
        assert_eq!(report.state, Unique);
    }
    assert!(deviation(&robot) > before.hypot(0.25));
    // The next usable scan finds the robot there.
    robot.pose = robot.pose.then(Pose::new(2.0, 0.0, 0.0));
    robot.scan(Some(step));
    robot.check_found();
    // After 2.1 m the heading has a standard deviation of 7.5 degrees; two of them do not single
    // out a place.
    let states: Vec<_> = (0..14).map(|_| see_nothing(&mut robot).state).collect();
    assert_eq!(states[..9], [Unique; 9]);
    assert_eq!(states[11..], [Doubtful; 3]);
    let report = robot.tracker.report();
    assert_eq!((report.reason, report.score), (PoorFit, 0.0));
}

#[test]
fn a_robot_that_sees_nothing_and_has_no_odometry_is_doubtful_at_once() {
    let mut robot = Robot::followed(4);
    robot.see_ends(&Ends::default(), None, |_, _| None);
    assert_eq!(robot.state(), Doubtful);
}
