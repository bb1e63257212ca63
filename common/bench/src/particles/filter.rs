//! The particle filter: start, prediction, weighting and resampling.

use geometry::wrap_angle;
use messages::Reading;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

use super::beams::Beams;
use super::estimate::Clusters;
use super::kld::{Binning, Enough};
use super::sensor::Sensor;
use super::start::Uniform;
use super::{Estimate, Particle, ParticlesConfig, StartHeadings, resample};
use engine::EngineError;
use engine::fit::{DistanceField, GridPose};
use engine::grid::GridFrame;
use engine::particles::{Candidate, Rng, Seeds};

/// Particles are resampled if their effective number falls below this share: each resampling loses
/// some information. Half is usual (for instance Grisetti, Stachniss and Burgard, "Improved
/// Techniques for Grid Mapping", IEEE Transactions on Robotics 23, 2007, section III).
const RESAMPLE_BELOW: f64 = 0.5;

/// A particle filter on one map.
#[derive(Debug, Clone)]
pub struct ParticleFilter {
    config: ParticlesConfig,
    frame: GridFrame,
    rng: Rng,
    particles: Vec<Particle>,
    /// Buffer for resampling.
    drawn: Vec<Particle>,
    binning: Binning,
    enough: Enough,
    sensor: Sensor,
    beams: Beams,
    clusters: Clusters,
}

impl ParticleFilter {
    /// Starts with particles uniform over the free cells of a map. Their number depends on the
    /// bins: at most `particles_max`, which a large map reaches.
    ///
    /// # Errors
    /// No cell is free, no heading is given, or one is not finite.
    pub fn uniform(
        distance_field: &DistanceField,
        headings: StartHeadings<'_>,
        config: ParticlesConfig,
    ) -> Result<Self, EngineError> {
        let uniform = Uniform::new(distance_field, headings)?;
        let mut filter = Self::empty(distance_field.frame, config);
        filter.start(|rng| uniform.draw(rng));
        Ok(filter)
    }

    /// Starts with particles around candidates, for instance the places of the votes: distributed
    /// by their weights and covariances.
    ///
    /// # Errors
    /// There is no candidate of finite numbers.
    pub fn seeded(
        frame: GridFrame,
        candidates: impl IntoIterator<Item = Candidate>,
        config: ParticlesConfig,
    ) -> Result<Self, EngineError> {
        let mut filter = Self::empty(frame, config);
        let seeds = Seeds::new(frame, candidates)?;
        filter.start(|rng| seeds.draw(rng));
        Ok(filter)
    }

    fn empty(frame: GridFrame, config: ParticlesConfig) -> Self {
        let binning = Binning::new(&config, frame.resolution_m);
        ParticleFilter {
            config,
            frame,
            rng: Rng::seed_from_u64(config.particles_seed),
            particles: Vec::new(),
            drawn: Vec::new(),
            binning,
            enough: Enough::new(&config, binning),
            sensor: Sensor::new(&config, frame.resolution_m),
            beams: Beams::default(),
            clusters: Clusters::default(),
        }
    }

    /// Draws particles until their number is sufficient (Probabilistic Robotics, table 8.4).
    fn start(&mut self, mut draw: impl FnMut(&mut Rng) -> GridPose) {
        self.particles.clear();
        self.enough.clear();
        while self.particles.len() < self.enough.number() {
            let pose = draw(&mut self.rng);
            self.enough.add(pose);
            self.particles.push(Particle { pose, weight: 1.0 });
        }
        self.drawn.clear();
        self.drawn.reserve(self.particles.len());
        self.clusters.reserve(self.particles.len());
        // Sorting puts neighbours next to each other: they read nearby cells, and systematic
        // resampling draws each neighbourhood by its weight.
        let binning = self.binning;
        self.particles
            .sort_by_cached_key(|particle| binning.bin(particle.pose));
    }

    /// Moves each particle by a normal error in its own frame: along x and y with a standard
    /// deviation in metres, and of the heading in radians.
    pub fn scatter(&mut self, deviation_m: f64, turn: f64) {
        let way = deviation_m / self.frame.resolution_m;
        for particle in &mut self.particles {
            let mut error = || -> f64 { StandardNormal.sample(&mut self.rng) };
            let (ahead, left, turned) = (way * error(), way * error(), turn * error());
            let GridPose { x, y, heading } = particle.pose;
            let (sin, cos) = heading.sin_cos();
            particle.pose = GridPose {
                x: x + cos * ahead - sin * left,
                y: y + sin * ahead + cos * left,
                heading: wrap_angle(heading + turned),
            };
        }
    }

    /// Multiplies the weights by the likelihood of a scan. `distance_field` is the map of the
    /// start, and the readings are in the target frame; a scan without readings changes nothing.
    pub fn weigh(&mut self, distance_field: &DistanceField, readings: &[Reading]) {
        debug_assert_eq!(self.frame, distance_field.frame);
        self.beams
            .choose(readings, self.frame.resolution_m, &self.config);
        let mut most = f64::NEG_INFINITY;
        for particle in &mut self.particles {
            let scan = self
                .sensor
                .log_likelihood(distance_field, &self.beams, particle.pose);
            particle.weight = particle.weight.ln() + scan;
            most = most.max(particle.weight);
        }
        for particle in &mut self.particles {
            particle.weight = (particle.weight - most).exp();
        }
    }

    /// Resamples if the effective number of particles is less than half; returns true if so.
    pub fn resample(&mut self) -> bool {
        if self.effective_number() >= RESAMPLE_BELOW * self.particles.len() as f64 {
            return false;
        }
        let total: f64 = self.particles.iter().map(|particle| particle.weight).sum();
        let offset = self.rng.random();
        let number = self.number(total, offset);
        self.drawn.clear();
        for (particle, copies) in copies(&self.particles, total, number, offset) {
            let drawn = Particle {
                weight: 1.0,
                ..*particle
            };
            self.drawn.extend(std::iter::repeat_n(drawn, copies));
        }
        std::mem::swap(&mut self.particles, &mut self.drawn);
        true
    }

    /// Number of particles to draw: sufficient for the bins of that many. Unlike in KLD-sampling,
    /// drawing is systematic, so the number must be known in advance: it starts at the minimum and
    /// grows as the bins require, by at least a quarter, which keeps the passes few and the number
    /// at most that much too large.
    fn number(&mut self, total: f64, offset: f64) -> usize {
        self.enough.clear();
        let mut number = 0;
        while number < self.enough.number() {
            number = self.enough.at_least(number + number / 4);
            for (particle, copies) in copies(&self.particles, total, number, offset) {
                if copies > 0 {
                    self.enough.add(particle.pose);
                }
            }
        }
        number
    }

    /// Most likely pose; `None` without particles.
    pub fn estimate(&mut self) -> Option<Estimate> {
        let (binning, frame) = (&self.binning, self.frame);
        self.clusters.heaviest(&self.particles, binning, frame)
    }

    /// Effective number: equally weighted particles with the same information.
    #[must_use]
    pub fn effective_number(&self) -> f64 {
        resample::effective_number(self.particles.iter().map(|particle| particle.weight))
    }

    #[must_use]
    pub fn particles(&self) -> &[Particle] {
        &self.particles
    }
}

/// Each particle with the number of its copies.
fn copies(
    particles: &[Particle],
    total: f64,
    number: usize,
    offset: f64,
) -> impl Iterator<Item = (&Particle, usize)> {
    let weights = particles.iter().map(|particle| particle.weight);
    particles
        .iter()
        .zip(resample::copies(weights, total, number, offset))
}
