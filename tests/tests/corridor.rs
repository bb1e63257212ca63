//! The whole graph on the recording that `cargo run` plays.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::fs;

use engine::localizer::Prior;
use geometry::Pose;
use messages::Verdict;
use serde::{Deserialize, Serialize};
use tests::answers::{self, Answers};
use tests::world::{World, as_engine_takes_it};

/// What is expected of one scan. Integers must come out exactly; the refined
/// pose may differ by what other mathematics libraries round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Expected {
    stamp_ns: i64,
    best: u32,
    floor: u32,
    certified_floor: u32,
    highest_possible: u32,
    votes: u64,
    beams_used: u32,
    verdict: String,
    alternatives: u32,
    hypotheses: usize,
    x_m: f64,
    y_m: f64,
    heading_deg: f64,
}

impl Expected {
    fn pose(&self) -> Pose {
        Pose::new(self.x_m, self.y_m, self.heading_deg.to_radians())
    }

    fn integers(&self) -> Expected {
        Expected {
            x_m: 0.0,
            y_m: 0.0,
            heading_deg: 0.0,
            ..self.clone()
        }
    }
}

fn of(answers: &Answers) -> Vec<Expected> {
    let both = answers.votes.iter().zip(&answers.hypotheses);
    let expected = both.map(|((votes, _), (header, hypotheses))| {
        assert_eq!(
            votes.stamp, header.stamp,
            "each scan has one answer of each kind"
        );
        let best = hypotheses[0].map_from_laser;
        Expected {
            stamp_ns: header.stamp.measured_ns,
            best: votes.best,
            floor: votes.floor,
            certified_floor: votes.certified_floor,
            highest_possible: votes.highest_possible,
            votes: votes.total,
            beams_used: votes.beams_used,
            verdict: Verdict::from_code(header.verdict).unwrap().to_string(),
            alternatives: header.alternatives,
            hypotheses: hypotheses.len(),
            x_m: best.x,
            y_m: best.y,
            heading_deg: best.yaw.to_degrees(),
        }
    });
    expected.collect()
}

#[test]
fn the_graph_answers_as_expected_and_as_the_engine_alone() {
    let world = World::of("malaga_corridor");
    let scans = world.scans();
    let answers = answers::of_graph(
        "corridor",
        &world.recording(),
        &world.map(),
        scans.len(),
        &[],
    );

    let found = of(&answers);
    let path = world.folder.join("expected.json");
    // After a change that is meant to change answers, write them anew and look
    // at the difference before it is committed.
    if std::env::var_os("BACKCAST_ACCEPT").is_some() {
        fs::write(&path, serde_json::to_string_pretty(&found).unwrap() + "\n").unwrap();
    }
    let expected: Vec<Expected> =
        serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.integers(), expected.integers());
        // Far below what any laser resolves, far above rounding.
        let (metres, radians) = (0.001, 0.01f64.to_radians());
        assert!(
            found.pose().is_within(expected.pose(), metres, radians),
            "{found:?} is not {expected:?}"
        );
    }

    let localizer = world.localizer(Prior::None);
    for (scan, (header, votes)) in scans.iter().zip(&answers.votes) {
        let outcome = localizer
            .search(&as_engine_takes_it(scan), &|| false)
            .unwrap()
            .unwrap();
        assert_eq!(*votes, outcome.found.votes);
        assert_eq!(header.poses_evaluated, outcome.found.poses_evaluated);
    }
}

#[test]
fn with_known_headings_the_graph_finds_the_same_places() {
    let world = World::of("malaga_corridor");
    let scans = world.scans();
    let arguments = ["--heading-from", "truth"];
    let answers = answers::of_graph(
        "heading",
        &world.recording(),
        &world.map(),
        scans.len(),
        &arguments,
    );
    let truths = recording::Recording::open(world.recording())
        .unwrap()
        .ground_truths()
        .unwrap();
    for (header, hypotheses) in &answers.hypotheses {
        let truth = truths[&header.stamp.measured_ns].pose;
        let best = Pose::from(hypotheses[0].map_from_laser);
        assert!(
            best.is_within(truth, 0.5, 1e-9),
            "{best:?} is not {truth:?}, whose heading was given"
        );
    }
    let localizer = world.localizer(Prior::Heading);
    for (scan, (header, votes)) in scans.iter().zip(&answers.votes) {
        assert_eq!(header.heading_known, 1);
        let asked = localizer.search_at(&as_engine_takes_it(scan), header.known_heading, &|| false);
        let (outcome, _) = asked.unwrap().unwrap();
        assert_eq!(*votes, outcome.found.votes);
    }
}
