//! How a lidar turns, from the times of its points.

use std::f64::consts::{PI, TAU};

use geometry::wrap_angle;

/// Order of the beams of a scan in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sweep {
    /// Time of the first beam after the stamp, in seconds.
    pub(crate) start_s: f64,
    /// Bearing of the first beam, in radians.
    pub(crate) bearing: f64,
    /// True if the next beams are clockwise from the first.
    pub(crate) is_clockwise: bool,
    /// Seconds from beam to beam for each radian between them: negative if the first beam is
    /// measured last, 0 if all are measured at once.
    pub(crate) s_per_rad: f64,
}

/// All beams at the stamp.
const AT_ONCE: Sweep = Sweep {
    start_s: 0.0,
    bearing: -PI,
    is_clockwise: false,
    s_per_rad: 0.0,
};

/// An even turn: bearing at a time, and its rate.
#[derive(Debug, Clone, Copy)]
struct Turn {
    start_s: f64,
    /// Radians.
    bearing: f64,
    /// Radians per second, counter-clockwise.
    rate: f64,
}

/// Smallest number of points that show how a lidar turns.
const MIN_POINTS: usize = 32;

/// Longest time from the stamp to a point, in seconds; beyond, its clock is another.
const MAX_TIME_S: f64 = 1.0;

/// Largest deviation of the bearings from an even turn, root mean square in radians: rings have
/// bearings that are some degrees apart, and what does not turn scatters over the circle.
const MAX_DEVIATION: f64 = 0.1;

/// Share of a turn by which points may lie on the other side of the stamp.
const MAX_SLACK: f64 = 0.05;

impl Sweep {
    /// Fits an even turn to times (seconds) and bearings (radians). Where they do not turn evenly,
    /// all count as measured at the stamp.
    pub(crate) fn of(mut points: Vec<(f64, f64)>) -> Self {
        points.retain(|(time_s, _)| time_s.abs() <= MAX_TIME_S);
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (Some(&(first_s, _)), Some(&(last_s, _))) = (points.first(), points.last()) else {
            return AT_ONCE;
        };
        let turn = rate(&points).and_then(|rate| fit(&points, first_s, rate));
        // Half a turn at least and little more than one is a revolution.
        let is_one =
            |turn: &Turn| (PI..1.2 * TAU).contains(&(turn.rate.abs() * (last_s - first_s)));
        let turn = turn.filter(is_one);
        turn.map_or(AT_ONCE, |turn| turn.sweep(first_s, last_s))
    }
}

impl Turn {
    /// The first beam is that at the stamp if the stamp is at an end of the turn, so that the stamp
    /// stays; otherwise it is that of the first point.
    fn sweep(self, first_s: f64, last_s: f64) -> Sweep {
        let Turn {
            start_s,
            bearing,
            rate,
        } = self;
        let turn_s = TAU / rate.abs();
        let slack_s = MAX_SLACK * turn_s;
        let (start, direction) = if first_s >= -slack_s && last_s <= turn_s + slack_s {
            (0.0, 1.0)
        } else if last_s <= slack_s && first_s >= -turn_s - slack_s {
            (0.0, -1.0)
        } else {
            (first_s, 1.0)
        };
        Sweep {
            start_s: start,
            bearing: bearing + rate * (start - start_s),
            is_clockwise: rate * direction < 0.0,
            s_per_rad: direction / rate.abs(),
        }
    }
}

/// Median rate of the bearing, over small parts of the scan.
fn rate(points: &[(f64, f64)]) -> Option<f64> {
    let lag = points.len() / MIN_POINTS;
    let ends = points.iter().zip(points.get(lag.max(1)..)?);
    let rates = ends.map(|(a, b)| wrap_angle(b.1 - a.1) / (b.0 - a.0));
    let mut rates: Vec<f64> = rates.filter(|rate| rate.is_finite()).collect();
    rates.sort_by(f64::total_cmp);
    (lag > 0).then(|| rates.get(rates.len() / 2).copied())?
}

/// Corrects the rate by a line through the deviations; `None` if they are too large.
fn fit(points: &[(f64, f64)], start_s: f64, rate: f64) -> Option<Turn> {
    let deviations = |bearing: f64, rate: f64| {
        let at = move |&(time_s, b): &(f64, f64)| {
            let time_s = time_s - start_s;
            (time_s, wrap_angle(b - bearing - rate * time_s))
        };
        points.iter().map(at)
    };
    let (sin, cos) = deviations(0.0, rate).fold((0.0, 0.0), |(sin, cos), (_, angle)| {
        (sin + angle.sin(), cos + angle.cos())
    });
    let bearing = sin.atan2(cos);
    let count = points.len() as f64;
    let mean_s = deviations(bearing, rate)
        .map(|(time_s, _)| time_s)
        .sum::<f64>()
        / count;
    let (across, along) = deviations(bearing, rate).fold((0.0, 0.0), |(across, along), (t, d)| {
        let t = t - mean_s;
        (across + t * d, along + t * t)
    });
    let slope = across / along;
    let turn = Turn {
        start_s,
        bearing: bearing - slope * mean_s,
        rate: rate + slope,
    };
    let squares = deviations(turn.bearing, turn.rate).map(|(_, angle)| angle * angle);
    // False for a NaN, too.
    ((squares.sum::<f64>() / count).sqrt() <= MAX_DEVIATION).then_some(turn)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of a turn in 0.1 s from this time and a bearing of 2 radians, with a quarter turn
    /// left out.
    fn turn(direction: f64, start_s: f64) -> Sweep {
        let seen = (0..400).filter(|i| !(120..220).contains(i));
        let points = seen.map(|i| {
            let share = f64::from(i) / 400.0;
            let jitter = if i % 2 == 0 { 0.03 } else { -0.03 };
            let bearing = wrap_angle(2.0 + direction * TAU * share + jitter);
            (0.1 * share + start_s, bearing)
        });
        Sweep::of(points.collect())
    }

    #[test]
    fn both_directions_are_found_whichever_end_the_stamp_is_of() {
        for direction in [1.0, -1.0] {
            // (time of the first point, expected time of the first beam, direction of time)
            for (first_s, start_s, order) in
                [(0.0, 0.0, 1.0), (-0.1, 0.0, -1.0), (-0.05, -0.05, 1.0)]
            {
                let sweep = turn(direction, first_s);
                assert_eq!(sweep.start_s, start_s);
                assert_eq!(sweep.is_clockwise, direction * order < 0.0);
                // Within the jitter, and 1 percent.
                assert!(wrap_angle(sweep.bearing - 2.0).abs() < 0.06, "{sweep:?}");
                assert!(
                    (sweep.s_per_rad * TAU / 0.1 - order).abs() < 0.01,
                    "{sweep:?}"
                );
            }
        }
    }

    #[test]
    fn what_does_not_turn_is_measured_at_once() {
        let rosette = |i| (0.001 * f64::from(i), wrap_angle(f64::from(i * i) * 0.7));
        assert_eq!(Sweep::of((0..100).map(rosette).collect()), AT_ONCE);
        assert_eq!(Sweep::of(vec![(0.0, 1.0); 100]), AT_ONCE);
        assert_eq!(Sweep::of(vec![]), AT_ONCE);
        // The time of another clock.
        assert_eq!(Sweep::of(vec![(5.0, 1.0); 100]), AT_ONCE);
    }
}
