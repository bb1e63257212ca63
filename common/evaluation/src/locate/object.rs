//! A scan and its hypotheses as JSON, each line with the same keys. Pure.

use std::iter;

use answers::{Candidate, Frame, Place, ScanAnswer, map_id};
use engine::fit::BeamClass;
use engine::vote_search::Outcome;
use geometry::Pose;
use messages::Verdict;
use offline::{Answer, Reply, TakenScan};
use schemars::JsonSchema;
use serde::Serialize;

use super::particles::Particles;

#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct Object {
    /// Time of measurement, in nanoseconds since 1970.
    stamp_ns: i64,
    /// Verdict and best place.
    #[serde(flatten)]
    answer: ScanAnswer,
    /// Floor of the best place's map, if the map set defines it.
    floor: Option<String>,
    /// Reason for the rejection.
    refused: Option<String>,
    votes: Option<Votes>,
    /// Number of beams by class, at the best place; null in votes-only mode.
    beams: Option<Beams>,
    /// Best first.
    hypotheses: Vec<Candidate>,
    /// Initial particles for a particle filter; null without `--particles`.
    particles: Option<Particles>,
}

/// Header of the topic `votes`.
#[derive(Debug, Serialize, JsonSchema)]
struct Votes {
    best: u16,
    floor: u16,
    certified_floor: u16,
    highest_possible: u32,
    total: u64,
    truncated: bool,
    beams_used: u32,
    beams_silent: u32,
    poses_evaluated: u64,
    headings: u32,
    /// Heading in the map, in radians, if one was given.
    known_heading: Option<f64>,
    /// In radians.
    bearing_rounding: f64,
}

/// Number of beams that voted, by their end relative to the map.
#[derive(Debug, Serialize, JsonSchema)]
struct Beams {
    /// At an obstacle.
    hit: usize,
    /// In free space.
    short: usize,
    /// Behind an obstacle.
    through: usize,
    /// Behind unknown space.
    unknown: usize,
}

impl Object {
    pub(super) fn new(scan: &TakenScan, reply: &Reply<'_>) -> Self {
        let answer = ScanAnswer {
            stamp_ns: scan.stamp_ns,
            verdict: Verdict::NoScan.as_str(),
            alternatives: 0,
            says: String::new(),
            best: Place {
                map_id: map_id(reply.map_id),
                frame: Frame::of(scan.base_from_laser.is_some()),
                ..Place::default()
            },
            cpu_ms: reply.cpu_ms,
            latency_ms: None,
        };
        let mut object = Object {
            stamp_ns: scan.stamp_ns,
            answer,
            floor: None,
            refused: None,
            votes: None,
            beams: None,
            hypotheses: Vec::new(),
            particles: None,
        };
        match &reply.answer {
            Ok(answer) => object.fill(answer, scan.base_from_laser),
            Err(refusal) => object.refused = Some(format!("{refusal:#}")),
        }
        object
    }

    pub(super) fn with(self, particles: Option<Particles>) -> Self {
        Object { particles, ..self }
    }

    pub(super) fn frame(&self) -> Frame {
        self.answer.best.frame
    }

    /// Formats the row of `backcast run`, the reason for a rejection, and the particles.
    pub(super) fn text(&self) -> String {
        let refused = self.refused.iter().map(|reason| format!("  {reason}"));
        let particles = self.particles.iter().map(Particles::text);
        let all = iter::once(self.answer.text()).chain(refused);
        all.chain(particles).collect()
    }

    fn fill(&mut self, answer: &Answer<'_>, base_from_laser: Option<Pose>) {
        let places = answer.places;
        let laser_from_base = base_from_laser.map(Pose::inverse);
        let candidate = |place: &engine::peaks::Place| {
            let (laser, map) = (place.map_from_laser, &answer.maps[place.map as usize]);
            let base = laser_from_base.map(|base| laser.then(base).into());
            Candidate {
                place: Place {
                    map: Some(map.name.clone()).filter(|name| !name.is_empty()),
                    score: Some(place.score),
                    probability: Some(place.probability),
                    ..Place::new(map.id, laser.into(), place.covariance.to_rows(), base)
                },
                intensity: place.intensity.into(),
                support: place.support,
            }
        };
        self.hypotheses = places.places.iter().map(candidate).collect();
        self.answer.verdict = places.verdict.as_str();
        self.answer.alternatives = places.alternatives;
        self.answer.says = places.sentence();
        self.votes = Some(votes(answer.outcome));
        self.beams = beams(&places.classes);
        if let Some(best) = self.hypotheses.first() {
            self.answer.best = best.place.clone();
            self.floor.clone_from(&answer.map.floor);
        }
    }
}

fn beams(classes: &[BeamClass]) -> Option<Beams> {
    let count = |class| classes.iter().filter(|&&other| other == class).count();
    (!classes.is_empty()).then(|| Beams {
        hit: count(BeamClass::Hit),
        short: count(BeamClass::Short),
        through: count(BeamClass::Through),
        unknown: count(BeamClass::Unknown),
    })
}

fn votes(outcome: &Outcome) -> Votes {
    let found = &outcome.found;
    Votes {
        best: found.best,
        floor: found.floor,
        certified_floor: found.certified_floor,
        highest_possible: outcome.highest_possible,
        total: found.votes.len() as u64,
        truncated: found.truncated || found.cut,
        beams_used: outcome.beams_used,
        beams_silent: outcome.beams_silent,
        poses_evaluated: found.poses_evaluated,
        headings: outcome.headings,
        known_heading: outcome.known_heading,
        bearing_rounding: outcome.bearing_rounding,
    }
}
