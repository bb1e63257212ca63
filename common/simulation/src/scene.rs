//! Everything that a sensor can see: obstacles and people.

use crate::obstacles::Obstacles;
use crate::people::People;

#[derive(Debug)]
pub(crate) struct Scene {
    pub obstacles: Obstacles,
    pub people: People,
}

impl Scene {
    /// Range of a ray from a point on the map, in metres; `None` beyond the reach.
    pub(crate) fn range(&self, x: f64, y: f64, angle: f64, reach_m: f64) -> Option<f64> {
        let person = self.people.range(x, y, angle).filter(|&m| m <= reach_m);
        // A person hides everything behind.
        let reach_m = person.unwrap_or(reach_m);
        self.obstacles.range(x, y, angle, reach_m).or(person)
    }
}
