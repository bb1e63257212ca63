//! What the monitor has told. Fields that it does not tell are at rest.

use std::collections::{BTreeMap, VecDeque};

use serde::Deserialize;

/// Latencies that are kept: as many as a line can show.
const LATENCIES: usize = 120;

/// A message of the monitor, as far as it is shown here.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(super) enum Message {
    /// All that is known.
    Snapshot(Snapshot),
    /// Of one scan.
    Answer(Answer),
    /// How a node fares.
    Node(Node),
    /// What is not shown here.
    #[serde(other)]
    Other,
}

/// All that is known.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Snapshot {
    robot: String,
    answer: Option<Answer>,
    nodes: Vec<Node>,
}

/// The answer to a scan.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Answer {
    pub(super) counter: u64,
    pub(super) verdict: String,
    pub(super) says: String,
    pub(super) latency_ms: f64,
    pub(super) search_ms: f64,
    pub(super) extract_ms: f64,
    pub(super) hypotheses: Vec<Place>,
}

/// One place: metres and radians in the map.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Place {
    pub(super) laser: Pose,
    pub(super) score: f64,
    pub(super) probability: f64,
}

/// Metres and radians.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(default)]
pub(super) struct Pose {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) yaw: f64,
}

/// How a node fares.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub(super) struct Node {
    pub(super) name: String,
    pub(super) state: String,
    pub(super) received_hz: f64,
    pub(super) sent_hz: f64,
    pub(super) dropped: u64,
    pub(super) refused: u64,
    pub(super) restarts: u32,
    pub(super) last_error: String,
}

/// The state of the graph.
#[derive(Debug, Default)]
pub(super) struct Known {
    pub(super) robot: String,
    pub(super) answer: Option<Answer>,
    pub(super) nodes: BTreeMap<String, Node>,
    pub(super) latencies_ms: VecDeque<f64>,
    /// Why nothing is heard at the moment.
    pub(super) lost: Option<String>,
}

impl Known {
    /// Takes a message.
    pub(super) fn hear(&mut self, message: Message) {
        self.lost = None;
        match message {
            Message::Snapshot(all) => {
                self.robot = all.robot;
                self.answer = all.answer;
                let nodes = all.nodes.into_iter();
                self.nodes = nodes.map(|node| (node.name.clone(), node)).collect();
            }
            Message::Answer(answer) => {
                if self.latencies_ms.len() == LATENCIES {
                    self.latencies_ms.pop_front();
                }
                self.latencies_ms.push_back(answer.latency_ms);
                self.answer = Some(answer);
            }
            Message::Node(node) => {
                self.nodes.insert(node.name.clone(), node);
            }
            Message::Other => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_add_up_and_unknown_ones_are_left_out() {
        let mut known = Known::default();
        for text in [
            r#"{"type":"snapshot","robot":"r","answer":null,"nodes":[{"name":"a","state":"ready"}],"new":1}"#,
            r#"{"type":"node","name":"b","state":"silent","quiet_s":3.0}"#,
            r#"{"type":"beams","fate":"hh"}"#,
            r#"{"type":"answer","counter":7,"verdict":"Unique","latency_ms":20.5,"hypotheses":[]}"#,
        ] {
            known.hear(serde_json::from_str(text).unwrap());
        }
        assert_eq!(known.robot, "r");
        assert_eq!(known.nodes.keys().collect::<Vec<_>>(), ["a", "b"]);
        assert_eq!(known.answer.unwrap().counter, 7);
        assert_eq!(known.latencies_ms, [20.5]);
    }
}
