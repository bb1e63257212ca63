//! Several lasers in one graph: names the `lms_reader`s, and tells accumulator and tracker which to
//! join, in the order of the accumulator's inputs; descriptor and settings have priority.

use std::path::Path;

use dataflow::{Dataflow, Input, Node};
use messages::{Topic, topic};

use super::arguments::{ACCUMULATOR, TRACKER, set, value};
use super::shared;

/// Node that reads a laser.
pub(crate) const LMS_READER: &str = "lms_reader";
const SCANS: &str = "--scans";
const LASER: &str = "--laser";

pub(crate) fn name(dataflow: &mut Dataflow, folder: &Path) -> anyhow::Result<()> {
    let sends_scans = |node: &&dataflow::Node| node.outputs.iter().any(|o| o == topic::Scan::NAME);
    let senders = dataflow.nodes.iter().filter(sends_scans);
    let lasers: usize = senders.map(|node| node.streams.len().max(1)).sum();
    let mut order: Option<String> = None;
    for node in &mut dataflow.nodes {
        if node.executable() == LMS_READER && lasers > 1 && value(node, LASER).is_none() {
            let id = node.id.clone();
            set(node, LASER, Some(&id));
        }
        if node.executable() == ACCUMULATOR {
            let scans = node.inputs.iter().filter(|i| i.topic == topic::Scan::NAME);
            let wired: Vec<&str> = scans.map(laser).collect();
            let wired = Some(wired.join(",")).filter(|wired| lasers > 1 && !wired.is_empty());
            let scans = name_scans(node, wired, folder)?;
            order = order.or(scans);
        }
    }
    for node in &mut dataflow.nodes {
        if node.executable() == TRACKER {
            name_scans(node, order.clone(), folder)?;
        }
    }
    Ok(())
}

/// Makes a node join these lasers unless it is given others. Returns those that it joins.
fn name_scans(
    node: &mut Node,
    scans: Option<String>,
    folder: &Path,
) -> anyhow::Result<Option<String>> {
    let given = shared::given(node, "scans", folder)?;
    if let (None, Some(scans)) = (&given, &scans) {
        set(node, SCANS, Some(scans));
    }
    Ok(given.or(scans))
}

/// Makes the nodes join these lasers, regardless of their inputs and settings.
pub(crate) fn join(dataflow: &mut Dataflow, lasers: &[String]) {
    let nodes = dataflow.nodes.iter_mut();
    for node in nodes.filter(|node| [ACCUMULATOR, TRACKER].contains(&node.executable())) {
        set(node, SCANS, Some(&lasers.join(",")));
    }
}

/// Returns the laser whose scans trigger answers, if the graph has several lasers.
pub(crate) fn first(dataflow: &Dataflow, folder: &Path) -> anyhow::Result<Option<String>> {
    let Some(accumulator) = dataflow.node(ACCUMULATOR) else {
        return Ok(None);
    };
    let scans = shared::given(accumulator, "scans", folder)?;
    Ok(scans.and_then(|scans| Some(scans.split(',').next()?.to_owned())))
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
        let mut dataflow = dataflow::parse(text).unwrap();
        name(&mut dataflow, Path::new("/")).unwrap();
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
  - {id: c, path: bin/accumulator, inputs: {scan: rear/scan}}
  - {id: t, path: bin/tracker, inputs: {scan: front/scan}}
",
        );
        assert_eq!(args[0], ["--laser=rear"]);
        assert_eq!(args[1], ["--laser=nose"]);
        assert!(args[2].is_empty());
        assert_eq!(args[3], ["--scans=front,rear,left"]);
        assert_eq!(args[4], ["--scans", "nose"]);
        assert_eq!(args[5], ["--scans=rear"]);
        assert_eq!(args[6], ["--scans=front,rear,left"]);
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
