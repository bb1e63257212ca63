//! Path of the robot: straight from corner to corner, turning on the spot.

use std::str::FromStr;

use anyhow::bail;
use geometry::{Pose, wrap_angle};

use crate::numbers::numbers;
use crate::obstacles::Obstacles;

const MAX_CORNERS: usize = 10_000;

/// Largest coordinate of a corner, in metres.
const MAX_METRES: f64 = 1e8;

/// Corners in the map, in metres.
#[derive(Debug, Clone, PartialEq)]
pub struct Path(Vec<[f64; 2]>);

impl FromStr for Path {
    type Err = String;

    /// Parses `X,Y X,Y …`.
    fn from_str(text: &str) -> Result<Self, String> {
        let corner = |word: &str| {
            numbers::<2>(word)
                .filter(|corner| corner.iter().all(|metres| metres.abs() <= MAX_METRES))
                .ok_or_else(|| format!("{word:?} is not a corner; needed are X,Y X,Y … in metres"))
        };
        let corners: Vec<_> = text
            .split_whitespace()
            .map(corner)
            .collect::<Result<_, _>>()?;
        match corners.len() {
            2..=MAX_CORNERS => Ok(Path(corners)),
            found => Err(format!("{found} corners; allowed are 2 to {MAX_CORNERS}")),
        }
    }
}

impl Path {
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Checks that the robot's centre can follow the path.
    pub(crate) fn check(&self, obstacles: &Obstacles) -> anyhow::Result<()> {
        for (corner, &[x, y]) in (1..).zip(&self.0) {
            if !obstacles.holds(x, y) {
                let [x_m, y_m] = obstacles.extent().map(|ends| ends.map(to_mm));
                bail!(
                    "corner {corner} of the path, {x},{y}, is not on the map, which spans x {} to {} and y {} to {}",
                    x_m[0],
                    x_m[1],
                    y_m[0],
                    y_m[1]
                );
            }
        }
        for (corner, leg) in (1..).zip(self.0.windows(2)) {
            let leg = Leg::between(leg[0], leg[1]);
            if leg.length_m == 0.0 {
                let Pose { x, y, .. } = leg.start;
                let next = corner + 1;
                bail!("corners {corner} and {next} of the path are the same, {x},{y}");
            }
            let Pose { x, y, yaw } = leg.start;
            if let Some(after_m) = obstacles.range(x, y, yaw, leg.length_m) {
                let Pose { x, y, .. } = leg.at(after_m);
                let next = corner + 1;
                bail!(
                    "the path from corner {corner} to corner {next} meets an obstacle at {x:.2},{y:.2}, {after_m:.2} m after corner {corner}"
                );
            }
        }
        Ok(())
    }
}

/// Rounds to millimetres, to hide the rounding of binary fractions.
fn to_mm(metres: f64) -> f64 {
    (metres * 1000.0).round() / 1000.0
}

/// A straight part of the path.
#[derive(Debug, Clone, Copy)]
struct Leg {
    /// Pose at the corner, looking along the leg.
    start: Pose,
    length_m: f64,
}

impl Leg {
    fn between([x, y]: [f64; 2], to: [f64; 2]) -> Self {
        let (dx, dy) = (to[0] - x, to[1] - y);
        Leg {
            start: Pose::new(x, y, dy.atan2(dx)),
            length_m: dx.hypot(dy),
        }
    }

    fn at(&self, metres: f64) -> Pose {
        let (x, y) = self.start.transform(metres, 0.0);
        Pose { x, y, ..self.start }
    }
}

#[derive(Debug, Clone, Copy)]
enum Motion {
    Straight(Leg),
    /// Turn on the spot by an angle.
    Turn(Pose, f64),
}

/// Pose of the robot over time. It never stands still, and changes its speed at once.
#[derive(Debug)]
pub(crate) struct Timetable {
    /// End of each part in seconds, and the part.
    parts: Vec<(f64, Motion)>,
    /// Metres per second.
    speed: f64,
    /// Radians per second.
    turn_rate: f64,
}

impl Timetable {
    pub(crate) fn new(path: &Path, speed: f64, turn_rate: f64) -> Self {
        let legs: Vec<Leg> = path
            .0
            .windows(2)
            .map(|leg| Leg::between(leg[0], leg[1]))
            .collect();
        let mut timetable = Timetable {
            parts: Vec::with_capacity(2 * legs.len()),
            speed,
            turn_rate,
        };
        let mut before: Option<Leg> = None;
        for leg in legs {
            if let Some(before) = before {
                let angle = wrap_angle(leg.start.yaw - before.start.yaw);
                let corner = Pose {
                    yaw: before.start.yaw,
                    ..leg.start
                };
                timetable.add(angle.abs() / turn_rate, Motion::Turn(corner, angle));
            }
            timetable.add(leg.length_m / speed, Motion::Straight(leg));
            before = Some(leg);
        }
        timetable
    }

    fn add(&mut self, seconds: f64, motion: Motion) {
        self.parts.push((self.seconds() + seconds, motion));
    }

    pub(crate) fn seconds(&self) -> f64 {
        self.parts.last().map_or(0.0, |&(end, _)| end)
    }

    /// `map_from_base` at a time since the start, in seconds; clamped to the drive.
    pub(crate) fn at(&self, seconds: f64) -> Option<Pose> {
        let seconds = seconds.clamp(0.0, self.seconds());
        let i = self.parts.partition_point(|&(end, _)| end < seconds);
        let start = i.checked_sub(1).map_or(0.0, |before| self.parts[before].0);
        let since = seconds - start;
        Some(match self.parts.get(i)?.1 {
            Motion::Straight(leg) => leg.at((since * self.speed).min(leg.length_m)),
            Motion::Turn(from, angle) => {
                let turned = (since * self.turn_rate).min(angle.abs()).copysign(angle);
                Pose {
                    yaw: wrap_angle(from.yaw + turned),
                    ..from
                }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use super::*;
    use crate::testing::room;

    fn path(text: &str) -> Path {
        text.parse().unwrap()
    }

    #[track_caller]
    fn refused(corners: &str, expected: &str) {
        let error = path(corners).check(&Obstacles::of(&room())).unwrap_err();
        assert_eq!(error.to_string(), expected);
    }

    #[test]
    fn what_is_no_path_is_refused_by_what_is_wrong() {
        let error = |text: &str| text.parse::<Path>().unwrap_err();
        assert_eq!(error("1,2"), "1 corners; allowed are 2 to 10000");
        assert_eq!(
            error("1,2 3"),
            "\"3\" is not a corner; needed are X,Y X,Y … in metres"
        );
        assert!(error("1,2 NaN,3").contains("not a corner"));
        assert!(error("1,2 inf,3").contains("not a corner"));
    }

    #[test]
    fn a_path_that_cannot_be_driven_is_refused_where() {
        let obstacles = Obstacles::of(&room());
        assert!(path("1,1 9,1 9,7").check(&obstacles).is_ok());
        refused(
            "1,1 2,1 12,1",
            "corner 3 of the path, 12,1, is not on the map, which spans x 0 to 10 and y 0 to 8",
        );
        refused(
            "1,1 5,5.2 9,5.2",
            "the path from corner 2 to corner 3 meets an obstacle at 6.00,5.20, 1.00 m after corner 2",
        );
        refused(
            "6.2,5.2 9,5.2",
            "the path from corner 1 to corner 2 meets an obstacle at 6.20,5.20, 0.00 m after corner 1",
        );
        refused(
            "1,1 2,1 2,1",
            "corners 2 and 3 of the path are the same, 2,1",
        );
    }

    #[test]
    fn it_drives_straight_and_turns_on_the_spot() {
        let timetable = Timetable::new(&path("1,1 3,1 3,2"), 0.5, FRAC_PI_2 / 2.0);
        // Two metres, a quarter turn at an eighth of a turn per second, and one metre.
        assert!((timetable.seconds() - 8.0).abs() < 1e-12);
        let check = |seconds, expected| {
            let pose = timetable.at(seconds).unwrap();
            assert!(
                pose.is_within(expected, 1e-12, 1e-12),
                "{seconds}: {pose:?}"
            );
        };
        check(0.0, Pose::new(1.0, 1.0, 0.0));
        check(2.0, Pose::new(2.0, 1.0, 0.0));
        check(5.0, Pose::new(3.0, 1.0, FRAC_PI_2 / 2.0));
        check(7.0, Pose::new(3.0, 1.5, FRAC_PI_2));
        check(9.0, Pose::new(3.0, 2.0, FRAC_PI_2));
    }
}
