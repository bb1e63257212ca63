//! The tracker by particles in place of a few places: Monte Carlo localization that a
//! search starts, "those places where particles need to be initialized" (the paper,
//! conclusions), and starts again where it is lost. It is here to be compared with.

use geometry::{Covariance, Pose};
use messages::{TrackReason, TrackState};
use nalgebra::Matrix3;

use super::driven_path::DrivenPath;
use super::matching::ScanMatcher;
use super::report::Report;
use super::seen::Seen;
use super::{Candidate, MIN_BEAMS, Need, TrackingConfig};
use crate::fit::GridPose;
use crate::particles::{self, ParticleFilter, ParticlesConfig};

/// One cluster that holds this share of the weight is the only one, and the most that it
/// may be spread by, metres.
const ONE_CLUSTER: f64 = 0.95;
const MAX_SPREAD_M: f64 = 0.5;

/// Key scans in a row that agree on it, and the least score of the last.
const MIN_KEYS: u32 = 3;
const LEAST_SCORE: f64 = 0.6;

/// Key scans in a row with a lower score before it starts again.
const LOST_SCANS: u32 = 3;
const LOST_SCORE: f64 = 0.5;

/// Follows the robot by particles.
#[derive(Debug, Clone)]
pub struct ParticleTracker {
    config: TrackingConfig,
    particles: ParticlesConfig,
    filter: Option<ParticleFilter>,
    matcher: ScanMatcher,
    /// Since the last key scan.
    since_key: DrivenPath,
    is_key: bool,
    is_blank: bool,
    /// Key scans in a row at which there was one cluster, and at which the scan hardly
    /// fitted there.
    agreeing: u32,
    bad: u32,
    /// At the last key scan.
    found: Option<(Pose, Covariance)>,
    stamp_ns: i64,
    report: Report,
    expected: Option<((u32, Pose), Covariance)>,
    /// Number of the map on which the particles are.
    map: u32,
}

impl ParticleTracker {
    /// Nothing is known yet.
    #[must_use]
    pub fn new(config: TrackingConfig, particles: ParticlesConfig) -> Self {
        ParticleTracker {
            config,
            particles,
            filter: None,
            matcher: ScanMatcher::default(),
            since_key: DrivenPath::default(),
            is_key: false,
            is_blank: false,
            agreeing: 0,
            bad: 0,
            found: None,
            stamp_ns: 0,
            report: Report::of_nothing(),
            expected: None,
            map: 0,
        }
    }

    /// See [`Tracker::expect`](super::Tracker::expect): particles start there.
    pub fn expect(&mut self, at: (u32, Pose), covariance: Covariance) {
        *self = ParticleTracker {
            expected: Some((at, covariance)),
            ..ParticleTracker::new(self.config, self.particles)
        };
    }

    /// See [`Tracker::begin`](super::Tracker::begin).
    pub fn begin(&mut self, seen: &[Seen<'_>], stamp_ns: i64, moved: Option<Pose>) -> Need {
        self.stamp_ns = stamp_ns;
        self.is_blank = seen[0].ends.beams() < MIN_BEAMS;
        if self.is_blank {
            self.since_key.add(moved);
            return Need::Nothing;
        }
        let moved = self.matcher.moved(&seen[0], moved, &self.config);
        self.since_key.add(moved);
        self.report.since_m += moved.map_or(0.0, |step| step.x.hypot(step.y));
        if let Some(((map, pose), covariance)) = self.expected.take() {
            self.map = map;
            self.start(&seen[map as usize], [seed(pose, covariance)]);
        }
        self.is_key = self.filter.is_none() || self.since_key.is_far(&self.config);
        match self.filter {
            Some(_) => Need::Nothing,
            None => Need::ThisScan,
        }
    }

    /// See [`Tracker::finish`](super::Tracker::finish).
    pub fn finish(&mut self, seen: &[Seen<'_>], found: Option<&[Candidate]>) {
        if self.is_blank {
            if self.report.state == TrackState::Unique && self.since_key.is_far(&self.config) {
                self.enter(TrackState::Doubtful, TrackReason::PoorFit);
            }
            self.carry();
            return;
        }
        if self.filter.is_none()
            && let Some(found) = found
        {
            // On one map, that of the best.
            self.map = found.first().map_or(0, |best| best.map);
            let on_map = found.iter().filter(|c| c.map == self.map);
            let seeds: Vec<_> = on_map.map(|c| seed(c.pose, c.covariance)).collect();
            self.start(&seen[self.map as usize], seeds);
        }
        let seen = &seen[self.map as usize];
        if self.is_key {
            self.weigh(seen);
        }
        self.conclude(seen);
    }

    fn start(&mut self, seen: &Seen<'_>, seeds: impl IntoIterator<Item = particles::Candidate>) {
        self.since_key = DrivenPath::default();
        self.agreeing = 0;
        self.bad = 0;
        // Without a place to start at there are none: the next scan is searched.
        self.filter = ParticleFilter::seeded(seen.distance_field.frame, seeds, self.particles).ok();
    }

    fn weigh(&mut self, seen: &Seen<'_>) {
        let Some(filter) = &mut self.filter else {
            return;
        };
        let path = std::mem::take(&mut self.since_key);
        filter.predict(path.step, &self.particles.noise);
        filter.weigh(seen.distance_field, seen.ends);
        let estimate = filter.estimate();
        filter.resample();
        let Some(estimate) = estimate else {
            return;
        };
        let (pose, covariance) = (estimate.map_from_target, estimate.covariance);
        let spread = covariance.0[(0, 0)].max(covariance.0[(1, 1)]).sqrt();
        let is_one = estimate.share >= ONE_CLUSTER && spread <= MAX_SPREAD_M;
        self.agreeing = if is_one { self.agreeing + 1 } else { 0 };
        self.found = Some((pose, covariance));
        self.report.probability = estimate.share;
        self.report.lead = (estimate.share / (1.0 - estimate.share).max(1e-9)).ln();
        self.report.rivals = if is_one { 1 } else { 2 };
        let at = GridPose::of(seen.distance_field.frame, pose);
        let score = seen.distance_field.score(seen.ends, at, seen.fit);
        self.bad = if score < LOST_SCORE { self.bad + 1 } else { 0 };
        self.report.score = score;
    }

    fn conclude(&mut self, seen: &Seen<'_>) {
        let was = self.report.state;
        let was_found = was != TrackState::Searching;
        let is_sure = self.agreeing >= MIN_KEYS && self.report.score >= LEAST_SCORE;
        let (state, reason) = match () {
            () if self.bad >= LOST_SCANS && was_found => (TrackState::Lost, TrackReason::PoorFit),
            () if self.filter.is_none() => (TrackState::Searching, TrackReason::NoPlace),
            () if is_sure => (TrackState::Unique, TrackReason::OnePlace),
            () if was.is_believed() => (TrackState::Doubtful, TrackReason::PoorFit),
            () if was == TrackState::Lost => (TrackState::Lost, TrackReason::PoorFit),
            () => (TrackState::Searching, TrackReason::TooEarly),
        };
        if self.bad >= LOST_SCANS {
            self.start(seen, []);
        }
        self.enter(state, reason);
        self.carry();
    }

    fn enter(&mut self, state: TrackState, reason: TrackReason) {
        if state != self.report.state || self.report.since_ns == 0 {
            self.report.since_ns = self.stamp_ns;
            self.report.since_m = 0.0;
        }
        (self.report.state, self.report.reason) = (state, reason);
    }

    /// The pose at the last scan, by odometry since the last key scan.
    fn carry(&mut self) {
        let carried = self.found.map(|(pose, covariance)| {
            let noise = self.config.odometry_error;
            self.since_key.predict((pose, covariance.0), noise)
        });
        self.report.pose = carried.map(|(pose, _)| pose);
        self.report.covariance = carried.map_or_else(Matrix3::zeros, |(_, covariance)| covariance);
    }

    /// Where the robot is, and how sure that is.
    #[must_use]
    pub fn report(&self) -> Report {
        Report {
            map: self.map,
            ..self.report
        }
    }
}

fn seed(map_from_target: Pose, covariance: Covariance) -> particles::Candidate {
    particles::Candidate {
        map_from_target,
        covariance,
        weight: 1.0,
    }
}
