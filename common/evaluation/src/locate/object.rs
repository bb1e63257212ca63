//! A scan and its hypotheses as JSON. Pure.
//!
//! Every line has the same keys; a rejected scan has null for the results, any other scan has null
//! for the reason.

use engine::fit::BeamClass;
use engine::peaks::Place;
use engine::vote_search::Outcome;
use geometry::Pose;
use messages::Verdict;
use offline::{Answer, KnownMap, Reply, TakenScan};
use schemars::JsonSchema;
use serde::Serialize;

use super::particles::Particles;

#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct Object {
    /// Time of measurement, in nanoseconds since 1970.
    stamp_ns: i64,
    /// The map's id in hexadecimal, as in logs: JSON numbers cannot hold 64 bits safely.
    map_id: String,
    /// Name of the best place's map, if several maps are searched; else null.
    map: Option<String>,
    /// Floor of that map, if the map set defines it.
    floor: Option<String>,
    verdict: &'static str,
    /// Number of other places that fit about as well.
    alternatives: u32,
    /// The verdict in words; null for a rejected scan.
    says: Option<String>,
    /// Probability of the best place, 0..=1; in votes-only mode its relative lead over the next
    /// place.
    confidence: f64,
    /// CPU time from the scan to the verdict, in milliseconds.
    cpu_ms: f64,
    /// Reason for the rejection.
    refused: Option<String>,
    votes: Option<Votes>,
    /// Number of beams by class, at the best place; null in votes-only mode.
    beams: Option<Beams>,
    /// Best first.
    hypotheses: Vec<Hypothesis>,
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

/// A pose `map_from_laser` in metres and radians, with its uncertainty.
#[derive(Debug, Serialize, JsonSchema)]
struct Hypothesis {
    /// Name of its map, if several maps are searched; else null.
    map: Option<String>,
    x: f64,
    y: f64,
    yaw: f64,
    /// Over x, y and yaw, row by row.
    covariance: [f64; 9],
    score: f64,
    /// 0..=1; the rest to a sum of 1 is the probability that none is right.
    probability: f64,
    intensity: u16,
    support: u64,
    /// Pose of the base, if the laser's mount is known.
    #[schemars(with = "Option<json::schema::Pose>")]
    map_from_base: Option<Pose>,
}

impl Object {
    pub(super) fn new(scan: &TakenScan, reply: &Reply<'_>) -> Self {
        let mut object = Object {
            stamp_ns: scan.stamp_ns,
            map_id: format!("{:016x}", reply.map_id),
            map: None,
            floor: None,
            verdict: Verdict::NoScan.as_str(),
            alternatives: 0,
            says: None,
            confidence: 0.0,
            cpu_ms: reply.cpu_ms,
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

    /// Adds initial particles.
    pub(super) fn with(self, particles: Option<Particles>) -> Self {
        Object { particles, ..self }
    }

    fn fill(
        &mut self,
        Answer {
            outcome,
            places,
            map,
            maps,
            ..
        }: &Answer<'_>,
        base_from_laser: Option<Pose>,
    ) {
        self.verdict = places.verdict.as_str();
        self.alternatives = places.alternatives;
        self.says = Some(places.sentence());
        self.confidence = places.confidence;
        self.votes = Some(votes(outcome));
        self.beams = beams(&places.classes);
        let laser_from_base = base_from_laser.map(Pose::inverse);
        let name = |map: &KnownMap| Some(map.name.clone()).filter(|name| !name.is_empty());
        if !places.places.is_empty() {
            (self.map, self.floor) = (name(map), map.floor.clone());
        }
        let hypothesis = |place: &Place| Hypothesis {
            map: name(&maps[place.map as usize]),
            x: place.map_from_laser.x,
            y: place.map_from_laser.y,
            yaw: place.map_from_laser.yaw,
            covariance: place.covariance.to_rows(),
            score: place.score,
            probability: place.probability,
            intensity: place.intensity,
            support: place.support,
            map_from_base: laser_from_base.map(|base| place.map_from_laser.then(base)),
        };
        self.hypotheses = places.places.iter().map(hypothesis).collect();
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
