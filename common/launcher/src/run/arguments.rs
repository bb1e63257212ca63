//! Finds, reads and replaces arguments of nodes in a descriptor.

use std::path::Path;

use command_line::wrong_use;
use dataflow::{Dataflow, Node};

pub const REPLAYER: &str = "replayer";
pub const EMULATOR: &str = "emulator";
/// Nodes that take --recording, --rate, --loop and --wait-for.
pub const PLAYERS: [&str; 2] = [REPLAYER, EMULATOR];
pub const ACCUMULATOR: &str = "accumulator";
pub const TRACKER: &str = "tracker";
pub const MAP_SERVER: &str = "map_server";

const MONITOR: &str = "monitor";

pub fn leave_out_monitors(dataflow: &mut Dataflow) {
    dataflow.nodes.retain(|node| node.executable() != MONITOR);
}

/// Sets `--robot` of each monitor to the graph's name, unless the descriptor sets it.
pub fn name_robot(dataflow: &mut Dataflow, graph: &str) {
    let nodes = dataflow.nodes.iter_mut();
    for monitor in nodes.filter(|node| node.executable() == MONITOR) {
        if value(monitor, "--robot").is_none() {
            set(monitor, "--robot", Some(graph));
        }
    }
}

/// Returns the first node with one of these executables. `option` and `file` are named in errors.
pub fn find<'d>(
    dataflow: &'d mut Dataflow,
    executables: &[&'static str],
    option: &'static str,
    file: &Path,
) -> anyhow::Result<&'d mut Node> {
    let nodes = &mut dataflow.nodes;
    let is_meant = |node: &Node| executables.contains(&node.executable());
    let Some(at) = nodes.iter().position(is_meant) else {
        let found: Vec<&str> = nodes.iter().map(Node::executable).collect();
        let (executable, found) = (executables.join(" or "), found.join(", "));
        return Err(wrong_use(format!(
            "{option} is for the {executable}, but no node in {} has a path that ends so; \
             its executables are {found}",
            file.display()
        )));
    };
    Ok(&mut nodes[at])
}

pub fn set(node: &mut Node, option: &str, value: Option<&str>) {
    unset(node, option, value.is_some());
    // With `=`, a negative number is not parsed as an option.
    let argument = value.map_or(option.to_owned(), |value| format!("{option}={value}"));
    node.args.push(argument);
}

/// Removes `--option`, `--option value` and `--option=value`.
pub fn unset(node: &mut Node, option: &str, takes_value: bool) {
    let mut kept = Vec::with_capacity(node.args.len());
    let mut args = std::mem::take(&mut node.args).into_iter();
    while let Some(arg) = args.next() {
        let rest = arg.strip_prefix(option);
        let joined = rest.is_some_and(|rest| rest.starts_with('='));
        if arg == option && takes_value {
            args.next();
        } else if arg != option && !joined {
            kept.push(arg);
        }
    }
    node.args = kept;
}

/// Returns the last value of an option, given as `--option value` or `--option=value`.
pub fn value<'n>(node: &'n Node, option: &str) -> Option<&'n str> {
    let after = |words: &'n [String]| (words[0] == option).then_some(words.get(1)).flatten();
    let joined = |word: &'n String| word.strip_prefix(option)?.strip_prefix('=');
    let mut found = (0..node.args.len()).filter_map(|at| {
        let words = node.args.get(at..)?;
        joined(words.first()?).or_else(|| after(words).map(String::as_str))
    });
    found.next_back()
}

/// Adds a word to an option with a comma-separated list, unless the list has it.
pub fn add_to_list(node: &mut Node, option: &str, word: &str) {
    let list = match value(node, option) {
        Some(list) if list.split(',').any(|other| other == word) => return,
        Some(list) if !list.is_empty() => format!("{list},{word}"),
        _ => word.to_owned(),
    };
    set(node, option, Some(&list));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing::parsed;

    fn node(args: &str) -> Node {
        let text = format!("nodes:\n  - {{id: r, path: bin/replayer, args: \"{args}\"}}\n");
        parsed(&text).nodes.remove(0)
    }

    #[test]
    fn values_stand_behind_a_space_or_an_equals_sign() {
        for (args, expected) in [
            ("--rate max", Some("max")),
            ("x --rate=2 y", Some("2")),
            ("--rate 1 --rate=3", Some("3")),
            ("--rated=1 rate 2", None),
            ("--rate", None),
            ("", None),
        ] {
            assert_eq!(value(&node(args), "--rate"), expected, "{args}");
        }
    }

    #[test]
    fn a_page_names_its_robot_as_the_graph_unless_it_has_a_name() {
        let text = "nodes: [{id: p, path: bin/monitor}, {id: q, path: monitor, args: --robot r7},
            {id: a, path: bin/accumulator}]";
        let mut dataflow = parsed(text);
        name_robot(&mut dataflow, "hall");
        let args: Vec<_> = dataflow.nodes.iter().map(|node| &node.args[..]).collect();
        assert_eq!(args[0], ["--robot=hall"]);
        assert_eq!(args[1], ["--robot", "r7"]);
        assert!(args[2].is_empty());
    }
}
