//! The theory of the paper (section III) on ideal point cells: the cells of a map are points of a
//! lattice, and a ray in a primitive direction d meets exactly the points b - d, b - 2d, and so on.
//! All counts are integers, so nothing is rounded.
//!
//! Observation B holds as the paper states it for boundary cells next to each other. Of two that
//! are behind one another on the ray, visibility lets only the nearer one vote; the last test shows
//! that without visibility neither the observation nor Lemma 1 would hold.

use std::collections::HashSet;

use proptest::collection::{hash_set, vec};
use proptest::prelude::*;

type Point = (i64, i64);

/// A map of point cells, and the bearings and readings of a scan in the map.
#[derive(Debug, Clone)]
struct PointMap {
    sides: Point,
    obstacles: HashSet<Point>,
    /// Directions of the beams: distinct primitive vectors.
    directions: Vec<Point>,
    /// Length of each reading, in steps of its direction.
    readings: Vec<i64>,
}

impl PointMap {
    fn is_free(&self, (x, y): Point) -> bool {
        (0..self.sides.0).contains(&x)
            && (0..self.sides.1).contains(&y)
            && !self.obstacles.contains(&(x, y))
    }

    fn free(&self) -> Vec<Point> {
        let (width, height) = self.sides;
        let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        all.filter(|&at| self.is_free(at)).collect()
    }

    /// Returns the free points that see the obstacle `from` along a beam: the visible part of its
    /// reverse projection, for any reading.
    fn seen_back(&self, from: Point, beam: usize) -> HashSet<Point> {
        let (dx, dy) = self.directions[beam];
        let ray = (1..).map(|t| (from.0 - t * dx, from.1 - t * dy));
        ray.take_while(|&at| self.is_free(at)).collect()
    }

    /// Returns the point at which a reading projected back from an obstacle ends; `None` if
    /// something is in between.
    fn voted_for(&self, from: Point, beam: usize) -> Option<Point> {
        let (dx, dy) = self.directions[beam];
        let reading = self.readings[beam];
        let ray = (1..=reading).map(|t| (from.0 - t * dx, from.1 - t * dy));
        let mut last = None;
        for at in ray {
            if !self.is_free(at) {
                return None;
            }
            last = Some(at);
        }
        last
    }
}

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Maps of 3 to 12 points a side, from nearly empty to more obstacles than free points, with one to
/// eight beams.
fn any_map() -> impl Strategy<Value = PointMap> {
    let direction =
        (-3i64..=3, -3i64..=3).prop_filter("primitive", |&(x, y)| gcd(x.abs(), y.abs()) == 1);
    let beams = hash_set(direction, 1..=8);
    (3i64..=12, 3i64..=12, 0.05..0.8f64, beams).prop_flat_map(|(width, height, share, beams)| {
        let count = (width * height) as usize;
        let cells = vec(proptest::bool::weighted(share), count);
        let readings = vec(1i64..=6, beams.len());
        (cells, readings).prop_map(move |(cells, readings)| PointMap {
            sides: (width, height),
            obstacles: (0..height)
                .flat_map(|y| (0..width).map(move |x| (x, y)))
                .zip(cells)
                .filter_map(|(at, is_obstacle)| is_obstacle.then_some(at))
                .collect(),
            directions: beams.iter().copied().collect(),
            readings,
        })
    })
}

proptest! {
    #[test]
    fn observation_a_beams_of_one_cell_meet_nowhere_else(map in any_map()) {
        for &cell in &map.obstacles {
            let mut met = HashSet::new();
            for beam in 0..map.directions.len() {
                for at in map.seen_back(cell, beam) {
                    prop_assert!(met.insert(at), "{at:?} twice from {cell:?}");
                }
            }
        }
    }

    #[test]
    fn observation_b_one_beam_from_two_cells_meets_nowhere(map in any_map()) {
        for beam in 0..map.directions.len() {
            let mut met = HashSet::new();
            for &cell in &map.obstacles {
                for at in map.seen_back(cell, beam) {
                    prop_assert!(met.insert(at), "{at:?} twice along beam {beam}");
                }
            }
        }
    }

    #[test]
    fn lemma_1_no_free_cell_has_more_than_m_intersections(map in any_map()) {
        let m = map.directions.len();
        for at in map.free() {
            let beams = 0..m;
            let votes = beams.flat_map(|beam| {
                let map = &map;
                map.obstacles.iter().filter(move |&&cell| map.voted_for(cell, beam) == Some(at))
            });
            prop_assert!(votes.count() <= m);
        }
    }

    /// The number of votes never exceeds mn for any p; Markov localization takes a subtraction and
    /// an addition for each beam of each free cell, 2mn.
    #[test]
    fn theorem_1_never_more_computations_than_markov_has(map in any_map()) {
        let (m, n) = (map.directions.len(), map.free().len());
        let votes = (0..m).flat_map(|beam| {
            let map = &map;
            map.obstacles.iter().filter_map(move |&cell| map.voted_for(cell, beam))
        });
        prop_assert!(votes.count() <= m * n);
        // The same holds for tapers of any width: the number of all points seen back is at most mn,
        // too.
        let seen = (0..m).map(|beam| {
            map.obstacles.iter().map(|&cell| map.seen_back(cell, beam).len()).sum::<usize>()
        });
        prop_assert!(seen.sum::<usize>() <= m * n);
    }
}

#[test]
fn without_visibility_cells_behind_one_another_would_vote_twice() {
    // Two obstacles in a row, both to the right of the free point, and one beam that looks there;
    // readings of 1 and of 2 each make one of them vote for the point.
    let map = |reading| PointMap {
        sides: (3, 1),
        obstacles: HashSet::from([(1, 0), (2, 0)]),
        directions: vec![(1, 0)],
        readings: vec![reading],
    };
    assert_eq!(map(1).voted_for((1, 0), 0), Some((0, 0)));
    assert_eq!(
        map(2).voted_for((2, 0), 0),
        None,
        "the nearer one stands between"
    );
    let behind = |from: Point| {
        (1..=from.0)
            .map(|t| (from.0 - t, 0))
            .collect::<HashSet<_>>()
    };
    assert!(behind((1, 0)).contains(&(0, 0)) && behind((2, 0)).contains(&(0, 0)));
}
