//! Settings of the limits.

use super::Region;
use crate::config;

/// Poses that are searched; by default all at which the robot may stand.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct LimitsConfig {
    /// Unknown cells that do not block can hold the laser only within this distance of
    /// a free cell, between centres, metres, 0..=1000: a map ends where the robot that
    /// made it could not see, and poses far beyond that cannot be found.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 1.0, value_parser = config::within(0.0..=1000.0, "metres")))]
    pub unknown_reach: f64,
    /// Only cells at least this far from the centre of every occupied cell can hold the
    /// laser, metres, 0..=5: the distance from the laser to the robot's nearest side.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.0, value_parser = config::within(0.0..=5.0, "metres")))]
    pub robot_radius: f64,
    /// Only poses in this polygon are searched: two opposite corners of an upright
    /// rectangle, or all corners of any other polygon, in metres in the map: "X,Y X,Y
    /// …".
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "CORNERS", allow_hyphen_values = true)
    )]
    pub region: Option<Region>,
    /// Only headings from FROM counter-clockwise to TO are searched, degrees in the
    /// map, -360..=360: "FROM,TO".
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "FROM,TO", allow_hyphen_values = true)
    )]
    pub headings_within: Option<HeadingInterval>,
}

impl Default for LimitsConfig {
    fn default() -> Self {
        LimitsConfig {
            unknown_reach: 1.0,
            robot_radius: 0.0,
            region: None,
            headings_within: None,
        }
    }
}

/// An interval of headings, counter-clockwise from one to another inclusive, in radians in the map
/// frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadingInterval {
    /// First heading.
    pub from: f64,
    /// Last heading.
    pub to: f64,
}

impl HeadingInterval {
    /// True if a heading is in the interval, up to rounding.
    #[must_use]
    pub fn holds(&self, heading: f64) -> bool {
        // Tolerance for rounding in angles of several turns.
        const ROUNDING: f64 = 1e-9;
        let ahead = |angle: f64| angle.rem_euclid(std::f64::consts::TAU);
        // An interval of whole turns holds all headings; one from a heading to itself holds that
        // alone.
        let width = match self.to - self.from {
            width if width.abs() >= std::f64::consts::TAU => std::f64::consts::TAU,
            width => ahead(width),
        };
        ahead(heading - self.from + ROUNDING) <= width + 2.0 * ROUNDING
    }
}

impl std::str::FromStr for HeadingInterval {
    type Err = String;

    /// Reads `FROM,TO`, degrees.
    fn from_str(text: &str) -> Result<Self, String> {
        let (from, to) = text
            .split_once(',')
            .ok_or_else(|| format!("{text:?} is not an interval; needed is FROM,TO in degrees"))?;
        let degrees = |text: &str| config::parse(text.trim(), -360.0..=360.0, "degrees");
        Ok(HeadingInterval {
            from: degrees(from)?.to_radians(),
            to: degrees(to)?.to_radians(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(interval: &str, inside: &[f64], outside: &[f64]) {
        let interval: HeadingInterval = interval.parse().unwrap();
        let holds = |degrees: &f64| interval.holds(degrees.to_radians());
        assert!(inside.iter().all(holds), "{interval:?}");
        assert!(!outside.iter().any(holds), "{interval:?}");
    }

    #[test]
    fn intervals_run_counter_clockwise_and_over_the_turn() {
        check("10,20", &[10.0, 20.0, 15.0, 375.0], &[9.9, 20.1, 195.0]);
        check("-20,30", &[-20.0, 0.0, 340.0, 30.0], &[31.0, 339.0, 180.0]);
        check("350,10", &[350.0, 0.0, 10.0], &[11.0, 349.0, 180.0]);
        check("5,5", &[5.0], &[4.9, 5.1]);
        check("0,360", &[0.0, 123.0, 359.9], &[]);
    }

    #[test]
    fn what_is_no_interval_is_refused() {
        for text in ["10", "10,x", "0,400"] {
            assert!(text.parse::<HeadingInterval>().is_err(), "{text}");
        }
    }
}
