//! Two floors, between which a lift goes.

use messages::Transition;

use super::*;

/// The floor above: its lift is at the same place.
const ABOVE: [&str; 22] = [
    "##################################################",
    "#................................................#",
    "##.......#.......................................#",
    "#........#.......................................#",
    "##.......#...............##.....................##",
    "#........................#.......................#",
    "##..............................................##",
    "#................................................#",
    "##..............................................##",
    "#..................................###...........#",
    "##..................................##..........##",
    "#................................................#",
    "##....###.......................................##",
    "#.......#........................................#",
    "##..............................................##",
    "#.......................####.....................#",
    "##.........................#....................##",
    "#................................................#",
    "##......................................###.....##",
    "#........................................#.......#",
    "##..............................................##",
    "##################################################",
];

/// Where the lift is, on the way of a robot that drives from [`START`].
const LIFT: Pose = Pose::new(3.5, 0.8, 0.0);

struct Floors([Building; 2]);

impl Floors {
    fn tracker() -> Tracker {
        Tracker::new(TrackingConfig::default()).with_transitions(vec![Transition {
            maps: [0, 1],
            map_from_region: [LIFT.into(); 2],
            size_m: [0.8, 0.8],
        }])
    }

    /// Gives a tracker the scan at a pose of a floor; all floors are searched.
    fn step(&self, tracker: &mut Tracker, (floor, truth): (usize, Pose), moved: Option<Pose>) {
        let (ends, fit) = (self.0[floor].ends(truth), FitConfig::default());
        let seen = [0, 1].map(|map: usize| self.0[map].seen(&ends, &fit));
        let ranges = self.0[floor].ranges(truth);
        let need = tracker.begin(&seen, 1, moved);
        let found = (need == Need::ThisScan).then(|| {
            let on = |map: u32| {
                let found = self.0[map as usize].found_of(&ranges).into_iter();
                found.map(move |candidate| Candidate { map, ..candidate })
            };
            on(0).chain(on(1)).collect::<Vec<_>>()
        });
        tracker.finish(&seen, found.as_deref());
    }

    /// Drives straight on by steps of 0.3 m, on a floor, until x, and turns there if it is to;
    /// the states on the way, each with its map.
    fn drive(
        &self,
        tracker: &mut Tracker,
        (floor, from): (usize, Pose),
        (to_x, turns): (f64, usize),
    ) -> (Pose, Vec<(TrackState, u32)>) {
        let steps = ((to_x - from.x) / 0.3).ceil() as usize;
        let straight = std::iter::repeat_n(Pose::new(0.3, 0.0, 0.0), steps);
        let turn = std::iter::repeat_n(Pose::new(0.0, 0.0, 0.5), turns);
        let (mut pose, mut states) = (from, Vec::new());
        for step in straight.chain(turn) {
            pose = pose.then(step);
            self.step(tracker, (floor, pose), Some(step));
            states.push((tracker.report().state, tracker.report().map));
        }
        (pose, states)
    }
}

fn in_the_lift(floors: &Floors) -> (Tracker, Pose) {
    let mut tracker = Floors::tracker();
    floors.step(&mut tracker, (0, START), None);
    let (pose, states) = floors.drive(&mut tracker, (0, START), (LIFT.x - 0.3, 0));
    assert!(states.contains(&(TrackState::Unique, 0)), "{states:?}");
    let report = tracker.report();
    assert_eq!(
        (report.state, report.reason, report.rivals, report.maps),
        (TrackState::Doubtful, TrackReason::SeveralPlaces, 2, 2)
    );
    (tracker, pose)
}

#[test]
fn a_robot_that_takes_the_lift_is_found_on_the_other_floor() {
    let floors = Floors([building(&UNLIKE), building(&ABOVE)]);
    let (mut tracker, pose) = in_the_lift(&floors);
    // It stands while it goes up.
    floors.step(&mut tracker, (1, pose), Some(Pose::IDENTITY));
    let (end, states) = floors.drive(&mut tracker, (1, pose), (4.4, 6));
    assert!(!states.contains(&(TrackState::Unique, 0)), "{states:?}");
    assert!(
        states.iter().all(|(state, _)| state.is_believed()),
        "{states:?}"
    );
    assert_eq!(states.last(), Some(&(TrackState::Unique, 1)), "{states:?}");
    assert!(is_at(&tracker, end), "{:?}", tracker.report());
}

#[test]
fn a_robot_that_leaves_the_lift_where_it_came_in_stays_on_its_floor() {
    let floors = Floors([building(&UNLIKE), building(&ABOVE)]);
    let (mut tracker, pose) = in_the_lift(&floors);
    let (end, states) = floors.drive(&mut tracker, (0, pose), (4.4, 6));
    assert!(states.iter().all(|(_, map)| *map == 0), "{states:?}");
    assert_eq!(states.last(), Some(&(TrackState::Unique, 0)), "{states:?}");
    assert!(is_at(&tracker, end), "{:?}", tracker.report());
}

#[test]
fn floors_that_look_alike_leave_a_doubt() {
    let floors = Floors([building(&UNLIKE), building(&UNLIKE)]);
    let mut tracker = Floors::tracker();
    let fit = FitConfig::default();
    let ends = floors.0[0].ends(START);
    let seen = [0, 1].map(|map: usize| floors.0[map].seen(&ends, &fit));
    tracker.start_at(
        &seen,
        (0, START),
        Covariance::from_deviations(0.1, 0.1, 0.1),
    );
    floors.step(&mut tracker, (0, START), Some(Pose::IDENTITY));
    assert_eq!(tracker.report().state, TrackState::Unique);
    let (_, states) = floors.drive(&mut tracker, (0, START), (4.4, 6));
    let after = states
        .iter()
        .skip_while(|(state, _)| *state == TrackState::Unique);
    let after: Vec<_> = after.collect();
    assert!(after.len() >= 6, "{states:?}");
    let is_unique = |state: &&(TrackState, u32)| state.0 == TrackState::Unique;
    assert!(!after.iter().any(is_unique), "{states:?}");
}
