//! Results of a graph, collected while it runs.

use std::path::Path;
use std::time::Duration;

use messages::{HypothesesHeader, Hypothesis, Vote, VotesHeader, topic};
use transport::testing::Isolated;
use transport::{Flow, Graph, Subscriber, TransportError};

use crate::executables;

/// The votes and the hypotheses of all scans, in the order of arrival.
#[derive(Default)]
pub struct Answers {
    pub votes: Vec<(VotesHeader, Vec<Vote>)>,
    pub hypotheses: Vec<(HypothesesHeader, Vec<Hypothesis>)>,
}

/// Plays a recording through a graph of its own, waiting for each result, until there are results
/// of `scans` scans.
///
/// `accumulator` holds further arguments of that node.
pub fn of_graph(
    tag: &str,
    recording: &Path,
    map: &Path,
    scans: usize,
    accumulator: &[&str],
) -> Answers {
    let source = [
        "--rate",
        "max",
        "--wait-for",
        "accumulator,peak_extractor",
        "--recording",
        recording.to_str().unwrap(),
    ];
    of_graph_fed_by(tag, map, scans, accumulator, &source)
}

/// Lets a replayer with these arguments feed a graph of its own until there are results of `scans`
/// scans; the replayer ends by itself then.
pub fn of_graph_fed_by(
    tag: &str,
    map: &Path,
    scans: usize,
    accumulator: &[&str],
    replayer: &[&str],
) -> Answers {
    let isolated = Isolated::new(tag);
    let graph = isolated.join("test");
    let votes = graph.subscriber::<topic::Votes>().unwrap();
    let hypotheses = graph.subscriber::<topic::Hypotheses>().unwrap();
    let start = |name: &str, arguments: &[&str]| executables::start(name, &graph, arguments);
    let nodes = [
        start("map_server", &["--map", map.to_str().unwrap()]),
        start("boundary_extractor", &[]),
        start("accumulator", accumulator),
        start("peak_extractor", &[]),
    ];
    let source = start("replayer", replayer);
    let answers = collect(&graph, &votes, &hypotheses, scans);
    assert_eq!(source.exit_code(), Some(0), "the replayer lost something");
    for node in nodes {
        node.stop();
    }
    answers
}

fn collect(
    graph: &Graph,
    votes: &Subscriber<topic::Votes>,
    hypotheses: &Subscriber<topic::Hypotheses>,
    scans: usize,
) -> Answers {
    let mut answers = Answers::default();
    let outcome = graph.run(&[votes, hypotheses], Duration::from_millis(100), |_| {
        while let Some(sample) = votes.receive()? {
            answers
                .votes
                .push((*sample.header(), sample.items().to_vec()));
        }
        while let Some(sample) = hypotheses.receive()? {
            answers
                .hypotheses
                .push((*sample.header(), sample.items().to_vec()));
        }
        let is_complete = answers.votes.len() == scans && answers.hypotheses.len() == scans;
        Ok::<_, TransportError>(if is_complete {
            Flow::Stop
        } else {
            Flow::Continue
        })
    });
    outcome.unwrap();
    answers
}
