//! The tracker of a graph, for whose requests the accumulator may wait.

use dataflow::{Dataflow, Node};
use messages::{Topic, topic};

use super::arguments::{ACCUMULATOR, set, value};
use super::forward::plays_at_max;

const SEARCH: &str = "--search";

pub fn has_tracker(dataflow: &Dataflow) -> bool {
    let mut outputs = dataflow.nodes.iter().flat_map(|node| &node.outputs);
    outputs.any(|output| output == topic::Tracked::NAME)
}

/// Sets `--search asked` for accumulators that take `attention`, unless `--rate max` is used.
pub fn settle(dataflow: &mut Dataflow) {
    if plays_at_max(dataflow) {
        return;
    }
    let asked = |node: &&mut Node| {
        let mut inputs = node.inputs.iter();
        node.executable() == ACCUMULATOR
            && inputs.any(|input| input.topic == topic::Attention::NAME)
            && value(node, SEARCH).is_none()
    };
    for node in dataflow.nodes.iter_mut().filter(asked) {
        set(node, SEARCH, Some("asked"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing::parsed;

    fn settled(player: &str) -> Vec<Vec<String>> {
        let text = format!(
            "nodes:
  - {{id: r, path: bin/replayer, args: {player}, outputs: [scan]}}
  - {{id: a, path: bin/accumulator, args: --max-beams=90, inputs: {{scan: r/scan, attention: t/attention}}, outputs: [votes]}}
  - {{id: t, path: bin/tracker, inputs: {{scan: r/scan}}, outputs: [attention]}}
"
        );
        let mut dataflow = parsed(&text);
        settle(&mut dataflow);
        dataflow.nodes.into_iter().map(|node| node.args).collect()
    }

    #[test]
    fn scans_are_searched_as_they_are_asked_for_unless_nothing_may_be_lost() {
        assert_eq!(settled("--rate=1")[1], ["--max-beams=90", "--search=asked"]);
        assert_eq!(settled("--rate=max")[1], ["--max-beams=90"]);
    }
}
