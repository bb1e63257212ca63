//! How many particles there are, and how a scan weighs them.

use super::OdometryNoise;

/// The numbers of Monte Carlo localization. Where a default is that of AMCL, the
/// particle filter of ROS, it is the one of nav2's `nav2_amcl`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticlesConfig {
    /// Minimum number of particles, 1..=10000000; the default is AMCL's.
    pub particles_min: u32,
    /// Maximum number of particles, 1..=10000000; `--particles-min` if that is more.
    /// AMCL has 2000 and starts from a given pose; a start on a whole map takes more.
    pub particles_max: u32,
    /// Maximum error of the particle distribution, as a Kullback-Leibler distance that
    /// is kept with a probability of 99 %, 0.001..=1; AMCL's default.
    pub particles_error: f64,
    /// Side of the bins in which particles are counted and clustered, metres,
    /// 0.05..=10; AMCL's.
    pub particles_bin_m: f64,
    /// Their extent in heading, degrees, 1..=360; rounded so that a whole number of them
    /// make a turn. AMCL's.
    pub particles_bin_deg: f64,
    /// Maximum number of beams that weigh a particle, 1..=65536, evenly taken from
    /// those of the scan; AMCL's default.
    pub particles_beams: u32,
    /// Standard deviation of an end point around its obstacle, or of a reading, metres,
    /// 0..=2; at least one cell, to which end points are rounded. AMCL's default.
    pub particles_sigma_m: f64,
    /// The share that a reading of something unknown to the map has of the likelihood of
    /// one that fits, 0.001..=0.5. AMCL's defaults come to 0.03 at 30 m of range.
    pub particles_random: f64,
    /// The beams weigh a particle as this many independent ones, 1..=65536: neighbours
    /// end on the same wall and err together.
    pub particles_independent: u32,
    /// Seed of the random numbers: the same seed gives the same particles.
    pub particles_seed: u64,
    /// How particles scatter as the robot moves.
    pub noise: OdometryNoise,
}

impl Default for ParticlesConfig {
    fn default() -> Self {
        ParticlesConfig {
            particles_min: 500,
            particles_max: 5000,
            particles_error: 0.05,
            particles_bin_m: 0.5,
            particles_bin_deg: 10.0,
            particles_beams: 60,
            particles_sigma_m: 0.2,
            particles_random: 0.05,
            particles_independent: 16,
            particles_seed: 1,
            noise: OdometryNoise::default(),
        }
    }
}
