//! How well a scan agrees with the map at a pose, beam by beam.

use super::ends::{End, Ends};
use super::{FitConfig, GridPose, Terrain};

/// What became of a beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BeamClass {
    /// It ends at an obstacle.
    Hit,
    /// It ends in the open: something stands there that the map does not have.
    Short,
    /// It passes through an obstacle of the map.
    Through,
    /// It ends behind unknown space, where the map says nothing.
    Unknown,
}

/// The agreement of a scan with the map at a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Agreement {
    /// Mean score of the beams by weight, at most 1; below 0 where most beams
    /// pass through obstacles.
    pub score: f64,
    /// Share of the beams by weight that end at an obstacle, 0..=1.
    pub hits: f64,
}

/// An end point within this many standard deviations lies at the obstacle.
const HIT_SIGMAS: f64 = 2.0;

/// A reading that is longer than the way to an obstacle by this many standard
/// deviations passes through it.
const THROUGH_SIGMAS: f64 = 3.0;

impl Terrain {
    /// Judges a scan at a pose.
    #[must_use]
    pub fn agreement(&self, ends: &Ends, pose: GridPose, config: &FitConfig) -> Agreement {
        let (mut score, mut hits) = (0.0, 0.0);
        self.judge(ends, pose, config, |end, value, class| {
            score += end.weight * value;
            hits += if class == BeamClass::Hit {
                end.weight
            } else {
                0.0
            };
        });
        let weight = ends.weight.max(f64::MIN_POSITIVE);
        Agreement {
            score: score / weight,
            hits: hits / weight,
        }
    }

    /// What became of each beam at a pose, in the order of their bearings.
    #[must_use]
    pub fn classes(&self, ends: &Ends, pose: GridPose, config: &FitConfig) -> Vec<BeamClass> {
        let mut classes = Vec::with_capacity(ends.ends.len());
        self.judge(ends, pose, config, |_, _, class| classes.push(class));
        classes
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
            let (dx, dy) = end.direction(turn);
            let (x, y) = (pose.x + end.reading * dx, pose.y + end.reading * dy);
            let off = self
                .distance(x, y)
                .map_or(f64::INFINITY, |(distance, _)| distance / sigma);
            let near = (-0.5 * off * off).exp();
            let way = self.look(
                (pose.x, pose.y),
                (dx, dy),
                end.reading - THROUGH_SIGMAS * sigma,
            );
            let is_through = way.occupied.is_some();
            let is_hit = off <= HIT_SIGMAS;
            let (value, class) = match (way.unknown, is_through) {
                (Some(_), false) => (near.max(config.unknown_score), BeamClass::Unknown),
                (Some(_), true) => (0.5 * near.max(config.unknown_score), BeamClass::Through),
                (None, false) => (near, BeamClass::Short),
                (None, true) => (near - config.through_penalty, BeamClass::Through),
            };
            take(
                end,
                value,
                if is_hit && !is_through {
                    BeamClass::Hit
                } else {
                    class
                },
            );
        }
    }
}
