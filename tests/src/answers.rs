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
/// of `scans` scans; the replayer ends by itself then.
///
/// `accumulator` and `replayer` hold further arguments of those nodes.
pub fn of_graph(
    tag: &str,
    recording: &Path,
    map: &Path,
    scans: usize,
    accumulator: &[&str],
    replayer: &[&str],
) -> Answers {
    let wait = ["--rate", "max", "--wait-for", "accumulator,peak_extractor"];
    let source = ["--recording", recording.to_str().unwrap()];
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
    let source = start("replayer", &[&wait[..], &source, replayer].concat());
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
            let votes = (*sample.header(), sample.items().to_vec());
            answers.votes.push(votes);
        }
        while let Some(sample) = hypotheses.receive()? {
            let hypotheses = (*sample.header(), sample.items().to_vec());
            answers.hypotheses.push(hypotheses);
        }
        let is_complete = answers.votes.len() == scans && answers.hypotheses.len() == scans;
        Ok::<_, TransportError>(match is_complete {
            true => Flow::Stop,
            false => Flow::Continue,
        })
    });
    outcome.unwrap();
    answers
}
