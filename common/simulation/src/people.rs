//! People who walk: discs that move straight from goal to goal.

use anyhow::Context;
use rand::RngExt;
use rand::rngs::Xoshiro256PlusPlus;

use crate::Path;
use crate::obstacles::Obstacles;

/// Radius of a person at the height of a knee or hip, metres.
pub(crate) const RADIUS_M: f64 = 0.2;

/// Walking speed, metres per second.
const SPEED: f64 = 1.0;

/// Largest distance of people from the path, and of a goal along each axis, metres.
const WITHIN_M: f64 = 4.0;

/// Number of random goals tried before a person stands still for a step.
const TRIES: usize = 30;

/// Number of random places tried for each person.
const PLACES: usize = 1_000;

#[derive(Debug, Clone, Copy)]
struct Person {
    at: [f64; 2],
    goal: [f64; 2],
}

/// All people. They walk around obstacles, but through each other and the robot: a person who
/// stands at the sensor is not seen.
#[derive(Debug)]
pub(crate) struct People {
    people: Vec<Person>,
    corners: Vec<[f64; 2]>,
    rng: Xoshiro256PlusPlus,
}

impl People {
    /// Places people near the path.
    pub(crate) fn new(
        count: u32,
        path: &Path,
        obstacles: &Obstacles,
        rng: Xoshiro256PlusPlus,
    ) -> anyhow::Result<Self> {
        let mut people = People {
            people: Vec::new(),
            corners: path.corners().to_vec(),
            rng,
        };
        for _ in 0..count {
            let place = (0..PLACES).find_map(|_| {
                let from = people.point_on_path();
                let place = people.point_near(from);
                obstacles.is_free(from, place).then_some(place)
            });
            let at = place.with_context(|| {
                format!("{count} people find no free place within {WITHIN_M} m of the path")
            })?;
            people.people.push(Person { at, goal: at });
        }
        Ok(people)
    }

    /// Moves all people by the distance that they walk in this time.
    pub(crate) fn walk(&mut self, seconds: f64, obstacles: &Obstacles) {
        for i in 0..self.people.len() {
            let mut person = self.people[i];
            let mut way_m = SPEED * seconds;
            // A goal that is reached early leaves distance for the next one; a person who finds no
            // goal stays.
            for _ in 0..TRIES {
                person.at = towards(person, &mut way_m);
                if way_m <= 0.0 {
                    break;
                }
                let goal = self.point_near(person.at);
                let is_near_path = self.distance_to_path(goal) <= WITHIN_M;
                if is_near_path && obstacles.is_free(person.at, goal) {
                    person.goal = goal;
                }
            }
            self.people[i] = person;
        }
    }

    /// Range of a ray to the nearest person, in metres.
    pub(crate) fn range(&self, x: f64, y: f64, angle: f64) -> Option<f64> {
        let (sin, cos) = angle.sin_cos();
        let ranges = self.people.iter().filter_map(|person| {
            let [dx, dy] = [person.at[0] - x, person.at[1] - y];
            let (along, across) = (dx * cos + dy * sin, dy * cos - dx * sin);
            let half_chord = (RADIUS_M * RADIUS_M - across * across).sqrt();
            // NaN if the ray misses; negative from inside the disc or beyond it.
            Some(along - half_chord).filter(|&range| range > 0.0)
        });
        ranges.min_by(f64::total_cmp)
    }

    fn point_on_path(&mut self) -> [f64; 2] {
        let leg = self.rng.random_range(0..self.corners.len() - 1);
        let share: f64 = self.rng.random();
        let (from, to) = (self.corners[leg], self.corners[leg + 1]);
        [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
    }

    fn point_near(&mut self, [x, y]: [f64; 2]) -> [f64; 2] {
        let mut offset = || self.rng.random_range(-WITHIN_M..WITHIN_M);
        [x + offset(), y + offset()]
    }

    fn distance_to_path(&self, point: [f64; 2]) -> f64 {
        let legs = self.corners.windows(2);
        legs.map(|leg| distance_to_segment(point, leg[0], leg[1]))
            .fold(f64::INFINITY, f64::min)
    }
}

/// Position after walking towards the goal, at most `way_m`, which is reduced by the distance
/// walked.
fn towards(person: Person, way_m: &mut f64) -> [f64; 2] {
    let Person { at, goal } = person;
    let distance = (goal[0] - at[0]).hypot(goal[1] - at[1]);
    if distance <= *way_m {
        *way_m -= distance;
        return goal;
    }
    let share = *way_m / distance;
    *way_m = 0.0;
    [0, 1].map(|axis| at[axis] + share * (goal[axis] - at[axis]))
}

fn distance_to_segment(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let [px, py] = [point[0] - from[0], point[1] - from[1]];
    let share = ((px * dx + py * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
    (px - share * dx).hypot(py - share * dy)
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;

    use super::*;
    use crate::testing::room;

    fn people(count: u32) -> (People, Obstacles) {
        let obstacles = Obstacles::of(&room());
        let path = "1,1 9,1".parse().unwrap();
        let rng = Xoshiro256PlusPlus::seed_from_u64(5);
        (
            People::new(count, &path, &obstacles, rng).unwrap(),
            obstacles,
        )
    }

    #[test]
    fn they_walk_at_their_speed_in_the_open_and_near_the_path() {
        let (mut people, obstacles) = people(20);
        let mut walked = 0.0;
        for _ in 0..200 {
            let before = people.people.clone();
            people.walk(0.5, &obstacles);
            for (before, after) in before.iter().zip(&people.people) {
                let step = (after.at[0] - before.at[0]).hypot(after.at[1] - before.at[1]);
                assert!(step <= 0.5 * SPEED + 1e-9, "{step}");
                walked += step;
                let [x, y] = after.at;
                assert_ne!(obstacles.range(x, y, 0.0, 20.0), Some(0.0), "in a wall");
                assert!(people.distance_to_path(after.at) <= WITHIN_M + 1e-9);
            }
        }
        // Around corners the straight step is shorter than the path walked, and most goals are at
        // least 2 m away: three quarters remain.
        assert!(walked > 0.75 * 20.0 * 200.0 * 0.5 * SPEED, "{walked}");
    }

    #[test]
    fn a_ray_ends_at_the_disc() {
        let (mut people, _) = people(1);
        people.people[0].at = [3.0, 1.0];
        assert!((people.range(1.0, 1.0, 0.0).unwrap() - 1.8).abs() < 1e-12);
        // At 0.12 m across, the disc of 0.2 m begins 0.16 m before its centre.
        assert!((people.range(1.0, 0.88, 0.0).unwrap() - 1.84).abs() < 1e-12);
        assert_eq!(people.range(1.0, 1.21, 0.0), None);
        assert_eq!(people.range(5.0, 1.0, 0.0), None, "behind");
        assert_eq!(people.range(3.1, 1.0, 0.0), None, "within");
    }
}
