//! How many particles there are, and how a scan weighs them.

#[cfg(feature = "clap")]
use crate::config::{parse, parse_length};

use super::OdometryNoise;

/// Sensor model that weighs a particle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum SensorModel {
    /// By how far the end points lie from obstacles, whatever stands between.
    LikelihoodField,
    /// By how far the readings are from the way to the first obstacle.
    Beam,
}

/// The numbers of Monte Carlo localization. Where a default is that of AMCL, the
/// particle filter of ROS, it is the one of nav2's `nav2_amcl`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ParticlesConfig {
    /// Minimum number of particles, 1..=10000000; the default is AMCL's.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 500, value_parser = parse_count()))]
    pub particles_min: u32,
    /// Maximum number of particles, 1..=10000000; `--particles-min` if that is more.
    /// AMCL has 2000 and starts from a given pose; a start on a whole map takes more.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 5000, value_parser = parse_count()))]
    pub particles_max: u32,
    /// Maximum error of the particle distribution, as a Kullback-Leibler distance that
    /// is kept with a probability of 99 %, 0.001..=1; AMCL's default.
    #[cfg_attr(feature = "clap", arg(long, value_name = "DISTANCE", default_value_t = 0.05, value_parser = parse_error))]
    pub particles_error: f64,
    /// Side of the bins in which particles are counted and clustered, metres,
    /// 0.05..=10; AMCL's.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.5, value_parser = parse_bin))]
    pub particles_bin_m: f64,
    /// Their extent in heading, degrees, 1..=360; rounded so that a whole number of them
    /// make a turn. AMCL's.
    #[cfg_attr(feature = "clap", arg(long, value_name = "DEGREES", default_value_t = 10.0, value_parser = parse_bin_angle))]
    pub particles_bin_deg: f64,
    /// Sensor model that weighs a particle.
    #[cfg_attr(feature = "clap", arg(long, value_enum, default_value_t = SensorModel::LikelihoodField))]
    pub particles_model: SensorModel,
    /// Maximum number of beams that weigh a particle, 1..=65536, evenly taken from
    /// those of the scan; AMCL's default.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=65_536)))]
    pub particles_beams: u32,
    /// Standard deviation of an end point around its obstacle, or of a reading, metres,
    /// 0..=2; at least one cell, to which end points are rounded. AMCL's default.
    #[cfg_attr(feature = "clap", arg(long, value_name = "METRES", default_value_t = 0.2, value_parser = parse_length))]
    pub particles_sigma_m: f64,
    /// The share that a reading of something unknown to the map has of the likelihood of
    /// one that fits, 0.001..=0.5. AMCL's defaults come to 0.03 at 30 m of range.
    #[cfg_attr(feature = "clap", arg(long, value_name = "SHARE", default_value_t = 0.05, value_parser = parse_random))]
    pub particles_random: f64,
    /// The beams weigh a particle as this many independent ones, 1..=65536: neighbours
    /// end on the same wall and err together.
    #[cfg_attr(feature = "clap", arg(long, value_name = "COUNT", default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=65_536)))]
    pub particles_independent: u32,
    /// Seed of the random numbers: the same seed gives the same particles.
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "NUMBER", default_value_t = 1)
    )]
    pub particles_seed: u64,
    /// How particles scatter as the robot moves.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub noise: OdometryNoise,
}

#[cfg(feature = "clap")]
fn parse_count() -> clap::builder::RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(1..=10_000_000)
}

#[cfg(feature = "clap")]
fn parse_error(text: &str) -> Result<f64, String> {
    parse(text, 0.001..=1.0, "as a distance")
}

#[cfg(feature = "clap")]
fn parse_bin(text: &str) -> Result<f64, String> {
    parse(text, 0.05..=10.0, "metres")
}

#[cfg(feature = "clap")]
fn parse_bin_angle(text: &str) -> Result<f64, String> {
    parse(text, 1.0..=360.0, "degrees")
}

#[cfg(feature = "clap")]
fn parse_random(text: &str) -> Result<f64, String> {
    parse(text, 0.001..=0.5, "as a share")
}

impl Default for ParticlesConfig {
    fn default() -> Self {
        ParticlesConfig {
            particles_min: 500,
            particles_max: 5000,
            particles_error: 0.05,
            particles_bin_m: 0.5,
            particles_bin_deg: 10.0,
            particles_model: SensorModel::LikelihoodField,
            particles_beams: 60,
            particles_sigma_m: 0.2,
            particles_random: 0.05,
            particles_independent: 16,
            particles_seed: 1,
            noise: OdometryNoise::default(),
        }
    }
}

#[cfg(test)]
#[cfg(feature = "clap")]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Debug, Parser)]
    struct Arguments {
        #[command(flatten)]
        particles: ParticlesConfig,
    }

    #[test]
    fn the_defaults_are_those_of_the_command_line() {
        let parsed = Arguments::try_parse_from(["tracker"]).unwrap();
        assert_eq!(parsed.particles, ParticlesConfig::default());
        let refused = Arguments::try_parse_from(["tracker", "--particles-error", "0"]);
        let said = refused.unwrap_err().to_string();
        assert!(said.contains("0 is not within 0.001 to 1"), "{said}");
    }
}
