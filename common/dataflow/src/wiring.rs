//! Checks across nodes: ids, outputs, and the sources of inputs.

use std::collections::HashMap;

use messages::{Topic, topic};

use crate::Problem;
use crate::raw::{RawDataflow, RawNode, Text};

/// Topics that several nodes may publish: every node does.
const SHARED: [&str; 2] = [topic::Health::NAME, topic::Log::NAME];

/// Topics that a graph may have several of: `scan`, `scan_front`, `scan_rear`. Several nodes may
/// publish one, and an input that is wired to one may have any name.
pub(crate) const SEVERAL: [&str; 1] = [topic::Scan::NAME];

/// Splits an output into its topic and its suffix: `scan` and `front` for `scan_front`.
pub(crate) fn split(output: &str) -> (&str, &str) {
    let split = SEVERAL.iter().find_map(|topic| {
        let suffix = output.strip_prefix(topic)?.strip_prefix('_')?;
        (!suffix.is_empty()).then(|| (&output[..topic.len()], suffix))
    });
    split
        .filter(|_| !topic::NAMES.contains(&output))
        .unwrap_or((output, ""))
}

/// Adds the errors in ids, ports and wires of the graph to `problems`.
pub(crate) fn check(raw: &RawDataflow, problems: &mut Vec<Problem>) {
    let nodes: Vec<&RawNode> = raw.nodes.value.iter().map(|n| &n.value).collect();
    let mut note = |text: &Text, fault| {
        let place = text.referenced.into();
        problems.push(Problem { place, fault });
    };
    check_ids(&nodes, &mut note);
    check_outputs(&nodes, &mut note);
    for &node in &nodes {
        for (name, source) in node.inputs() {
            let is_free = source.value.split_once('/');
            let is_free = is_free.is_some_and(|(_, output)| SEVERAL.contains(&split(output).0));
            let named = match is_free {
                true => Ok(()),
                false => check_name(&name.value),
            };
            if let Err(fault) = named {
                note(name, fault);
            } else if let Err(fault) =
                check_source(node, (&name.value, is_free), &source.value, &nodes)
            {
                note(source, fault);
            }
        }
    }
}

fn check_ids(nodes: &[&RawNode], note: &mut impl FnMut(&Text, String)) {
    let mut lines = HashMap::new();
    for id in nodes.iter().filter_map(|n| n.id.as_ref()) {
        if let Some(&first) = lines.get(&id.value) {
            let text = &id.value;
            let fault = format!(
                "a second node with the id `{text}`, first used in line {first}; ids are unique"
            );
            note(id, fault);
        } else {
            lines.insert(&id.value, id.referenced.line());
        }
    }
}

fn check_outputs(nodes: &[&RawNode], note: &mut impl FnMut(&Text, String)) {
    let mut senders = HashMap::new();
    for &node in nodes {
        for output in node.outputs() {
            if let Err(fault) = check_output(node, &output.value, &mut senders) {
                note(output, fault);
            }
        }
    }
}

/// `senders` has the last node that publishes each topic.
fn check_output<'a>(
    node: &'a RawNode,
    topic: &'a str,
    senders: &mut HashMap<&'a str, &'a RawNode>,
) -> Result<(), String> {
    check_name(topic)?;
    match senders.insert(topic, node) {
        Some(first) if std::ptr::eq(first, node) => Err(format!(
            "the output `{topic}` is listed a second time; each may be listed once"
        )),
        Some(first) if !SHARED.contains(&topic) && !SEVERAL.contains(&topic) => {
            let first = first.id();
            Err(format!(
                "`{topic}` is already sent by `{first}`, and a topic has one sender in a graph; \
                 remove it from one of them"
            ))
        }
        _ => Ok(()),
    }
}

fn check_name(found: &str) -> Result<(), String> {
    if topic::NAMES.contains(&split(found).0) {
        return Ok(());
    }
    let allowed = topic::NAMES.join(", ");
    Err(format!(
        "there is no topic `{found}`; allowed are {allowed}"
    ))
}

fn check_source(
    node: &RawNode,
    (input, is_free): (&str, bool),
    source: &str,
    nodes: &[&RawNode],
) -> Result<(), String> {
    let parts = source.split_once('/');
    let Some((from, topic)) = parts.filter(|(from, topic)| !from.is_empty() && !topic.is_empty())
    else {
        return Err(format!(
            "the input `{input}` comes from `{source}`; allowed is `node/topic`"
        ));
    };
    if from == node.id() {
        return Err(format!(
            "the input `{input}` of `{from}` comes from `{from}` itself"
        ));
    }
    let Some(sender) = nodes.iter().find(|n| n.id() == from) else {
        let allowed = list(nodes.iter().map(|n| n.id()));
        return Err(format!(
            "the input `{input}` comes from `{from}`, which is no node; the nodes are {allowed}"
        ));
    };
    if !sender.outputs().iter().any(|o| o.value == topic) {
        let allowed = list(sender.outputs().iter().map(|o| o.value.as_str()));
        return Err(format!(
            "the input `{input}` takes `{topic}` from `{from}`, which does not list it; its outputs \
             are {allowed}"
        ));
    }
    if topic != input && !is_free {
        return Err(format!(
            "the input `{input}` takes the topic `{topic}`; nodes find topics by the names of their \
             ports, so write `{topic}: {from}/{topic}`"
        ));
    }
    Ok(())
}

fn list<'a>(items: impl Iterator<Item = &'a str>) -> String {
    let items: Vec<&str> = items.filter(|i| !i.is_empty()).collect();
    if items.is_empty() {
        return "none".to_owned();
    }
    items.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Dataflow, parse};

    fn read(nodes: &[&str]) -> Result<Dataflow, Vec<Problem>> {
        let node = |n: &&str| format!("  - {{path: x, {n}}}\n");
        let nodes: String = nodes.iter().map(node).collect();
        parse(&format!("nodes:\n{nodes}"))
    }

    fn check(nodes: &[&str], expected: &[&str]) {
        let said = read(nodes).unwrap_err();
        assert_eq!(said.len(), expected.len(), "{said:?}");
        for (said, expected) in said.iter().zip(expected) {
            let said = said.to_string();
            assert!(said.starts_with(expected), "{said}\n{expected}");
        }
    }

    #[test]
    fn ids_are_unique() {
        let second = "4:19: a second node with the id `a`";
        check(&["id: a", "id: b", "id: a"], &[second]);
    }

    #[test]
    fn ports_name_topics_once() {
        let (scam, twice) = ("2:32: there is no topic `scam`", "2:44: the output `scan`");
        check(&["id: a, outputs: [scam, scan, scan]"], &[scam, twice]);
        let sender = "id: a, outputs: [votes]";
        let image = "3:31: there is no topic `image`; allowed are scan, odometry";
        check(&[sender, "id: b, inputs: {image: a/votes}"], &[image]);
    }

    #[test]
    fn a_graph_may_have_several_of_some_topics() {
        let text = "nodes:
  - {id: front, path: x, outputs: [scan]}
  - {id: rear, path: x, outputs: [scan]}
  - {id: both, path: x, outputs: [scan_left, scan_right]}
  - {id: a, path: x, inputs: {scan_front: front/scan, any: rear/scan, scan: both/scan_left, x: both/scan_right}}
";
        let graph = parse(text).unwrap();
        let wires = graph.nodes[3].inputs.iter();
        let wires: Vec<_> = wires.map(|i| (&*i.topic, &*i.from, &*i.stream)).collect();
        let expected = [
            ("scan", "front", ""),
            ("scan", "rear", ""),
            ("scan", "both", "left"),
            ("scan", "both", "right"),
        ];
        assert_eq!(wires, expected);
        assert_eq!(graph.nodes[2].outputs, ["scan"]);
        assert_eq!(graph.nodes[2].streams, ["left", "right"]);
        let wrong = text.replace("x: both/scan_right", "votes: front/health");
        let said = parse(&wrong).unwrap_err()[0].to_string();
        assert!(said.contains("does not list it"), "{said}");
        let wrong = text.replace("[scan_left, scan_right]", "[scan_left, scan_left]");
        assert!(parse(&wrong).is_err());
    }

    #[test]
    fn a_topic_has_one_sender() {
        let nodes = ["a", "b"].map(|id| format!("id: {id}, outputs: [votes, health]"));
        let sent = "3:32: `votes` is already sent by `a`";
        check(&[&nodes[0], &nodes[1]], &[sent]);
    }

    #[test]
    fn wires_lead_to_an_output_of_the_same_name() {
        let receiver = |inputs: &str, expected: &str| {
            let receiver = format!("id: b, inputs: {{{inputs}}}");
            check(&["id: a, outputs: [scan, votes]", &receiver], &[expected]);
        };
        receiver("scan: a", "3:37: the input `scan` comes from `a`; allowed");
        receiver("scan: c/scan", "3:37: the input `scan` comes from `c`");
        receiver("health: a/health", "3:39: the input `health` takes");
        receiver("scan: a/votes", "3:37: the input `scan` takes the topic");
        let itself = "2:54: the input `scan` of `a` comes from `a` itself";
        check(
            &["id: a, outputs: [scan], inputs: {scan: a/scan}"],
            &[itself],
        );
    }
}
