//! The filter: its particles, and what a start, a step and a scan do to them.

use geometry::Pose;
use messages::Reading;
use rand::{RngExt, SeedableRng};

use super::beams::Beams;
use super::estimate::Clusters;
use super::kld::{Binning, Enough};
use super::sensor::Sensor;
use super::start::Uniform;
use super::{Estimate, OdometryNoise, Particle, ParticlesConfig, StartHeadings, motion, resample};
use engine::EngineError;
use engine::fit::{DistanceField, GridPose};
use engine::grid::GridFrame;
use engine::particles::{Candidate, Rng, Seeds};

/// Particles are drawn again where their effective number falls below this share of
/// them: each drawing loses some of what they say. Half is usual (for instance
/// Grisetti, Stachniss and Burgard, "Improved Techniques for Grid Mapping", IEEE
/// Transactions on Robotics 23, 2007, section III).
const RESAMPLE_BELOW: f64 = 0.5;

/// A particle filter on one map.
#[derive(Debug, Clone)]
pub struct ParticleFilter {
    config: ParticlesConfig,
    frame: GridFrame,
    rng: Rng,
    particles: Vec<Particle>,
    /// Where the next ones are drawn into.
    drawn: Vec<Particle>,
    binning: Binning,
    enough: Enough,
    sensor: Sensor,
    beams: Beams,
    clusters: Clusters,
}

impl ParticleFilter {
    /// Particles anywhere in the free cells of a map. As many as their bins ask for: at
    /// most `particles_max`, which a large map reaches.
    ///
    /// # Errors
    /// If no cell is free, or no heading is given or one is not finite.
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

    /// Particles around candidates, for instance the places of the votes: as often
    /// around each as it is likely, and spread by its covariance.
    ///
    /// # Errors
    /// If there is no candidate of finite numbers.
    pub fn seeded(
        frame: GridFrame,
        candidates: impl IntoIterator<Item = Candidate>,
        config: ParticlesConfig,
    ) -> Result<Self, EngineError> {
        let mut filter = Self::empty(frame, config);
        filter.seed(candidates)?;
        Ok(filter)
    }

    /// Starts again around candidates, see [`ParticleFilter::seeded`]; the random numbers
    /// go on.
    ///
    /// # Errors
    /// If there is no candidate of finite numbers; the particles stay then.
    pub fn seed(
        &mut self,
        candidates: impl IntoIterator<Item = Candidate>,
    ) -> Result<(), EngineError> {
        let seeds = Seeds::new(self.frame, candidates)?;
        self.start(|rng| seeds.draw(rng));
        Ok(())
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

    /// Draws one by one until there are enough (Probabilistic Robotics, table 8.4).
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
        // Neighbours follow each other: they look up cells that lie close together, and
        // systematic drawing takes of each neighbourhood what it weighs.
        let binning = self.binning;
        self.particles
            .sort_by_cached_key(|particle| binning.bin(particle.pose));
    }

    /// Moves the particles by a step of the odometry, given in the target frame before
    /// it: `before.inverse().then(after)`. A step that is not finite moves nothing.
    pub fn predict(&mut self, step: Pose, noise: &OdometryNoise) {
        if step.is_finite() {
            let resolution_m = self.frame.resolution_m;
            motion::advance(
                &mut self.particles,
                step,
                noise,
                resolution_m,
                &mut self.rng,
            );
        }
    }

    /// Multiplies the weights by the likelihood of a scan. `distance_field` is the map of the
    /// start, and the readings are those
    /// of the target frame; a scan without any changes nothing.
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

    /// Draws the particles again, if their weights differ so much that less than half of
    /// them count; returns whether.
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

    /// How many are to be drawn: as many as are enough for the bins of this many. It
    /// differs from KLD-sampling in that drawing is systematic, so that the number must
    /// be known before: it begins with the fewest and grows as their bins ask for, by a
    /// quarter at least, which keeps the passes few and the number at most that much too
    /// large.
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

    /// Where the robot most likely is; `None` where there is no particle.
    pub fn estimate(&mut self) -> Option<Estimate> {
        let (binning, frame) = (&self.binning, self.frame);
        self.clusters.heaviest(&self.particles, binning, frame)
    }

    /// How many particles of equal weight are worth as much.
    #[must_use]
    pub fn effective_number(&self) -> f64 {
        resample::effective_number(self.particles.iter().map(|particle| particle.weight))
    }

    /// The particles, in cells of the grid.
    #[must_use]
    pub fn particles(&self) -> &[Particle] {
        &self.particles
    }

    /// Their poses in the map, and their weights as shares of all.
    pub fn poses(&self) -> impl Iterator<Item = (Pose, f64)> {
        let total: f64 = self.particles.iter().map(|particle| particle.weight).sum();
        self.particles.iter().map(move |Particle { pose, weight }| {
            let pose = self.frame.map_from_cells(pose.x, pose.y, pose.heading);
            (pose, weight / total)
        })
    }
}

/// Each particle, and how often it is drawn.
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
