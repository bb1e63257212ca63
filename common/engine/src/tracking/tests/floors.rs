//! Two floors connected by a lift.

use messages::Transition;

use super::*;

/// The floor above, with its lift at the same position.
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

/// Pose of the lift, on the path of a robot that drives from [`START`].
const LIFT: Pose = Pose::new(3.5, 0.8, 0.0);

/// Side of the lift's region, in metres.
const SIDE_M: f64 = 0.8;

fn transition(at: [Pose; 2], size_m: [f64; 2]) -> Transition {
    Transition {
        maps: [0, 1],
        map_from_region: at.map(Into::into),
        size_m,
    }
}

/// Settings without the tolerance for drawn maps, for the straight walls of these floors.
fn measured() -> FitConfig {
    FitConfig {
        drawn_doubt: 0.0,
        ..FitConfig::default()
    }
}

/// Maps of a set, by number.
struct Floors(Vec<Building>);

impl Floors {
    fn of(floors: &[&[&str]]) -> Self {
        Floors(floors.iter().map(|rows| building(rows)).collect())
    }

    /// A tracker that knows the lift.
    fn tracker() -> PlaceTracker {
        let lift = transition([LIFT; 2], [SIDE_M; 2]);
        PlaceTracker::new(TrackingConfig::default()).with_transitions(vec![lift])
    }

    /// Gives a tracker the scan at a pose of a floor; all floors are searched.
    fn step(&self, tracker: &mut PlaceTracker, (floor, truth): (usize, Pose), moved: Option<Pose>) {
        self.see(tracker, &self.0[floor].ranges(truth), moved);
    }

    fn see(&self, tracker: &mut PlaceTracker, ranges: &[f32], moved: Option<Pose>) {
        let (ends, fit) = (self.0[0].ends_of(ranges), measured());
        let seen: Vec<_> = self.0.iter().map(|map| map.seen(&ends, &fit)).collect();
        let need = tracker.begin(&seen, 1, moved);
        let found = (need == Need::ThisScan).then(|| {
            let maps = (0..).zip(&self.0);
            let found = maps.flat_map(|(map, on)| {
                let found = on.found_of(ranges).into_iter();
                found.map(move |candidate| Candidate { map, ..candidate })
            });
            found.collect::<Vec<_>>()
        });
        tracker.finish(&seen, found.as_deref());
    }

    /// Starts a tracker at a trusted pose on the first floor.
    fn start_at(&self, tracker: &mut PlaceTracker, pose: Pose) {
        let (ends, fit) = (self.0[0].ends(pose), measured());
        let seen: Vec<_> = self.0.iter().map(|map| map.seen(&ends, &fit)).collect();
        let covariance = Covariance::from_deviations(0.1, 0.1, 0.1);
        tracker.start_at(&seen, (0, pose), covariance);
        self.step(tracker, (0, pose), Some(Pose::IDENTITY));
    }

    /// Drives straight on by steps of 0.3 m on a floor, then turns; returns the states on the way,
    /// each with its map.
    fn drive(
        &self,
        tracker: &mut PlaceTracker,
        (floor, from): (usize, Pose),
        (steps, turns): (usize, usize),
    ) -> (Pose, Vec<(TrackState, u32)>) {
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

fn in_the_lift(floors: &Floors) -> (PlaceTracker, Pose) {
    let mut tracker = Floors::tracker();
    let pose = into_the_lift(floors, &mut tracker);
    (tracker, pose)
}

fn into_the_lift(floors: &Floors, tracker: &mut PlaceTracker) -> Pose {
    floors.start_at(tracker, START);
    let (pose, states) = floors.drive(tracker, (0, START), (8, 0));
    assert!(states.contains(&(Unique, 0)), "{states:?}");
    let report = tracker.report();
    assert_eq!(
        (report.state, report.reason, report.rivals, report.maps),
        (Doubtful, SeveralPlaces, 2, 2)
    );
    pose
}

/// The robot goes up in the lift and drives out; checks that it is tracked and found.
fn goes_up(floors: &Floors, tracker: &mut PlaceTracker, pose: Pose) {
    // The robot stands while the lift goes up.
    floors.step(tracker, (1, pose), Some(Pose::IDENTITY));
    let (end, states) = floors.drive(tracker, (1, pose), (4, 6));
    assert!(!states.contains(&(Unique, 0)), "{states:?}");
    assert!(
        states.iter().all(|(state, _)| state.is_believed()),
        "{states:?}"
    );
    assert_eq!(states.last(), Some(&(Unique, 1)), "{states:?}");
    assert!(is_at(tracker, end), "{:?}", tracker.report());
}

#[test]
fn a_robot_that_leaves_the_lift_where_it_came_in_stays_on_its_floor() {
    let floors = Floors::of(&[&UNLIKE, &ABOVE]);
    let (mut tracker, pose) = in_the_lift(&floors);
    let (end, states) = floors.drive(&mut tracker, (0, pose), (4, 6));
    assert!(states.iter().all(|(_, map)| *map == 0), "{states:?}");
    assert_eq!(states.last(), Some(&(Unique, 0)), "{states:?}");
    assert!(is_at(&tracker, end), "{:?}", tracker.report());
}

#[test]
fn floors_that_look_alike_leave_a_doubt() {
    let floors = Floors::of(&[&UNLIKE, &UNLIKE]);
    let mut tracker = Floors::tracker();
    floors.start_at(&mut tracker, START);
    assert_eq!(tracker.report().state, Unique);
    let (_, states) = floors.drive(&mut tracker, (0, START), (12, 6));
    let after = states.iter().skip_while(|(state, _)| *state == Unique);
    let after: Vec<_> = after.collect();
    assert!(after.len() >= 6, "{states:?}");
    let is_unique = |state: &&(TrackState, u32)| state.0 == Unique;
    assert!(!after.iter().any(is_unique), "{states:?}");
}

/// The floor above, drawn with another origin: turned by half a turn and shifted.
fn turned(rows: &[&str]) -> Vec<String> {
    let turn = |row: &&str| "#####".to_owned() + &row.chars().rev().collect::<String>();
    let mut turned: Vec<_> = rows.iter().rev().map(turn).collect();
    let below = "#".repeat(turned[0].len());
    turned.extend([below.clone(), below]);
    turned
}

/// Converts a pose on the floor to that map.
fn on_turned(pose: Pose, rows: &[&str]) -> Pose {
    let side = |cells: usize| RESOLUTION_M * cells as f64;
    let from_corner = Pose::new(side(5 + rows[0].len()), side(2 + rows.len()), PI);
    from_corner.then(pose)
}

#[test]
fn the_maps_of_a_transition_may_be_turned_and_shifted() {
    let above = turned(&ABOVE);
    let above: Vec<&str> = above.iter().map(String::as_str).collect();
    let floors = Floors::of(&[&UNLIKE, &above]);
    let lift = transition([LIFT, on_turned(LIFT, &ABOVE)], [SIDE_M; 2]);
    let mut tracker = PlaceTracker::new(TrackingConfig::default()).with_transitions(vec![lift]);
    let pose = on_turned(into_the_lift(&floors, &mut tracker), &ABOVE);
    goes_up(&floors, &mut tracker, pose);
}

#[test]
fn a_ride_that_is_over_leads_to_no_third_map() {
    let floors = Floors::of(&[&UNLIKE, &ABOVE, &ALIKE]);
    let (mut tracker, pose) = in_the_lift(&floors);
    floors.step(&mut tracker, (1, pose), Some(Pose::IDENTITY));
    let (_, states) = floors.drive(&mut tracker, (1, pose), (4, 6));
    assert_eq!(states.last(), Some(&(Unique, 1)), "{states:?}");
    // The robot is carried to a building in which two places look alike.
    let elsewhere = Pose::new(1.0, 0.8, 0.0);
    floors.step(&mut tracker, (2, elsewhere), Some(Pose::IDENTITY));
    let (_, states) = floors.drive(&mut tracker, (2, elsewhere), (5, 6));
    let is_unique = |state: &(TrackState, u32)| state.0 == Unique;
    assert!(!states.iter().any(is_unique), "{states:?}");
    assert_eq!(states.last(), Some(&(Lost, 2)), "{states:?}");
}

#[test]
fn a_floor_that_is_on_no_map_is_not_taken_for_one_that_is() {
    let floors = Floors::of(&[&UNLIKE, &ABOVE]);
    let (mut tracker, mut pose) = in_the_lift(&floors);
    let straight = std::iter::repeat_n(Pose::new(0.3, 0.0, 0.0), 6);
    let turn = std::iter::repeat_n(Pose::new(0.0, 0.0, 0.5), 8);
    let mut states = Vec::new();
    for step in straight.chain(turn) {
        pose = pose.then(step);
        // Some of its walls are where the floor above has them.
        let mut ranges = floors.0[1].ranges(pose);
        for nine in ranges.chunks_mut(9) {
            nine[..4].iter_mut().for_each(|range| *range *= 1.6);
        }
        floors.see(&mut tracker, &ranges, Some(step));
        let report = tracker.report();
        states.push((report.state, report.map, report.score));
    }
    assert!(states.iter().all(|state| state.0 != Unique), "{states:?}");
}

/// A hall whose walls are farther from its middle than those of the other floors.
fn hall() -> Vec<String> {
    let row = |y: usize| match y {
        0 | 59 => "#".repeat(120),
        _ => format!("#{}{}#", ["", "#"][y % 2], ".".repeat(118 - y % 2)),
    };
    (0..60).map(row).collect()
}

#[test]
fn a_floor_that_does_not_fit_stays_possible_inside_a_transition() {
    let hall = hall();
    let hall: Vec<&str> = hall.iter().map(String::as_str).collect();
    let floors = Floors::of(&[&UNLIKE, &hall]);
    let at = [Pose::new(2.5, 0.8, 0.0), Pose::new(6.0, 3.0, 0.0)];
    let stairs = transition(at, [2.8, 1.2]);
    let mut tracker = PlaceTracker::new(TrackingConfig::default()).with_transitions(vec![stairs]);
    floors.start_at(&mut tracker, Pose::new(0.8, 0.8, 0.0));
    let step = Pose::new(0.4, 0.0, 0.0);
    let mut states = Vec::new();
    for number in 1..=5 {
        let pose = Pose::new(0.8 + 0.4 * f64::from(number), 0.8, 0.0);
        floors.step(&mut tracker, (0, pose), Some(step));
        states.push(tracker.report().state);
    }
    assert_eq!(states, [Doubtful; 5]);
}
