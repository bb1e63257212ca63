//! Initial poses: the tracker forgets its pose if the robot may be anywhere, and believes at once a
//! pose of kind `Believed`.

use geometry::{Covariance, Pose};
use messages::{InitialPose, InitialPoseKind, PoseHeader, Stamp, TrackReason, TrackState, topic};
use tests::world::World;
use transport::Publisher;
use transport::testing::Isolated;

use super::lost_searches::Robot;

/// Sends the recording's scan of this number and returns the tracker's pose.
fn pose_of(robot: &Robot, counter: u64) -> PoseHeader {
    robot.pose_after(&robot.send(counter)).0
}

/// Returns the true pose of the laser at the recording's scan of this number.
pub(super) fn truth(robot: &Robot, counter: u64) -> Pose {
    truth_of(&robot.world, counter)
}

/// Returns the true pose of the laser at this scan of a recording.
pub(super) fn truth_of(world: &World, counter: u64) -> Pose {
    let scan = &world.scans()[counter as usize];
    world.truths()[&scan.header.stamp.as_ns()].pose
}

fn say(to: &Publisher<topic::InitialPoseTopic>, kind: InitialPoseKind, pose: Pose) {
    let header = InitialPose {
        kind: kind as u64,
        map_from_base: pose.into(),
        covariance: Covariance::from_deviations(0.1, 0.1, 0.05).to_rows(),
        stamp: Stamp::default(),
    };
    to.send(header, &[]).unwrap();
}

/// Sends scans from this one on until one is Unique, at the true pose; returns the next number.
fn drive_until_unique(robot: &Robot, mut counter: u64) -> u64 {
    loop {
        let pose = pose_of(robot, counter);
        if pose.is_unique() {
            let (found, truth) = (Pose::from(pose.map_from_laser), truth(robot, counter));
            // The accuracy of all results on this recording.
            assert!(found.is_within(truth, 0.2, 0.05), "{found:?} {truth:?}");
            return counter + 1;
        }
        counter += 1;
    }
}

#[test]
fn a_tracker_that_starts_over_forgets_its_pose_and_finds_the_robot_again() {
    let isolated = Isolated::new("start-over");
    let mut robot = Robot::start(&isolated);
    let said = robot.graph.publisher().unwrap();
    let next = drive_until_unique(&robot, 0);
    // A hint that waits for a scan is dropped with it.
    say(&said, InitialPoseKind::Hint, truth(&robot, next));
    say(&said, InitialPoseKind::Anywhere, Pose::IDENTITY);
    let pose = pose_of(&robot, next);
    assert_eq!(pose.state, TrackState::Searching as u32);
    // Only the places of this scan are kept now.
    let reason = TrackReason::from_code(pose.reason);
    let is_first = [TrackReason::SeveralPlaces, TrackReason::TooEarly];
    assert!(is_first.map(Some).contains(&reason), "{reason:?}");
    assert_eq!(pose.since_ns, pose.stamp.measured_ns);
    drive_until_unique(&robot, next + 1);
    robot.stop();
}

#[test]
fn a_hint_is_believed_where_a_scan_confirms_it_and_what_is_said_to_be_believed_at_once() {
    let isolated = Isolated::new("believe");
    let mut robot = Robot::start(&isolated);
    let said = robot.graph.publisher().unwrap();
    let across = truth(&robot, 0).then(Pose::new(0.0, 0.0, std::f64::consts::FRAC_PI_2));
    say(&said, InitialPoseKind::Hint, across);
    let pose = pose_of(&robot, 0);
    assert_eq!(pose.state, TrackState::Searching as u32);
    for (scan, kind) in [(1, InitialPoseKind::Hint), (2, InitialPoseKind::Believed)] {
        let truth = truth(&robot, scan);
        say(&said, kind, truth);
        let pose = pose_of(&robot, scan);
        assert!(pose.is_unique(), "{}", pose.state);
        let found = Pose::from(pose.map_from_laser);
        assert!(found.is_within(truth, 0.2, 0.05), "{found:?} {truth:?}");
    }
    robot.stop();
}
