mod blind;
mod building;
mod drawn;
mod floors;
mod hints;

use std::f64::consts::PI;

use messages::TrackReason::{
    self, NoPlace, NoScan, NoSearch, OdometryJump, OnePlace, PoorFit, SeveralPlaces,
};
use messages::TrackState::{self, Doubtful, Lost, Searching, Unique};

use super::*;
use crate::fit::{Ends, FitConfig};
use crate::grid::Grid;
use crate::localizer::{Localizer, PreparedMap, Settings, Workspace};
use crate::occupancy_map::Map;
use crate::peaks::Target;
use crate::scan::Scan;
use crate::testing::{RESOLUTION_M, scan_from};
use crate::vote_search::VoteSearchConfig;

use self::building::{ALIKE, Robot, UNLIKE};

const START: Pose = Pose::new(1.0, 0.8, 0.0);

const AHEAD: Pose = Pose::new(0.3, 0.0, 0.0);
const STILL: Option<Pose> = Some(Pose::IDENTITY);

/// A pose in another part of [`UNLIKE`].
const ELSEWHERE: Pose = Pose::new(4.0, 1.9, PI);

#[test]
fn one_scan_is_never_enough_and_a_few_metres_are() {
    let mut robot = Robot::on(&[&UNLIKE]);
    assert_eq!(robot.scan(None), Need::ThisScan);
    assert_eq!(robot.state(), Searching);
    robot.drive(10);
    robot.check_found();
    let report = robot.tracker.report();
    assert_eq!(report.reason, OnePlace);
    assert!(report.covariance.to_rows()[0].sqrt() < 0.1 && report.probability > 0.94);
}

#[test]
fn a_doubt_stays_until_a_search_has_an_answer() {
    let mut robot = Robot::followed(5);
    // The robot is carried off for one scan: a search is needed, and has no answer.
    let before = robot.pose;
    robot.pose.yaw += PI / 2.0;
    assert_eq!(robot.scan_unanswered(STILL), Need::ThisScan);
    assert_eq!(robot.state(), Doubtful);
    // The scan fits again, but no search has covered other places.
    robot.pose = before;
    let mut asked = 0;
    for _ in 0..4 {
        robot.pose = robot.pose.then(AHEAD);
        asked += u32::from(robot.scan_unanswered(Some(AHEAD)) == Need::ThisScan);
        assert_eq!(robot.said(), (Doubtful, PoorFit));
    }
    assert!(asked >= 2, "{asked} searches were asked for");
    assert!(robot.is_at(robot.pose));
    robot.drive(3);
    robot.check_found();
}

#[test]
fn the_map_is_only_blamed_after_a_search() {
    let mut robot = Robot::on(&[&UNLIKE]);
    robot.scan_unanswered(None);
    assert_eq!(robot.said(), (Searching, NoSearch));
    let ends = robot.maps[0].ends(&robot.ranges());
    let need = robot.see_ends(&ends, None, |_, _| Some(Vec::new()));
    assert_eq!(need, Need::ThisScan);
    assert_eq!(robot.said(), (Searching, NoPlace));
}

#[test]
fn nothing_becomes_the_only_place_without_a_search() {
    let mut robot = Robot::on(&[&UNLIKE]);
    robot.scan(None);
    for _ in 0..6 {
        robot.pose = robot.pose.then(AHEAD);
        robot.scan_unanswered(Some(AHEAD));
        assert_ne!(robot.state(), Unique);
    }
    robot.drive(4);
    assert_eq!(robot.state(), Unique);
}

#[test]
fn places_that_look_alike_are_never_distinguished() {
    let robot = Robot::tracked(&ALIKE, 6);
    assert_eq!(robot.said(), (Searching, SeveralPlaces));
    let report = robot.tracker.report();
    assert_eq!(report.rivals, 2, "{}", report.words());
    // The two places are half a turn and metres apart: the covariance spans both.
    let deviation = report.covariance.to_rows()[0].sqrt();
    assert!(deviation > 0.3, "{deviation}");
}

#[test]
fn a_robot_that_is_carried_away_is_noticed_at_once_and_found_again() {
    let mut robot = Robot::tracked(&UNLIKE, 8);
    assert_eq!(robot.state(), Unique);
    robot.pose = ELSEWHERE;
    assert_eq!(robot.scan(STILL), Need::ThisScan);
    assert_eq!(robot.said(), (Doubtful, PoorFit));
    robot.drive(9);
    robot.check_found();
}

#[test]
fn where_it_is_not_known_how_the_robot_moved_three_key_scans_have_to_agree_again() {
    let mut robot = Robot::followed(5);
    let step = Pose::new(0.45, 0.0, 0.0);
    // Odometry restarts while the robot drives on.
    let steps = [
        (Pose::new(0.6, -0.1, -0.1), None),
        (step, Some(step)),
        (step, Some(step)),
    ];
    let states = steps.map(|(step, moved)| {
        robot.pose = robot.pose.then(step);
        assert_eq!(robot.scan(moved), Need::ThisScan);
        robot.state()
    });
    assert_eq!(states, [Doubtful, Doubtful, Unique]);
    robot.check_found();
}

/// States at key scans in which `of_nine` of nine beams pass through walls, after scans that fit.
fn states_where_scans_fit_badly(of_nine: usize) -> Vec<TrackState> {
    let mut robot = Robot::followed(5);
    let step = Pose::new(0.0, 0.0, 0.36);
    let take = |_| {
        robot.pose = robot.pose.then(step);
        let ends = robot.maps[0].ends(&stretched(robot.ranges(), of_nine));
        // A search finds nothing better.
        robot.see_ends(&ends, Some(step), |_, need| {
            (need != Need::Nothing).then(Vec::new)
        });
        robot.state()
    };
    (0..20).map(take).collect()
}

/// Lets `of_nine` of nine beams pass through walls.
fn stretched(mut ranges: Vec<f32>, of_nine: usize) -> Vec<f32> {
    for nine in ranges.chunks_mut(9) {
        nine[..of_nine].iter_mut().for_each(|range| *range *= 1.6);
    }
    ranges
}

#[test]
fn what_fits_badly_for_long_is_not_taken_for_good() {
    let states = states_where_scans_fit_badly(5);
    assert!(!states.contains(&Unique), "{states:?}");
    // This fits well enough for a new place: the building has changed.
    let states = states_where_scans_fit_badly(3);
    let doubtful = states.iter().take_while(|state| **state == Doubtful);
    let (doubtful, after) = states.split_at(doubtful.count());
    assert!((1..8).contains(&doubtful.len()), "{states:?}");
    assert!(after.iter().all(|state| *state == Unique), "{states:?}");
}

#[test]
fn what_odometry_misses_is_followed() {
    let mut robot = Robot::tracked(&UNLIKE, 8);
    // The robot turns by 20° and the wheels do not report it.
    robot.pose = robot.pose.then(Pose::new(0.3, 0.0, 0.35));
    robot.scan(Some(AHEAD));
    assert!(robot.is_at(robot.pose));
    assert_eq!(robot.said(), (Doubtful, OdometryJump));
    robot.drive(2);
    assert_eq!(robot.state(), Unique);
}

#[test]
fn a_laser_whose_scans_stay_the_same_while_odometry_drives_on_is_doubted_and_lost() {
    let mut robot = Robot::tracked(&UNLIKE, 8);
    assert_eq!(robot.state(), Unique);
    let take = |_| {
        robot.scan(Some(Pose::new(0.1, 0.0, 0.0)));
        robot.state()
    };
    let states: Vec<TrackState> = (0..60).map(take).collect();
    // A metre is more than the error of odometry, and the fault lasts.
    assert!(!states[10..].contains(&Unique), "{states:?}");
    assert!(states.contains(&Lost), "{states:?}");
    assert_eq!(robot.said().1, OdometryJump);
}

#[test]
fn a_robot_that_stands_keeps_its_pose() {
    let mut robot = Robot::tracked(&UNLIKE, 8);
    let pose = robot.tracker.report().pose;
    for i in 0..100 {
        let mut ranges = robot.ranges();
        for (beam, range) in ranges.iter_mut().enumerate() {
            // Errors of up to 3 cm, different at each scan.
            *range += 0.03 * ((beam * 7 + i * 13) as f32).sin();
        }
        robot.see(&ranges, STILL, |_| false);
    }
    assert_eq!(robot.state(), Unique);
    let moved = pose.zip(robot.tracker.report().pose).unwrap();
    assert!(moved.0.is_within(moved.1, 0.02, 0.005), "{moved:?}");
}

#[test]
fn without_odometry_scans_show_how_the_robot_moved() {
    let robot = Robot::on(&[&UNLIKE]);
    let building = &robot.maps[0];
    let mut matcher = matching::ScanMatcher::default();
    let mut step_to = |pose| {
        let (ends, fit) = (building.ends(&building.ranges(pose)), FitConfig::default());
        matcher.moved(
            &building.seen(&ends, &fit),
            None,
            &TrackingConfig::default(),
        )
    };
    let start = Pose::new(1.5, 1.0, 0.0);
    let (mut at, mut found) = (start, start);
    // A turn to the left, and back to the right.
    for i in 0..12 {
        let turn = if i < 6 { 0.08 } else { -0.08 };
        let step = step_to(at);
        assert_eq!(step.is_none(), i == 0, "{i}");
        found = found.then(step.unwrap_or(Pose::IDENTITY));
        // Tolerance: a cell, and the angle of a cell at five metres.
        assert!(found.is_within(at, 0.1, 0.02), "{i}: {found:?} at {at:?}");
        at = at.then(Pose::new(0.05, 0.0, turn));
    }
    assert_eq!(step_to(ELSEWHERE), None, "this scan does not match");
}

#[test]
fn while_the_pose_is_sure_few_scans_are_searched() {
    let mut robot = Robot::followed(4);
    let step = Pose::new(0.0, 0.0, 0.36);
    let (mut asked, mut due) = (0, 0);
    // The robot turns on the spot: each scan is a key scan.
    for _ in 0..40 {
        robot.pose = robot.pose.then(step);
        let ends = robot.maps[0].ends(&robot.ranges());
        let earlier = robot.pose.then(step.inverse()).then(step.inverse());
        let need = robot.see_ends(&ends, Some(step), |maps, need| {
            (need == Need::EarlierScan).then(|| maps[0].found(&maps[0].ranges(earlier)))
        });
        assert_ne!(need, Need::ThisScan);
        due += u32::from(need == Need::EarlierScan);
        asked += u32::from(robot.tracker.asks_ahead());
    }
    assert_eq!((asked, due), (3, 3));
    robot.check_found();
}

#[test]
fn a_scan_of_nothing_changes_nothing() {
    let mut robot = Robot::on(&[&UNLIKE]);
    let need = robot.see_ends(&Ends::default(), None, |_, _| None);
    assert_eq!(need, Need::Nothing);
    assert_eq!(robot.said(), (Searching, NoScan));
    assert_eq!(robot.tracker.report().pose, None);
}

#[test]
fn tracking_allocates_nothing() {
    let mut robot = Robot::tracked(&UNLIKE, 8);
    let step = Pose::new(0.0, 0.0, 0.1);
    for _ in 0..20 {
        robot.pose = robot.pose.then(step);
        let ends = robot.maps[0].ends(&robot.ranges());
        let seen = robot.maps[0].seen(&ends, &robot.fit);
        let tracker = &mut robot.tracker;
        let allocated = allocation_counter::measure(|| {
            if tracker.begin(&[seen], 1, Some(step)) == Need::Nothing {
                tracker.finish(&[seen], None);
            }
        });
        assert_eq!(allocated.count_total, 0);
    }
}

#[test]
fn where_one_scan_is_believed_rooms_that_are_alike_are_not() {
    let config = TrackingConfig {
        start: Start::Believe,
        ..TrackingConfig::default()
    };
    let after_a_scan = |rows: &[&str]| {
        let mut robot = Robot::on(&[rows]);
        robot.tracker = PlaceTracker::new(config);
        robot.scan(None);
        robot
    };
    after_a_scan(&UNLIKE).check_found();
    assert_eq!(after_a_scan(&ALIKE).state(), Searching);
}
