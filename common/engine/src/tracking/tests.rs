mod blind;
mod building;
mod drawn;
mod floors;
mod hints;

use std::f64::consts::PI;

use messages::TrackReason::{
    NoPlace, NoScan, NoSearch, OdometryJump, OnePlace, PoorFit, SeveralPlaces,
};
use messages::TrackState::{self, Doubtful, Lost, Searching, Unique};

use super::*;
use crate::beams::BeamConfig;
use crate::fit::{DistanceField, Ends, FitConfig};
use crate::grid::{CellRules, Grid, GridFrame};
use crate::peaks::{self, PeakConfig, PeakInput, Target};
use crate::scan::Scan;
use crate::space::Space;
use crate::testing::{RESOLUTION_M, scan_from};
use crate::vote_search::{Prior, VoteSearch, VoteSearchConfig};

use self::building::{ALIKE, Building, UNLIKE, building};

const START: Pose = Pose::new(1.0, 0.8, 0.0);

fn is_at(tracker: &PlaceTracker, truth: Pose) -> bool {
    let pose = tracker.report().pose;
    pose.is_some_and(|pose| pose.is_within(truth, 0.1, 0.05))
}

#[test]
fn one_scan_is_never_enough_and_a_few_metres_are() {
    let building = building(&UNLIKE);
    let mut tracker = PlaceTracker::new(TrackingConfig::default());
    assert_eq!(building.step(&mut tracker, START, None), Need::ThisScan);
    assert_eq!(tracker.report().state, Searching);
    let end = building.drive(&mut tracker, START, 10);
    let report = tracker.report();
    assert_eq!((report.state, report.reason), (Unique, OnePlace));
    assert!(is_at(&tracker, end), "{report:?}");
    assert!(report.covariance.to_rows()[0].sqrt() < 0.1 && report.probability > 0.94);
}

/// Handles a scan without answers to searches.
fn unanswered(
    building: &Building,
    tracker: &mut PlaceTracker,
    truth: Pose,
    moved: Option<Pose>,
) -> Need {
    building.see(tracker, &building.ends(truth), moved, |_| None)
}

#[test]
fn a_doubt_stays_until_a_search_has_an_answer() {
    let building = building(&UNLIKE);
    let (mut tracker, end) = building.followed(5);
    // The robot is carried off for one scan: a search is needed, and has no answer.
    let elsewhere = Pose::new(end.x, end.y, end.yaw + PI / 2.0);
    let still = Some(Pose::IDENTITY);
    let need = unanswered(&building, &mut tracker, elsewhere, still);
    assert_eq!((need, tracker.report().state), (Need::ThisScan, Doubtful));
    // The scan fits again, but no search has covered other places.
    let step = Pose::new(0.3, 0.0, 0.0);
    let (mut pose, mut asked) = (end, 0);
    for _ in 0..4 {
        pose = pose.then(step);
        let need = unanswered(&building, &mut tracker, pose, Some(step));
        asked += u32::from(need == Need::ThisScan);
        let report = tracker.report();
        assert_eq!((report.state, report.reason), (Doubtful, PoorFit));
    }
    assert!(asked >= 2, "{asked} searches were asked for");
    assert!(is_at(&tracker, pose));
    let end = building.drive(&mut tracker, pose, 3);
    assert_eq!(tracker.report().state, Unique);
    assert!(is_at(&tracker, end));
}

#[test]
fn the_map_is_only_blamed_after_a_search() {
    let building = building(&UNLIKE);
    let mut tracker = PlaceTracker::new(TrackingConfig::default());
    unanswered(&building, &mut tracker, START, None);
    assert_eq!(tracker.report().reason, NoSearch);
    let found_nothing = |_: Need| Some(Vec::new());
    let need = building.see(&mut tracker, &building.ends(START), None, found_nothing);
    assert_eq!(need, Need::ThisScan);
    assert_eq!(tracker.report().reason, NoPlace);
}

#[test]
fn nothing_becomes_the_only_place_without_a_search() {
    let building = building(&UNLIKE);
    let mut tracker = PlaceTracker::new(TrackingConfig::default());
    building.step(&mut tracker, START, None);
    let step = Pose::new(0.3, 0.0, 0.0);
    let mut pose = START;
    for _ in 0..6 {
        pose = pose.then(step);
        unanswered(&building, &mut tracker, pose, Some(step));
        assert_ne!(tracker.report().state, Unique);
    }
    building.drive(&mut tracker, pose, 4);
    assert_eq!(tracker.report().state, Unique);
}

#[test]
fn places_that_look_alike_are_never_distinguished() {
    let building = building(&ALIKE);
    let (tracker, _) = building.tracked(6);
    let report = tracker.report();
    assert_eq!((report.state, report.reason), (Searching, SeveralPlaces));
    assert_eq!(report.rivals, 2, "{}", report.words());
    // The two places are half a turn and metres apart: the covariance spans both.
    assert!(
        report.covariance.to_rows()[0].sqrt() > 0.3,
        "{:?}",
        report.covariance
    );
}

#[test]
fn a_robot_that_is_carried_away_is_noticed_at_once_and_found_again() {
    let building = building(&UNLIKE);
    let (mut tracker, _) = building.tracked(8);
    assert_eq!(tracker.report().state, Unique);
    let elsewhere = Pose::new(4.0, 1.9, PI);
    assert_eq!(
        building.step(&mut tracker, elsewhere, Some(Pose::IDENTITY)),
        Need::ThisScan
    );
    let report = tracker.report();
    assert_eq!((report.state, report.reason), (Doubtful, PoorFit));
    let end = building.drive(&mut tracker, elsewhere, 9);
    assert_eq!(tracker.report().state, Unique);
    assert!(is_at(&tracker, end));
}

#[test]
fn where_it_is_not_known_how_the_robot_moved_three_key_scans_have_to_agree_again() {
    let building = building(&UNLIKE);
    let (mut tracker, end) = building.followed(5);
    // Odometry restarts while the robot drives on.
    let mut at = end.then(Pose::new(0.6, -0.1, -0.1));
    let step = Pose::new(0.45, 0.0, 0.0);
    let mut states = Vec::new();
    let mut moved = None;
    for _ in 0..3 {
        assert_eq!(building.step(&mut tracker, at, moved), Need::ThisScan);
        states.push(tracker.report().state);
        moved = Some(step);
        at = at.then(step);
    }
    assert_eq!(states, [Doubtful, Doubtful, Unique]);
    assert!(is_at(&tracker, at.then(step.inverse())));
}

/// States at key scans in which `of_nine` of nine beams pass through walls, after scans that fit.
fn states_where_scans_fit_badly(of_nine: usize) -> Vec<TrackState> {
    let building = building(&UNLIKE);
    let (mut tracker, mut at) = building.followed(5);
    let step = Pose::new(0.0, 0.0, 0.36);
    let take = |_| {
        at = at.then(step);
        let mut ranges = building.ranges(at);
        for nine in ranges.chunks_mut(9) {
            nine[..of_nine].iter_mut().for_each(|range| *range *= 1.6);
        }
        // A search finds nothing better.
        let find = |need: Need| (need != Need::Nothing).then(Vec::new);
        building.see(&mut tracker, &building.ends_of(&ranges), Some(step), find);
        tracker.report().state
    };
    (0..20).map(take).collect()
}

#[test]
fn what_fits_badly_for_long_is_not_taken_for_good() {
    let states = states_where_scans_fit_badly(5);
    assert!(states.iter().all(|state| *state != Unique), "{states:?}");
    // This fits well enough for a new place: the building has changed.
    let states = states_where_scans_fit_badly(3);
    let doubtful = states.iter().take_while(|state| **state == Doubtful);
    let doubtful = doubtful.count();
    assert!((1..8).contains(&doubtful), "{states:?}");
    assert!(
        states[doubtful..].iter().all(|state| *state == Unique),
        "{states:?}"
    );
}

#[test]
fn what_odometry_misses_is_followed() {
    let building = building(&UNLIKE);
    let (mut tracker, at) = building.tracked(8);
    // The robot turns by 20° and the wheels do not report it.
    let turned = at.then(Pose::new(0.3, 0.0, 0.35));
    building.step(&mut tracker, turned, Some(Pose::new(0.3, 0.0, 0.0)));
    let report = tracker.report();
    assert!(is_at(&tracker, turned), "{report:?}");
    assert_eq!((report.state, report.reason), (Doubtful, OdometryJump));
    building.drive(&mut tracker, turned, 2);
    assert_eq!(tracker.report().state, Unique);
}

#[test]
fn a_laser_whose_scans_stay_the_same_while_odometry_drives_on_is_doubted_and_lost() {
    let building = building(&UNLIKE);
    let (mut tracker, at) = building.tracked(8);
    assert_eq!(tracker.report().state, Unique);
    let step = Some(Pose::new(0.1, 0.0, 0.0));
    let states: Vec<TrackState> = (0..60)
        .map(|_| {
            building.step(&mut tracker, at, step);
            tracker.report().state
        })
        .collect();
    // A metre is more than the error of odometry, and the fault lasts.
    assert!(
        states[10..].iter().all(|state| *state != Unique),
        "{states:?}"
    );
    assert!(states.contains(&Lost), "{states:?}");
    assert_eq!(tracker.report().reason, OdometryJump);
}

#[test]
fn a_robot_that_stands_keeps_its_pose() {
    let building = building(&UNLIKE);
    let (mut tracker, at) = building.tracked(8);
    let pose = tracker.report().pose;
    for i in 0..100 {
        let mut ranges = building.ranges(at);
        for (beam, range) in ranges.iter_mut().enumerate() {
            // Errors of up to 3 cm, different at each scan.
            *range += 0.03 * ((beam * 7 + i * 13) as f32).sin();
        }
        let ends = building.ends_of(&ranges);
        building.see(&mut tracker, &ends, Some(Pose::IDENTITY), |_| None);
    }
    assert_eq!(tracker.report().state, Unique);
    let moved = pose.zip(tracker.report().pose).unwrap();
    assert!(moved.0.is_within(moved.1, 0.02, 0.005), "{moved:?}");
}

#[test]
fn without_odometry_scans_show_how_the_robot_moved() {
    let building = building(&UNLIKE);
    let mut matcher = matching::ScanMatcher::default();
    let config = TrackingConfig::default();
    let start = Pose::new(1.5, 1.0, 0.0);
    let (mut at, mut found) = (start, start);
    // A turn to the left, and back to the right.
    for i in 0..12 {
        let turn = if i < 6 { 0.08 } else { -0.08 };
        let (ends, fit) = (building.ends(at), FitConfig::default());
        let step = matcher.moved(&building.seen(&ends, &fit), None, &config);
        assert_eq!(step.is_none(), i == 0, "{i}");
        found = found.then(step.unwrap_or(Pose::IDENTITY));
        // Tolerance: a cell, and the angle of a cell at five metres.
        assert!(found.is_within(at, 0.1, 0.02), "{i}: {found:?} at {at:?}");
        at = at.then(Pose::new(0.05, 0.0, turn));
    }
    // A scan from elsewhere does not match.
    let (ends, fit) = (building.ends(Pose::new(4.0, 1.9, PI)), FitConfig::default());
    assert_eq!(
        matcher.moved(&building.seen(&ends, &fit), None, &config),
        None
    );
}

#[test]
fn while_the_pose_is_sure_few_scans_are_searched() {
    let building = building(&UNLIKE);
    let (mut tracker, mut at) = building.followed(4);
    let step = Pose::new(0.0, 0.0, 0.36);
    let (mut asked, mut due) = (0, 0);
    // The robot turns on the spot: each scan is a key scan.
    for _ in 0..40 {
        at = at.then(step);
        let need = building.see(&mut tracker, &building.ends(at), Some(step), |need| {
            let earlier = at.then(step.inverse()).then(step.inverse());
            (need == Need::EarlierScan).then(|| building.found(earlier))
        });
        assert_ne!(need, Need::ThisScan);
        due += u32::from(need == Need::EarlierScan);
        asked += u32::from(tracker.asks_ahead());
    }
    assert_eq!((asked, due), (3, 3));
    assert_eq!(tracker.report().state, Unique);
    assert!(is_at(&tracker, at));
}

#[test]
fn a_scan_of_nothing_changes_nothing() {
    let building = building(&UNLIKE);
    let mut tracker = PlaceTracker::new(TrackingConfig::default());
    let need = building.see(&mut tracker, &Ends::default(), None, |_| None);
    assert_eq!(need, Need::Nothing);
    assert_eq!(
        (tracker.report().pose, tracker.report().reason),
        (None, NoScan)
    );
}

#[test]
fn tracking_allocates_nothing() {
    let building = building(&UNLIKE);
    let (mut tracker, mut at) = building.tracked(8);
    let step = Pose::new(0.0, 0.0, 0.1);
    for _ in 0..20 {
        at = at.then(step);
        let (ends, fit) = (building.ends(at), FitConfig::default());
        let seen = building.seen(&ends, &fit);
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
        let mut tracker = PlaceTracker::new(config);
        building(rows).step(&mut tracker, START, None);
        tracker
    };
    let tracker = after_a_scan(&UNLIKE);
    assert_eq!(tracker.report().state, Unique);
    assert!(is_at(&tracker, START));
    let state = after_a_scan(&ALIKE).report().state;
    assert_eq!(state, Searching);
}
