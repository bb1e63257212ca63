//! What a sensor can see: obstacles and people.

use crate::obstacles::Obstacles;
use crate::people::People;

/// The world at a moment.
#[derive(Debug)]
pub(crate) struct Scene {
    pub obstacles: Obstacles,
    pub people: People,
}

impl Scene {
    /// How far a ray goes from a point on the map, metres; none beyond the
    /// reach.
    pub(crate) fn range(&self, x: f64, y: f64, angle: f64, reach_m: f64) -> Option<f64> {
        let person = self.people.range(x, y, angle).filter(|&m| m <= reach_m);
        // Nothing behind a person is seen.
        let reach_m = person.unwrap_or(reach_m);
        self.obstacles.range(x, y, angle, reach_m).or(person)
    }
}
