//! Several lasers in one graph: names the senders of scans and tells the accumulator which to join.
//!
//! Each `lms_reader` gets its name, and the accumulator the lasers in the order of its inputs.
//! Arguments in the descriptor have priority.

use dataflow::{Dataflow, Input};
use messages::{Topic, topic};

use super::arguments::{ACCUMULATOR, set, value};

const LMS_READER: &str = "lms_reader";
const SCANS: &str = "--scans";
const LASER: &str = "--laser";

/// Names readers and configures accumulators if a graph has several lasers.
pub(crate) fn name(dataflow: &mut Dataflow) {
    let sends_scans = |node: &&dataflow::Node| node.outputs.iter().any(|o| o == topic::Scan::NAME);
    let senders = dataflow.nodes.iter().filter(sends_scans);
    let lasers: usize = senders.map(|node| node.streams.len().max(1)).sum();
    if lasers < 2 {
        return;
    }
    for node in &mut dataflow.nodes {
        if node.executable() == LMS_READER && value(node, LASER).is_none() {
            let id = node.id.clone();
            set(node, LASER, Some(&id));
        }
        if node.executable() == ACCUMULATOR && value(node, SCANS).is_none() {
            let scans = node.inputs.iter().filter(|i| i.topic == topic::Scan::NAME);
            let wired: Vec<&str> = scans.map(laser).collect();
            let wired = wired.join(",");
            set(
                node,
                SCANS,
                Some(&wired).filter(|w| !w.is_empty()).map(|w| &**w),
            );
        }
    }
}

/// Makes the accumulators join these lasers, regardless of their inputs.
pub(crate) fn join(dataflow: &mut Dataflow, lasers: &[String]) {
    let nodes = dataflow.nodes.iter_mut();
    for node in nodes.filter(|node| node.executable() == ACCUMULATOR) {
        set(node, SCANS, Some(&lasers.join(",")));
    }
}

/// Returns the laser whose scans trigger answers, if the graph has several lasers.
pub(crate) fn first(dataflow: &Dataflow) -> Option<String> {
    let mut nodes = dataflow.nodes.iter();
    let accumulator = nodes.find(|node| node.executable() == ACCUMULATOR)?;
    let first = value(accumulator, SCANS)?.split(',').next()?;
    Some(first.to_owned())
}

fn laser(input: &Input) -> &str {
    match &*input.stream {
        "" => &input.from,
        stream => stream,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(text: &str) -> Vec<Vec<String>> {
        let topics = dataflow::Topics {
            names: topic::NAMES,
            several: &[topic::Scan::NAME],
            ..dataflow::Topics::default()
        };
        let mut dataflow = dataflow::parse(text, &topics).unwrap();
        name(&mut dataflow);
        dataflow.nodes.into_iter().map(|node| node.args).collect()
    }

    #[test]
    fn readers_are_named_and_joined_as_they_are_wired() {
        let args = named(
            "nodes:
  - {id: rear, path: bin/lms_reader, outputs: [scan]}
  - {id: front, path: bin/lms_reader, args: --laser=nose, outputs: [scan]}
  - {id: bag, path: bin/replayer, outputs: [scan_left, scan_right]}
  - {id: a, path: bin/accumulator, inputs: {scan_front: front/scan, scan_rear: rear/scan, l: bag/scan_left}}
  - {id: b, path: bin/accumulator, args: --scans nose, inputs: {scan: front/scan}}
",
        );
        assert_eq!(args[0], ["--laser=rear"]);
        assert_eq!(args[1], ["--laser=nose"]);
        assert!(args[2].is_empty());
        assert_eq!(args[3], ["--scans=front,rear,left"]);
        assert_eq!(args[4], ["--scans", "nose"]);
    }

    #[test]
    fn one_laser_needs_no_name() {
        let args = named(
            "nodes:
  - {id: front, path: bin/lms_reader, outputs: [scan]}
  - {id: a, path: bin/accumulator, inputs: {scan: front/scan}}
",
        );
        assert!(args.iter().all(Vec::is_empty));
    }
}
