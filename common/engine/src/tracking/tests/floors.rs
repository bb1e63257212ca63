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

/// A robot at a trusted pose, whose tracker knows a transition between the first two maps: the poses
/// of its region, and its sides in metres.
fn started(maps: &[&[&str]], (at, size_m): ([Pose; 2], [f64; 2]), pose: Pose) -> Robot {
    let transition = Transition {
        maps: [0, 1],
        map_from_region: at.map(Into::into),
        size_m,
    };
    let mut robot = Robot::on(maps);
    robot.tracker = robot.tracker.with_transitions(vec![transition]);
    // The tolerance for drawn maps is left out, since the walls of these floors are straight.
    robot.fit.drawn_doubt = 0.0;
    robot.pose = pose;
    robot.start();
    robot
}

/// A robot in a lift, at these poses on the floors, of which it may be on either.
fn in_the_lift(maps: &[&[&str]], lift: [Pose; 2]) -> Robot {
    let mut robot = started(maps, (lift, [SIDE_M; 2]), START);
    let states = robot.states(steps(8, 0));
    assert!(states.contains(&(Unique, 0)), "{states:?}");
    assert_eq!(robot.said(), (Doubtful, SeveralPlaces));
    let report = robot.tracker.report();
    assert_eq!((report.rivals, report.maps), (2, 2));
    robot
}

impl Robot {
    /// Takes steps; returns the states on the way, each with its map.
    fn states(&mut self, steps: impl Iterator<Item = Pose>) -> Vec<(TrackState, u32)> {
        let take = |step| {
            self.step(step);
            (self.state(), self.tracker.report().map)
        };
        steps.map(take).collect()
    }

    /// Stands on another floor, and leaves the lift there.
    fn leave_on(&mut self, map: usize) -> Vec<(TrackState, u32)> {
        self.map = map;
        self.scan(STILL);
        self.states(steps(4, 6))
    }
}

/// Steps straight on, and turns on the spot.
fn steps(straight: usize, turns: usize) -> impl Iterator<Item = Pose> {
    let straight = std::iter::repeat_n(AHEAD, straight);
    straight.chain(std::iter::repeat_n(Pose::new(0.0, 0.0, 0.5), turns))
}

#[test]
fn a_robot_that_leaves_the_lift_where_it_came_in_stays_on_its_floor() {
    let mut robot = in_the_lift(&[&UNLIKE, &ABOVE], [LIFT; 2]);
    let states = robot.states(steps(4, 6));
    assert!(states.iter().all(|(_, map)| *map == 0), "{states:?}");
    robot.check_found();
}

#[test]
fn floors_that_look_alike_leave_a_doubt() {
    let lift = ([LIFT; 2], [SIDE_M; 2]);
    let mut robot = started(&[&UNLIKE, &UNLIKE], lift, START);
    assert_eq!(robot.state(), Unique);
    let states = robot.states(steps(12, 6));
    let after = states.iter().skip_while(|(state, _)| *state == Unique);
    let after: Vec<_> = after.collect();
    assert!(after.len() >= 6, "{states:?}");
    assert!(
        after.iter().all(|(state, _)| *state != Unique),
        "{states:?}"
    );
}

/// The floor above, drawn with another origin: turned by half a turn and shifted.
fn turned_above() -> Vec<String> {
    let turn = |row: &&str| "#####".to_owned() + &row.chars().rev().collect::<String>();
    let mut turned: Vec<_> = ABOVE.iter().rev().map(turn).collect();
    let below = "#".repeat(turned[0].len());
    turned.extend([below.clone(), below]);
    turned
}

/// Converts a pose on the floor above to that map.
fn on_turned(pose: Pose) -> Pose {
    let side = |cells: usize| RESOLUTION_M * cells as f64;
    let from_corner = Pose::new(side(5 + ABOVE[0].len()), side(2 + ABOVE.len()), PI);
    from_corner.then(pose)
}

#[test]
fn the_maps_of_a_transition_may_be_turned_and_shifted() {
    let above = turned_above();
    let above: Vec<&str> = above.iter().map(String::as_str).collect();
    let mut robot = in_the_lift(&[&UNLIKE, &above], [LIFT, on_turned(LIFT)]);
    robot.pose = on_turned(robot.pose);
    let states = robot.leave_on(1);
    assert!(!states.contains(&(Unique, 0)), "{states:?}");
    let mut believed = states.iter().map(|(state, _)| state.is_believed());
    assert!(believed.all(|is_believed| is_believed), "{states:?}");
    assert_eq!(states.last(), Some(&(Unique, 1)), "{states:?}");
    robot.check_found();
}

#[test]
fn a_ride_that_is_over_leads_to_no_third_map() {
    let mut robot = in_the_lift(&[&UNLIKE, &ABOVE, &ALIKE], [LIFT; 2]);
    let states = robot.leave_on(1);
    assert_eq!(states.last(), Some(&(Unique, 1)), "{states:?}");
    // The robot is carried to a building in which two places look alike.
    (robot.map, robot.pose) = (2, START);
    robot.scan(STILL);
    let states = robot.states(steps(5, 6));
    assert!(
        states.iter().all(|(state, _)| *state != Unique),
        "{states:?}"
    );
    assert_eq!(states.last(), Some(&(Lost, 2)), "{states:?}");
}

#[test]
fn a_floor_that_is_on_no_map_is_not_taken_for_one_that_is() {
    let mut robot = in_the_lift(&[&UNLIKE, &ABOVE], [LIFT; 2]);
    robot.map = 1;
    for step in steps(6, 8) {
        robot.pose = robot.pose.then(step);
        // Some of its walls are where the floor above has them.
        let ranges = stretched(robot.ranges(), 4);
        robot.see(&ranges, Some(step), |need| need == Need::ThisScan);
        let report = robot.tracker.report();
        assert_ne!(report.state, Unique, "{report:?}");
    }
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
    let stairs = [Pose::new(2.5, 0.8, 0.0), Pose::new(6.0, 3.0, 0.0)];
    let start = Pose::new(0.8, 0.8, 0.0);
    let mut robot = started(&[&UNLIKE, &hall], (stairs, [2.8, 1.2]), start);
    for number in 1..=5 {
        robot.step(Pose::new(0.4, 0.0, 0.0));
        assert_eq!(robot.state(), Doubtful, "{number}");
    }
}
