//! Puts a replayer in place of the sources of a graph.

use std::path::PathBuf;

use dataflow::{Dataflow, Input, Node, Restart};
use messages::{Topic, topic};

use super::added;
use super::arguments::{REPLAYER, add_to_list, unset};
use super::supervision::{MEASUREMENTS, is_source};

/// Makes the graph's replayer, or one in place of its sources, play these recordings as one.
pub fn play<'d>(dataflow: &'d mut Dataflow, recordings: &[PathBuf]) -> &'d mut Node {
    let at = dataflow
        .nodes
        .iter()
        .position(|node| node.executable() == REPLAYER)
        .unwrap_or_else(|| replace_sources(dataflow));
    let replayer = &mut dataflow.nodes[at];
    unset(replayer, "--recording", true);
    for recording in recordings {
        let argument = format!("--recording={}", recording.to_string_lossy());
        replayer.args.push(argument);
    }
    replayer
}

/// Makes the replayers wait at `--rate max` until `node`, which only listens, has each answer.
pub fn keep_in_step(dataflow: &mut Dataflow, node: &str) {
    let nodes = dataflow.nodes.iter_mut();
    for replayer in nodes.filter(|node| node.executable() == REPLAYER) {
        add_to_list(replayer, "--in-step", node);
    }
}

/// Removes the sources and inserts a replayer as the first node; returns its index.
fn replace_sources(dataflow: &mut Dataflow) -> usize {
    let replayer = replayer(dataflow);
    dataflow.nodes.retain(|node| !is_source(node));
    let senders: Vec<String> = dataflow.nodes.iter().map(|node| node.id.clone()).collect();
    for input in dataflow.nodes.iter_mut().flat_map(|node| &mut node.inputs) {
        if !senders.contains(&input.from) {
            input.from.clone_from(&replayer.id);
        }
    }
    dataflow.nodes.insert(0, replayer);
    0
}

fn replayer(dataflow: &mut Dataflow) -> Node {
    let sends = |topic: &str| {
        let mut nodes = dataflow.nodes.iter();
        nodes.find(|node| node.outputs.iter().any(|output| output == topic))
    };
    let answers = sends(topic::Hypotheses::NAME).map(|node| Input {
        topic: topic::Hypotheses::NAME.to_owned(),
        from: node.id.clone(),
        stream: String::new(),
    });
    let inputs = answers.into_iter().collect();
    // Nodes that only display need not be waited for.
    let steps = [
        topic::Votes::NAME,
        topic::Hypotheses::NAME,
        topic::Tracked::NAME,
    ];
    let takes_scans = |node: &&Node| {
        let (mut inputs, mut outputs) = (node.inputs.iter(), node.outputs.iter());
        inputs.any(|input| input.topic == topic::Scan::NAME)
            && outputs.any(|output| steps.contains(&output.as_str()))
    };
    let takers = dataflow.nodes.iter().filter(takes_scans);
    let takers: Vec<&str> = takers.map(Node::executable).collect();
    let args = match takers.is_empty() {
        true => Vec::new(),
        false => vec![format!("--wait-for={}", takers.join(","))],
    };
    let build = added::build(dataflow, REPLAYER);
    Node {
        args,
        inputs,
        outputs: MEASUREMENTS.map(str::to_owned).into(),
        // A restarted replayer would start from the beginning.
        restart: Restart::DEFAULT,
        ..added::node(dataflow, REPLAYER, build)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing::parsed;

    #[test]
    fn a_laser_gives_way_to_a_replayer() {
        let mut dataflow = parsed(
            "nodes:
  - {id: sim, path: bin/emulator, args: --recording a, build: cargo build -p emulator, outputs: [odometry], inputs: {hypotheses: p/hypotheses}}
  - {id: laser, path: bin/lms_reader, args: --tcp a, outputs: [scan]}
  - {id: a, path: bin/accumulator, inputs: {scan: laser/scan, odometry: sim/odometry, map: m/map}, outputs: [votes]}
  - {id: p, path: bin/peak_extractor, inputs: {scan: laser/scan, votes: a/votes}, outputs: [hypotheses]}
  - {id: m, path: bin/map_server, outputs: [map], build: cargo build -p emulator}
",
        );
        play(&mut dataflow, &["/r.mcap".into()]);
        let ids: Vec<&str> = dataflow.nodes.iter().map(|node| &*node.id).collect();
        assert_eq!(ids, ["replayer", "a", "p", "m"]);
        let replayer = &dataflow.nodes[0];
        assert_eq!(replayer.path, "bin/replayer");
        let args = [
            "--wait-for=accumulator,peak_extractor",
            "--recording=/r.mcap",
        ];
        assert_eq!(replayer.args, args);
        assert_eq!(replayer.inputs[0].from, "p");
        let from: Vec<&str> = dataflow.nodes[1].inputs.iter().map(|i| &*i.from).collect();
        assert!(from.contains(&"m"));
        assert_eq!(from.iter().filter(|from| **from == "replayer").count(), 2);
        let build = "cargo build -p emulator --package replayer";
        assert_eq!(dataflow.nodes[3].build[0].to_string(), build);
    }
}
