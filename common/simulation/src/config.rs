//! What a user can set of a drive, and parsers that refuse by name.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;
use std::str::FromStr;

use geometry::Pose;

use crate::{LaserConfig, Noise, OdometryConfig, SonarConfig};

/// How the robot drives and what it sees.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct DriveConfig {
    /// Speed along the path, metres a second, 0.01..=10.
    #[arg(long, value_name = "M_PER_S", default_value_t = 0.5, value_parser = parse_speed)]
    pub speed: f64,
    /// How fast it turns on the spot at corners, degrees a second, 1..=360.
    #[arg(long, value_name = "DEG_PER_S", default_value_t = 45.0, value_parser = parse_turn_rate)]
    pub turn_rate: f64,
    /// Scans a second, 0.01..=1000.
    #[arg(long, value_name = "HZ", default_value_t = 5.0, value_parser = parse_rate)]
    pub rate: f64,
    /// Where the sensor sits on the robot: metres ahead of the base and left of
    /// it, degrees counter-clockwise.
    #[arg(
        long,
        value_name = "X,Y,DEGREES",
        default_value = "0,0,0",
        allow_hyphen_values = true
    )]
    pub mount: Mount,
    /// Standard deviation of a reading: metres, and with a second number what is
    /// added for each metre of range.
    #[arg(long, value_name = "METRES[,SHARE]", default_value = "0.01,0.002")]
    pub noise: Noise,
    /// Share of the readings that are anything from 0 to the longest range, 0..=1.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = parse_share)]
    pub outliers: f64,
    /// People who walk about near the path, discs of 0.2 m radius, 0..=1000.
    #[arg(long, value_name = "COUNT", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub people: u32,
    /// Nothing returns from farther, metres, 0.1..=1000 [default: 30, or 5 with
    /// --sonar].
    #[arg(long, value_name = "METRES", value_parser = parse_reach)]
    pub range_max: Option<f64>,
    /// Where all random numbers begin.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// Errors of the wheels.
    #[command(flatten)]
    pub odometry: OdometryConfig,
    /// The laser.
    #[command(flatten)]
    pub laser: LaserConfig,
    /// The ring of sonars that can take its place.
    #[command(flatten)]
    pub sonar: SonarConfig,
}

impl DriveConfig {
    /// Nothing returns from farther, metres.
    #[must_use]
    pub fn range_max_m(&self) -> f64 {
        self.range_max
            .unwrap_or(if self.sonar.sonar { 5.0 } else { 30.0 })
    }
}

/// Where the sensor sits: `base_from_laser`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mount(pub Pose);

impl FromStr for Mount {
    type Err = String;

    /// Reads `X,Y,DEGREES`.
    fn from_str(text: &str) -> Result<Self, String> {
        let [x, y, degrees] =
            numbers(text).ok_or_else(|| format!("{text:?} is no mount; needed are X,Y,DEGREES"))?;
        let metres = |metres: f64| within(metres, -5.0..=5.0, "metres");
        let degrees = within(degrees, -360.0..=360.0, "degrees")?;
        Ok(Mount(Pose::new(
            metres(x)?,
            metres(y)?,
            degrees.to_radians(),
        )))
    }
}

/// Numbers with commas between them, if they are so many.
pub(crate) fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let parsed = text.split(',').map(|word| word.trim().parse().ok());
    parsed.collect::<Option<Vec<f64>>>()?.try_into().ok()
}

/// A number that is within a range; NaN never is.
pub(crate) fn within(value: f64, allowed: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let (low, high) = (allowed.start(), allowed.end());
    match allowed.contains(&value) {
        true => Ok(value),
        false => Err(format!("{value} is not within {low} to {high} {unit}")),
    }
}

/// A number within a range.
pub(crate) fn parse(text: &str, allowed: RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let value = text
        .parse()
        .map_err(|_| format!("{text:?} is not a number"))?;
    within(value, allowed, unit)
}

pub(crate) fn parse_share(text: &str) -> Result<f64, String> {
    parse(text, 0.0..=1.0, "as a share")
}

fn parse_speed(text: &str) -> Result<f64, String> {
    parse(text, 0.01..=10.0, "metres a second")
}

fn parse_turn_rate(text: &str) -> Result<f64, String> {
    parse(text, 1.0..=360.0, "degrees a second")
}

fn parse_rate(text: &str) -> Result<f64, String> {
    parse(text, 0.01..=1000.0, "scans a second")
}

fn parse_reach(text: &str) -> Result<f64, String> {
    parse(text, 0.1..=1000.0, "metres")
}

/// An angle of a field of view, degrees in and radians out.
pub(crate) fn parse_field_of_view(text: &str) -> Result<f64, String> {
    let degrees = parse(text, 1.0..=360.0, "degrees")?;
    Ok(degrees.to_radians().min(TAU))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mounts_are_read_and_nonsense_is_refused_by_what_is_wrong() {
        let mount: Mount = "0.78, 0,-90".parse().unwrap();
        assert_eq!(
            mount,
            Mount(Pose::new(0.78, 0.0, -std::f64::consts::FRAC_PI_2))
        );
        let refused = |text: &str| text.parse::<Mount>().unwrap_err();
        assert_eq!(
            refused("1,2"),
            "\"1,2\" is no mount; needed are X,Y,DEGREES"
        );
        assert_eq!(refused("9,0,0"), "9 is not within -5 to 5 metres");
        assert_eq!(refused("0,NaN,0"), "NaN is not within -5 to 5 metres");
        assert_eq!(refused("0,0,400"), "400 is not within -360 to 360 degrees");
    }
}
