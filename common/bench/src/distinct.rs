//! Distinct poses among the votes of a search, without the engine's second stage.

use std::f64::consts::TAU;

use engine::grid::GridFrame;
use engine::vote_search::Outcome;
use geometry::Pose;

/// Difference in metres and radians up to which two votes are of one place.
const SAME_PLACE: (f64, f64) = (0.5, 10.0 * TAU / 360.0);

/// Returns up to `most` poses in the map, those with the most votes first. A vote near a pose that
/// was taken before counts as the same place. `frame` is that of the votes' grid.
pub fn distinct(outcome: &Outcome, frame: GridFrame, most: usize) -> Vec<Pose> {
    let mut poses: Vec<Pose> = Vec::new();
    for vote in &outcome.found.votes {
        let (x, y) = (f64::from(vote.x) + 0.5, f64::from(vote.y) + 0.5);
        let heading = f64::from(vote.heading) * TAU / f64::from(outcome.headings);
        let pose = frame.map_from_cells(x, y, heading);
        let is_near = |other: &Pose| other.is_within(pose, SAME_PLACE.0, SAME_PLACE.1);
        if poses.len() < most && !poses.iter().any(is_near) {
            poses.push(pose);
        }
    }
    poses
}

#[cfg(test)]
mod tests {
    use messages::Vote;

    use super::*;

    #[test]
    fn votes_close_by_are_one_pose() {
        let vote = |x, heading| Vote {
            x,
            y: 2,
            heading,
            intensity: 9,
        };
        let mut outcome = Outcome {
            headings: 360,
            ..Outcome::default()
        };
        outcome.found.votes = vec![vote(3, 0), vote(4, 355), vote(3, 90), vote(30, 0)];
        let frame = GridFrame::new(0.1, Pose::IDENTITY);
        let poses = |most| distinct(&outcome, frame, most);
        let [best, turned, far] = poses(9)[..] else {
            panic!("three places: {:?}", poses(9));
        };
        assert!(best.is_within(Pose::new(0.35, 0.25, 0.0), 1e-12, 1e-12));
        assert!(turned.is_within(Pose::new(0.35, 0.25, TAU / 4.0), 1e-12, 1e-12));
        assert!(far.is_within(Pose::new(3.05, 0.25, 0.0), 1e-12, 1e-12));
        assert_eq!(poses(1), [best]);
    }
}
