//! Hints: poses at which the robot is expected.

use super::*;

/// Covariance of a pose that an operator points at in such a small building.
fn pointed() -> Covariance {
    Covariance::from_deviations(0.3, 0.3, 0.2)
}

/// The corresponding pose in the other half of the symmetric building [`ALIKE`].
fn twin(pose: Pose) -> Pose {
    let side = |cells: usize| RESOLUTION_M * cells as f64;
    let (x, y) = (side(ALIKE[0].len()) - pose.x, side(ALIKE.len()) - pose.y);
    Pose::new(x, y, pose.yaw + PI)
}

impl Robot {
    fn expect(&mut self, pose: Pose) {
        self.tracker.expect((0, pose), pointed());
    }

    /// Gives the tracker the scan of the standing robot, and the answers to all searches in time;
    /// returns the search that was needed.
    fn stand(&mut self) -> Need {
        self.see(&self.ranges(), STILL, |need| need != Need::Nothing)
    }

    fn believes(&self, pose: Pose) -> bool {
        matches!(self.state(), Unique | Doubtful) && self.is_at(pose)
    }
}

#[test]
fn an_expected_pose_is_believed_where_a_scan_confirms_it() {
    let mut robot = Robot::on(&[&ALIKE]);
    robot.expect(START);
    robot.scan(None);
    robot.check_found();
    let mut robot = Robot::on(&[&ALIKE]);
    let (wrong, covariance) = (
        Pose::new(3.0, 0.3, 1.0),
        Covariance::from_deviations(0.1, 0.1, 0.1),
    );
    robot.tracker.expect((0, wrong), covariance);
    robot.scan(None);
    assert_eq!(robot.state(), Searching);
    robot.drive(4);
    // It is one of the two places that look alike, or none is believed.
    assert_ne!(robot.state(), Unique);
}

#[test]
fn a_hint_near_the_pose_that_is_believed_changes_nothing() {
    let mut robot = Robot::followed(5);
    let since_ns = robot.tracker.report().since_ns;
    for off in [Pose::new(0.3, -0.2, 0.1), Pose::new(-0.6, 0.0, 0.2)] {
        robot.expect(robot.pose.then(off));
        assert_eq!(robot.stand(), Need::Nothing);
        robot.check_found();
        assert_eq!(robot.tracker.report().since_ns, since_ns);
    }
}

#[test]
fn a_hint_near_the_one_that_is_tried_starts_nothing_anew() {
    let mut robot = Robot::on(&[&UNLIKE]);
    robot.expect(START);
    assert_eq!(robot.scan_unanswered(STILL), Need::ThisScan);
    robot.expect(START.then(Pose::new(0.2, 0.1, 0.1)));
    // The robot stands, and the next key scan decides.
    assert_eq!(robot.stand(), Need::Nothing);
    robot.drive(2);
    robot.check_found();
}

#[test]
fn wrong_hints_leave_the_pose_as_it_is() {
    let mut robot = Robot::followed(5);
    for i in 0..60 {
        let (row, column) = (f64::from(i % 4), f64::from(i / 4 % 5));
        let wrong = Pose::new(0.4 + 0.9 * column, 1.9 - 0.4 * row, 1.2 + f64::from(i));
        let covariance = Covariance::from_deviations(0.1, 0.1, 0.1);
        robot.tracker.expect((0, wrong), covariance);
        robot.stand();
        let report = robot.tracker.report();
        assert!(robot.believes(robot.pose), "{i}: {report:?} {wrong:?}");
    }
    robot.drive(6);
    robot.check_found();
}

#[test]
fn a_hint_at_a_place_that_looks_alike_is_taken_up_and_a_pose_is_there_all_the_while() {
    let mut robot = Robot::on(&[&ALIKE]);
    robot.expect(START);
    robot.stand();
    assert_eq!(robot.state(), Unique);
    let other = twin(START);
    robot.expect(other.then(Pose::new(0.2, 0.0, 0.1)));
    let mut scans = 0;
    while !robot.is_at(other) {
        let report = robot.tracker.report();
        assert!(robot.believes(START) && scans < 4, "{report:?}");
        robot.stand();
        scans += 1;
    }
    assert_eq!(robot.state(), Unique);
}

#[test]
fn a_robot_that_was_carried_away_is_believed_where_a_hint_says_it_is() {
    let mut robot = Robot::followed(5);
    robot.pose = ELSEWHERE;
    robot.expect(ELSEWHERE.then(Pose::new(0.2, 0.1, 0.1)));
    for _ in 0..3 {
        robot.stand();
    }
    robot.check_found();
}

#[test]
fn a_hint_is_not_taken_up_without_a_search() {
    let mut robot = Robot::on(&[&ALIKE]);
    robot.expect(START);
    robot.stand();
    robot.expect(twin(START));
    for _ in 0..6 {
        robot.scan_unanswered(STILL);
        assert!(robot.believes(START));
    }
}
