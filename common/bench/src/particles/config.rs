//! Settings of the particle filter.

/// Settings of Monte Carlo localization. Defaults that are AMCL's, the particle filter of ROS, are
/// those of nav2's `nav2_amcl`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticlesConfig {
    /// Minimum number of particles, 1..=10000000; AMCL's default.
    pub particles_min: u32,
    /// Maximum number of particles, 1..=10000000; at least `particles_min`. AMCL has 2000 and
    /// starts from a given pose; a start on a whole map needs more.
    pub particles_max: u32,
    /// Maximum error of the particle distribution, as a Kullback-Leibler distance that is met with
    /// a probability of 99 %, 0.001..=1; AMCL's default.
    pub particles_error: f64,
    /// Side of the bins in which particles are counted and clustered, metres, 0.05..=10; AMCL's
    /// default.
    pub particles_bin_m: f64,
    /// Size of the bins in heading, degrees, 1..=360; rounded so that a whole number of bins make a
    /// turn. AMCL's default.
    pub particles_bin_deg: f64,
    /// Maximum number of beams that weight a particle, 1..=65536, selected evenly from the scan;
    /// AMCL's default.
    pub particles_beams: u32,
    /// Standard deviation of an end point around its obstacle, metres, 0..=2; at least one cell, to
    /// which end points are rounded. AMCL's default.
    pub particles_sigma_m: f64,
    /// Likelihood of a reading that does not fit the map, as a share of that of one that does,
    /// 0.001..=0.5. AMCL's defaults correspond to 0.03 at 30 m of range.
    pub particles_random: f64,
    /// Number of independent beams that all beams count for, 1..=65536: neighbouring beams end on
    /// the same wall and have common errors.
    pub particles_independent: u32,
    /// Seed of the random numbers.
    pub particles_seed: u64,
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
        }
    }
}
