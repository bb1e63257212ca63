//! Copies settings to the tracker, so that it judges scans as the nodes before it do. If it is
//! wired to request searches, the accumulator waits for its requests.

use dataflow::{Dataflow, Node};
use messages::{Topic, topic};

use super::arguments::{ACCUMULATOR, set, value};
use super::forward::plays_at_max;

const TRACKER: &str = "tracker";
const SEARCH: &str = "--search";

/// Options that a tracker shares with other nodes, by executable.
const SHARED: [(&str, &[&str]); 2] = [
    (
        ACCUMULATOR,
        &[
            "--scans",
            "--odometry-delay-s",
            "--scan-stamp",
            "--deskew",
            "--max-beams",
            "--beam-arc-m",
        ],
    ),
    (
        "peak_extractor",
        &[
            "--fit-sigma-m",
            "--fit-sigma-cells",
            "--through-penalty",
            "--unknown-score",
            "--drawn-doubt",
        ],
    ),
];

/// True if a node publishes tracked poses.
pub fn has_tracker(dataflow: &Dataflow) -> bool {
    let mut outputs = dataflow.nodes.iter().flat_map(|node| &node.outputs);
    outputs.any(|output| output == topic::Tracked::NAME)
}

/// Copies missing options from accumulator and peak_extractor to trackers. Sets `--search asked`
/// for accumulators that take `attention`, unless `--rate max` is used.
pub fn settle(dataflow: &mut Dataflow) {
    for (executable, options) in SHARED {
        for option in options {
            if let Some(found) = setting(dataflow, executable, option) {
                for tracker in trackers(dataflow) {
                    if value(tracker, option).is_none() {
                        set(tracker, option, Some(&found));
                    }
                }
            }
        }
    }
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

/// Returns the value of an option of the first node with an executable.
fn setting(dataflow: &Dataflow, executable: &str, option: &str) -> Option<String> {
    let mut nodes = dataflow.nodes.iter();
    let node = nodes.find(|node| node.executable() == executable)?;
    value(node, option).map(str::to_owned)
}

fn trackers(dataflow: &mut Dataflow) -> impl Iterator<Item = &mut Node> {
    let nodes = dataflow.nodes.iter_mut();
    nodes.filter(|node| node.executable() == TRACKER)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing::parsed;

    fn settled(player: &str) -> Vec<Vec<String>> {
        let text = format!(
            "nodes:
  - {{id: r, path: bin/replayer, args: {player}, outputs: [scan]}}
  - {{id: p, path: bin/peak_extractor, args: --fit-sigma-m 0.2}}
  - {{id: a, path: bin/accumulator, args: --max-beams=90, inputs: {{scan: r/scan, attention: t/attention}}, outputs: [votes]}}
  - {{id: t, path: bin/tracker, args: --rate 10 --max-beams 60, inputs: {{scan: r/scan}}, outputs: [attention]}}
"
        );
        let mut dataflow = parsed(&text);
        settle(&mut dataflow);
        dataflow.nodes.into_iter().map(|node| node.args).collect()
    }

    #[test]
    fn a_tracker_takes_over_the_settings_of_others() {
        let args = settled("--rate=1");
        let expected = ["--rate", "10", "--max-beams", "60", "--fit-sigma-m=0.2"];
        assert_eq!(args[3], expected);
    }

    #[test]
    fn scans_are_searched_as_they_are_asked_for_unless_nothing_may_be_lost() {
        assert_eq!(settled("--rate=1")[2], ["--max-beams=90", "--search=asked"]);
        assert_eq!(settled("--rate=max")[2], ["--max-beams=90"]);
    }
}
