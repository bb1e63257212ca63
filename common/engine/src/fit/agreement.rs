//! Agreement of a scan with the map at a pose, beam by beam.

use super::ends::{BeamClass, End, Ends};
use super::{DistanceField, FitConfig, GridPose};

/// Largest distance of an end point from an obstacle that counts as a hit, in standard deviations.
const HIT_SIGMAS: f64 = 2.0;

/// A beam passes through an obstacle if its reading is longer than the distance to it by more than
/// this many standard deviations.
const THROUGH_SIGMAS: f64 = 3.0;

impl DistanceField {
    /// Returns the score of a scan at a pose: the weighted mean of the scores of its beams, at most
    /// 1; below 0 if most beams pass through obstacles.
    #[must_use]
    pub fn score(&self, ends: &Ends, pose: GridPose, config: &FitConfig) -> f64 {
        let mut score = 0.0;
        self.judge(ends, pose, config, |end, value, _| {
            score += end.weight * value;
        });
        score / ends.weight.max(f64::MIN_POSITIVE)
    }

    /// Returns an upper bound of [`DistanceField::score`] from the ends alone, without following
    /// rays.
    pub(crate) fn score_at_most(&self, ends: &Ends, pose: GridPose, config: &FitConfig) -> f64 {
        let sigma = config.sigma_cells(self.frame.resolution_m);
        let turn = pose.heading.sin_cos();
        let value = |end: &End| {
            let ((dx, dy), (x, y)) = (end.direction(turn), end.start(turn));
            let (x, y) = (pose.x + x, pose.y + y);
            let (_, near) = self.near(x + end.reading * dx, y + end.reading * dy, sigma);
            end.weight * near.max(config.unknown_score)
        };
        let score: f64 = ends.ends.iter().map(value).sum();
        score / ends.weight.max(f64::MIN_POSITIVE)
    }

    /// Returns the distance of an end from an obstacle in standard deviations, and the score for
    /// it.
    fn near(&self, x: f64, y: f64, sigma: f64) -> (f64, f64) {
        let distance = self.distance(x, y);
        let off = distance.map_or(f64::INFINITY, |distance| distance / sigma);
        (off, (-0.5 * off * off).exp())
    }

    /// Returns the class of each beam at a pose, in the order of bearings.
    #[must_use]
    pub fn classes(&self, ends: &Ends, pose: GridPose, config: &FitConfig) -> Vec<BeamClass> {
        let mut classes = Vec::new();
        self.classify(ends, pose, config, &mut classes);
        classes
    }

    /// Does the same as [`DistanceField::classes`] in a given buffer.
    pub(crate) fn classify(
        &self,
        ends: &Ends,
        pose: GridPose,
        config: &FitConfig,
        classes: &mut Vec<BeamClass>,
    ) {
        classes.clear();
        self.judge(ends, pose, config, |_, _, class| classes.push(class));
    }

    fn judge(
        &self,
        ends: &Ends,
        pose: GridPose,
        config: &FitConfig,
        mut take: impl FnMut(&End, f64, BeamClass),
    ) {
        let sigma = config.sigma_cells(self.frame.resolution_m);
        let turn = pose.heading.sin_cos();
        for end in &ends.ends {
            let (direction, (x, y)) = (end.direction(turn), end.start(turn));
            let laser = (pose.x + x, pose.y + y);
            let (value, class) = self.judge_beam(end.reading, direction, laser, (sigma, config));
            take(end, value, class);
        }
    }

    /// Returns the score and the class of a beam.
    fn judge_beam(
        &self,
        reading: f64,
        (dx, dy): (f64, f64),
        (x, y): (f64, f64),
        (sigma, config): (f64, &FitConfig),
    ) -> (f64, BeamClass) {
        let (off, near) = self.near(x + reading * dx, y + reading * dy, sigma);
        let hit = self.cast_ray((x, y), (dx, dy), reading);
        let longest = reading - THROUGH_SIGMAS * sigma;
        let is_through = hit.occupied.is_some_and(|occupied| occupied < longest);
        let value = match (hit.unknown, is_through) {
            (Some(_), false) => near.max(config.unknown_score),
            (Some(_), true) => 0.5 * near.max(config.unknown_score),
            (None, false) => near,
            (None, true) => near - config.through_penalty,
        };
        let class = match hit.unknown {
            _ if is_through => BeamClass::Through,
            _ if off <= HIT_SIGMAS => BeamClass::Hit,
            Some(_) => BeamClass::Unknown,
            None => BeamClass::Short,
        };
        (value, class)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::drawn::{distance_field, field_of};
    use super::*;
    use crate::fit::ends::End;

    /// A wall ahead at 6 cells, unknown space to the left, open to the right.
    const MAP: [&str; 9] = [
        "...........",
        "...........",
        ".....??....",
        "...........",
        ".......#..#",
        "...........",
        "...........",
        "...........",
        "...........",
    ];
    const POSE: GridPose = GridPose::new(1.5, 4.5, 0.0);

    fn ends(readings: &[(f64, f64)]) -> Ends {
        let end = |&(degrees, reading): &(f64, f64)| {
            End::new(
                (0.0, 0.0),
                degrees.to_radians(),
                (0.1 * reading, reading),
                1.0,
            )
        };
        Ends::of(readings.iter().map(end).collect())
    }

    /// Settings with a σ of one cell; a cell is 0.1 m.
    fn config() -> FitConfig {
        FitConfig {
            fit_sigma_cells: 1.0,
            ..FitConfig::default()
        }
    }

    #[test]
    fn each_beam_is_classed_by_where_it_ends() {
        let scan = ends(&[
            (0.0, 6.0),
            (0.0, 2.0),
            (0.0, 9.0),
            (22.0, 6.0),
            (-30.0, 5.0),
        ]);
        let classes = distance_field(&MAP).classes(&scan, POSE, &config());
        let expected = [
            BeamClass::Hit,
            BeamClass::Short,
            // A beam through the first obstacle that ends at the second is still `Through`.
            BeamClass::Through,
            BeamClass::Unknown,
            BeamClass::Short,
        ];
        assert_eq!(classes, expected);
    }

    #[test]
    fn the_score_is_what_the_ends_are_worth() {
        let map = distance_field(&MAP);
        // Returns the score and the share of hits.
        let judged = |readings: &[(f64, f64)]| {
            let scan = ends(readings);
            let classes = map.classes(&scan, POSE, &config());
            let hits = scan.share(&classes, BeamClass::Hit);
            (map.score(&scan, POSE, &config()), hits)
        };
        let score = |readings: &[(f64, f64)]| judged(readings).0;
        let on_the_wall = judged(&[(0.0, 6.0)]);
        assert_eq!(on_the_wall, (1.0, 1.0));
        // One end is one σ before the wall, one in the open.
        assert!((score(&[(0.0, 5.0)]) - (-0.5f64).exp()).abs() < 1e-12);
        assert!(score(&[(0.0, 1.0)]) < 1e-5);
        // The end is at an obstacle, but the beam passes through another.
        assert!((score(&[(0.0, 9.0)]) - 0.85).abs() < 1e-12);
        assert_eq!(score(&[(22.0, 6.0)]), 0.3);
        let both = judged(&[(0.0, 6.0), (22.0, 6.0)]);
        assert!((both.0 - 0.65).abs() < 1e-12 && both.1 == 0.5);
    }

    proptest! {
        #[test]
        fn no_score_is_above_its_bound(
            grid in crate::testing::any_grid(),
            readings in proptest::collection::vec((-180.0..180.0f64, 0.5..50.0f64), 1..20),
            (x, y, heading) in (-2.0..42.0f64, -2.0..42.0f64, -4.0..4.0f64),
            sigma in 0.5..4.0f64,
        ) {
            let map = field_of(&grid);
            let pose = GridPose { x, y, heading };
            let config = FitConfig { fit_sigma_cells: sigma, ..FitConfig::default() };
            let scan = ends(&readings);
            let score = map.score(&scan, pose, &config);
            let bound = map.score_at_most(&scan, pose, &config);
            prop_assert!(score <= bound, "{score} {bound}");
        }
    }
}
