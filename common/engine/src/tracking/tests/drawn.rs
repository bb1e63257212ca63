//! A drawn map next to a measured one.

use super::*;

/// A drawing of [`UNLIKE`]: straight walls, and one of the objects.
fn drawing() -> [&'static str; 22] {
    std::array::from_fn(|row| match row {
        0 | 21 => UNLIKE[0],
        8 | 12 => "#...................................######.......#",
        9..12 => "#...................................#....#.......#",
        _ => UNLIKE[1],
    })
}

#[test]
fn a_drawn_map_may_be_right_where_a_measured_one_fits_better() {
    let mut robot = Robot::on(&[&drawing(), &UNLIKE]);
    robot.map = 1;
    let mut moved = None;
    for number in 0..8 {
        let mut ranges = robot.ranges();
        // This share of a scan never agrees with a map.
        ranges.iter_mut().step_by(9).for_each(|range| *range *= 0.7);
        let found = [0, 1].map(|map| Candidate {
            map,
            pose: robot.pose,
            covariance: Covariance::from_deviations(0.05, 0.05, 0.02),
            votes: 100,
            is_only: false,
        });
        let ends = robot.maps[1].ends(&ranges);
        robot.see_ends(&ends, moved, |_, _| Some(found.into()));
        let report = robot.tracker.report();
        assert_ne!(report.state, Unique, "{number}: {report:?}");
        let step = Pose::new(0.4, 0.0, 0.0);
        robot.pose = robot.pose.then(step);
        moved = Some(step);
    }
}
