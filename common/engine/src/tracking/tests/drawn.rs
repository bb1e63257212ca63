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
    let maps = [building(&drawing()), building(&UNLIKE)];
    let mut tracker = PlaceTracker::new(TrackingConfig::default());
    let (mut pose, mut moved) = (START, None);
    for number in 0..8 {
        let mut ranges = maps[1].ranges(pose);
        // This share of a scan never agrees with a map.
        ranges.iter_mut().step_by(9).for_each(|range| *range *= 0.7);
        let (ends, fit) = (maps[1].ends_of(&ranges), FitConfig::default());
        let seen = [0, 1].map(|map: usize| maps[map].seen(&ends, &fit));
        tracker.begin(&seen, 1, moved);
        let found = [0, 1].map(|map| Candidate {
            map,
            pose,
            covariance: Covariance::from_deviations(0.05, 0.05, 0.02),
            votes: 100,
            is_only: false,
        });
        tracker.finish(&seen, Some(&found));
        let report = tracker.report();
        assert_ne!(report.state, Unique, "{number}: {report:?}");
        let step = Pose::new(0.4, 0.0, 0.0);
        (pose, moved) = (pose.then(step), Some(step));
    }
}
