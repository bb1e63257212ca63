//! Topics that leave and enter the graph, from the descriptor.

use std::path::Path;

use dataflow::Dataflow;
use messages::{Topic, topic};

use crate::BridgeError;

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ports {
    /// Topics that are sent: the inputs of the node, and the health of all nodes unless it is
    /// received.
    pub out: Vec<String>,
    /// Topics that are received: the outputs of the node.
    pub into: Vec<String>,
}

impl Ports {
    /// Reads the ports of node `id` from the descriptor `file`.
    pub fn read(file: &Path, id: &str) -> Result<Self, BridgeError> {
        Self::of(&dataflow::load(file)?, file, id)
    }

    fn of(graph: &Dataflow, file: &Path, id: &str) -> Result<Self, BridgeError> {
        let Some(node) = graph.nodes.iter().find(|node| node.id == id) else {
            let ids: Vec<_> = graph.nodes.iter().map(|node| node.id.as_str()).collect();
            return Err(BridgeError::NoSuchNode {
                file: file.to_owned(),
                id: id.to_owned(),
                allowed: ids.join(", "),
            });
        };
        let into = node.outputs.clone();
        let mut out: Vec<String> = Vec::new();
        for input in &node.inputs {
            // Scans of several lasers share one topic.
            if !out.contains(&input.topic) {
                out.push(input.topic.clone());
            }
        }
        if let Some(both) = out.iter().find(|topic| into.contains(topic)) {
            let topic = both.clone();
            return Err(BridgeError::Circle { topic });
        }
        let health = topic::Health::NAME.to_owned();
        if !into.contains(&health) && !out.contains(&health) {
            out.push(health);
        }
        Ok(Ports { out, into })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bridge: &str, id: &str) -> Result<Ports, BridgeError> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("dataflow.yaml");
        let text = format!(
            "nodes:\n  - {{id: laser, path: x, outputs: [scan, log]}}\n  - {{id: bridge, path: y, {bridge}}}\n"
        );
        std::fs::write(&file, text).unwrap();
        Ports::read(&file, id)
    }

    #[test]
    fn inputs_go_out_and_outputs_come_in() {
        let ports = read("inputs: {scan: laser/scan}, outputs: [map]", "bridge").unwrap();
        assert_eq!(ports.out, ["scan", "health"]);
        assert_eq!(ports.into, ["map"]);
    }

    #[test]
    fn health_goes_out_unless_it_comes_in() {
        let ports = read("outputs: [health, hypotheses]", "bridge").unwrap();
        assert!(ports.out.is_empty());
        assert_eq!(ports.into, ["health", "hypotheses"]);
    }

    #[test]
    fn what_would_go_in_circles_is_refused() {
        let sound = "inputs: {scan: laser/scan}, outputs: [health, log]";
        assert!(read(sound, "bridge").is_ok());
        let error = read("inputs: {log: laser/log}, outputs: [log]", "bridge").unwrap_err();
        assert!(matches!(error, BridgeError::Circle { topic } if topic == "log"));
    }

    #[test]
    fn another_id_says_which_there_are() {
        let error = read("outputs: [map]", "brigde").unwrap_err().to_string();
        assert!(error.ends_with("allowed are laser, bridge"), "{error}");
    }
}
