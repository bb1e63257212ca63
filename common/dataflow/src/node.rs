//! Converts the entries of the file to checked nodes, each on its own.

use serde_saphyr::Spanned;

use crate::raw::{RawDataflow, RawNode, Text};
use crate::wiring::{SEVERAL, split};
use crate::{
    Dataflow, Input, MAX_ID_BYTES, MAX_NODES, Node, Place, Problem, Restart, RestartPolicy, scalar,
    words,
};

/// Reads all nodes and adds their errors to `problems`.
pub(crate) fn read_all(raw: &RawDataflow, source: &str, problems: &mut Vec<Problem>) -> Dataflow {
    let found = raw.nodes.value.len();
    let mut list_fault = |fault| {
        let place = raw.nodes.referenced.into();
        problems.push(Problem { place, fault });
    };
    if found == 0 {
        list_fault("the list of nodes is empty; a graph has at least one".to_owned());
    }
    if found > MAX_NODES {
        list_fault(format!("{found} nodes; at most {MAX_NODES} are allowed"));
    }
    let mut reader = Reader { source, problems };
    let nodes = raw.nodes.value.iter().map(|n| reader.node(n)).collect();
    Dataflow { nodes }
}

/// Reads the keys one by one and notes errors; after one it continues with the default.
struct Reader<'a> {
    source: &'a str,
    problems: &'a mut Vec<Problem>,
}

impl Reader<'_> {
    fn node(&mut self, raw: &Spanned<RawNode>) -> Node {
        let place = Place::from(raw.referenced);
        let node = &raw.value;
        let id = self.required(node.id.as_ref(), "id", place, check_id);
        let path = self.required(node.path.as_ref(), "path", place, check_path);
        Node {
            id: id.to_owned(),
            path: path.to_owned(),
            path_place: node.path.as_ref().map_or(place, place_of),
            args: self.optional(node.args.as_ref(), |t| words::split_args(&t.value)),
            env: self.env(node),
            build: self.optional(node.build.as_ref(), |t| words::split_build(&t.value)),
            inputs: node.inputs().iter().filter_map(read_input).collect(),
            outputs: outputs(node),
            streams: streams(node),
            restart: self.restart(node),
        }
    }

    fn required<'t>(
        &mut self,
        text: Option<&'t Text>,
        key: &'static str,
        node: Place,
        check: fn(&str) -> Result<(), String>,
    ) -> &'t str {
        let Some(text) = text else {
            self.note(node, format!("`{key}` is missing"));
            return "";
        };
        if let Err(fault) = check(&text.value) {
            self.note(place_of(text), fault);
        }
        &text.value
    }

    fn optional<T: Default>(
        &mut self,
        text: Option<&Text>,
        read: impl FnOnce(&Text) -> Result<T, String>,
    ) -> T {
        let Some(text) = text else {
            return T::default();
        };
        read(text).unwrap_or_else(|fault| {
            self.note(place_of(text), fault);
            T::default()
        })
    }

    fn env(&mut self, node: &RawNode) -> Vec<(String, String)> {
        let entries = node.env.as_ref().map_or(&[][..], |env| &env.value.0);
        let mut env = Vec::new();
        for (name, value) in entries {
            if name.value.is_empty() || name.value.contains(['=', '\0']) {
                let found = &name.value;
                let fault = format!(
                    "`{found}` cannot name an environment variable; allowed is a text without `=`"
                );
                self.note(place_of(name), fault);
            }
            let source = self.source;
            let read = self.optional(Some(value), |v| scalar::read_env_value(v, source));
            env.push((name.value.clone(), read));
        }
        env
    }

    fn restart(&mut self, node: &RawNode) -> Restart {
        let source = self.source;
        let policy = self
            .optional(node.restart_policy.as_ref(), |t| read_policy(t).map(Some))
            .unwrap_or(RestartPolicy::Never);
        let max_restarts = self.optional(node.max_restarts.as_ref(), |t| {
            scalar::read_count(t, source)
        });
        let keys = [
            ("restart_delay", node.restart_delay.as_ref()),
            ("max_restart_delay", node.max_restart_delay.as_ref()),
            ("restart_window", node.restart_window.as_ref()),
            ("health_check_timeout", node.health_check_timeout.as_ref()),
        ];
        let [delay, max_delay, window, health_timeout] = keys.map(|(key, text)| {
            self.optional(text, |t| scalar::read_seconds(key, t, source).map(Some))
        });
        let delay = delay.unwrap_or(Restart::DEFAULT.delay);
        if policy == RestartPolicy::Never {
            self.note_unused("max_restarts", node.max_restarts.as_ref());
            for (key, text) in keys {
                self.note_unused(key, text);
            }
        }
        Restart {
            policy,
            max_restarts,
            delay,
            // A long delay raises the default maximum.
            max_delay: max_delay.unwrap_or(Restart::DEFAULT.max_delay.max(delay)),
            window: window.unwrap_or(Restart::DEFAULT.window),
            health_timeout: health_timeout.unwrap_or(Restart::DEFAULT.health_timeout),
        }
    }

    fn note_unused(&mut self, key: &str, value: Option<&Text>) {
        if let Some(text) = value {
            let fault = format!(
                "`{key}` without a `restart_policy` of on-failure or always: the node is never restarted"
            );
            self.note(place_of(text), fault);
        }
    }

    fn note(&mut self, place: Place, fault: String) {
        self.problems.push(Problem { place, fault });
    }
}

fn place_of(text: &Text) -> Place {
    text.referenced.into()
}

fn check_id(id: &str) -> Result<(), String> {
    let allowed = |b: u8| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'.' | b'-');
    let good = (1..=MAX_ID_BYTES).contains(&id.len()) && id.bytes().all(allowed) && id != "dora";
    good.then_some(()).ok_or_else(|| {
        let found: String = id.chars().take(2 * MAX_ID_BYTES).collect();
        format!(
            "`{found}` cannot be a node's id; allowed are 1 to {MAX_ID_BYTES} of a-z A-Z 0-9 _ . - \
             except the reserved `dora`"
        )
    })
}

fn check_path(path: &str) -> Result<(), String> {
    let why = match path {
        "" => "it is empty",
        "dynamic" | "shell" => "dora reads it as a kind of node",
        p if p.contains("://") => "dora would download it",
        p if p.contains(['$', '\0']) => "dora puts a variable in place of `$`",
        p if p.ends_with(".py") => "dora would run it with Python",
        p if p.ends_with('/') => "it names a folder",
        _ => return Ok(()),
    };
    Err(format!(
        "`{path}` cannot be a path: {why}; allowed is a file, absolute or from the descriptor's folder"
    ))
}

fn read_policy(text: &Text) -> Result<RestartPolicy, String> {
    match text.value.as_str() {
        "never" => Ok(RestartPolicy::Never),
        "on-failure" => Ok(RestartPolicy::OnFailure),
        "always" => Ok(RestartPolicy::Always),
        found => Err(format!(
            "unknown restart_policy `{found}`; allowed are never, on-failure and always"
        )),
    }
}

/// Reads `topic: node/topic`; errors are reported by the wiring check.
fn read_input((name, source): &(Text, Text)) -> Option<Input> {
    let (from, output) = source.value.split_once('/')?;
    let (topic, stream) = match split(output) {
        (topic, stream) if SEVERAL.contains(&topic) => (topic, stream),
        _ => (&*name.value, ""),
    };
    Some(Input {
        topic: topic.to_owned(),
        from: from.to_owned(),
        stream: stream.to_owned(),
    })
}

fn outputs(node: &RawNode) -> Vec<String> {
    let mut outputs: Vec<String> = Vec::new();
    for output in node.outputs() {
        let (topic, _) = split(&output.value);
        if !outputs.iter().any(|known| known == topic) {
            outputs.push(topic.to_owned());
        }
    }
    outputs
}

fn streams(node: &RawNode) -> Vec<String> {
    let streams = node.outputs().iter().map(|o| split(&o.value).1);
    let streams = streams.filter(|stream| !stream.is_empty());
    streams.map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::parse;

    fn faults(text: &str) -> Vec<String> {
        let problems = parse(text).err().unwrap_or_default();
        problems.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_node_has_time_to_report() {
        let text = "nodes: [{id: a, path: a, restart_policy: always, health_check_timeout: 0}]";
        let found = faults(text);
        assert!(found[0].contains("seconds from 2 to 3600"), "{found:?}");
    }

    #[test]
    fn every_key_is_read() {
        let text = "
nodes:
  - id: replayer
    path: target/release/replayer
    args: >-
      --recording 'my file.mcap'
      --rate max
    env: { RUST_LOG: debug, N: 3 }
    build: cargo build --release -p replayer
    restart_policy: on-failure
    max_restarts: 3
    restart_delay: 0.5
    max_restart_delay: 4
    restart_window: 90
    health_check_timeout: 2.5
";
        let node = parse(text).unwrap().nodes.remove(0);
        assert_eq!(node.id, "replayer");
        assert_eq!(node.path, "target/release/replayer");
        assert_eq!(node.path_place.to_string(), "4:11");
        assert_eq!(node.args, ["--recording", "my file.mcap", "--rate", "max"]);
        assert_eq!(node.env[0], ("RUST_LOG".to_owned(), "debug".to_owned()));
        assert_eq!(node.env[1], ("N".to_owned(), "3".to_owned()));
        let build = "cargo build --release -p replayer";
        assert_eq!(node.build[0].to_string(), build);
        assert_eq!(node.restart.policy, RestartPolicy::OnFailure);
        assert_eq!(node.restart.max_restarts, 3);
        assert_eq!(node.restart.delay, Duration::from_millis(500));
        assert_eq!(node.restart.max_delay, Duration::from_secs(4));
        assert_eq!(node.restart.window, Duration::from_secs(90));
        assert_eq!(node.restart.health_timeout, Duration::from_millis(2500));
    }

    #[test]
    fn a_long_delay_is_not_cut_short_by_the_default() {
        let text = "nodes: [{id: a, path: x, restart_policy: always, restart_delay: 3600}]";
        let node = parse(text).unwrap().nodes.remove(0);
        assert_eq!(node.restart.max_delay, node.restart.delay);
    }

    #[test]
    fn all_problems_are_reported_in_the_order_of_the_file() {
        let said = faults(
            "nodes:\n  - path: ''\n    args: \"it's\"\n  - id: a b\n    restart_policy: on_failure\n\
             \x20   build: echo 'x'\n    env: {A=B: 1}\n",
        );
        let expected = [
            "2:5: `id` is missing",
            "2:11: `` cannot be a path: it is empty",
            "3:11: `args` cannot be split in words",
            "4:5: `path` is missing",
            "4:9: `a b` cannot be a node's id",
            "5:21: unknown restart_policy `on_failure`",
            "6:12: the build line `echo 'x'` holds one of",
            "7:11: `A=B` cannot name an environment variable",
        ];
        assert_eq!(said.len(), expected.len(), "{said:#?}");
        for (said, expected) in said.iter().zip(expected) {
            assert!(said.starts_with(expected), "{said}\n{expected}");
        }
    }

    #[test]
    fn ids_are_short_and_plain() {
        for good in ["a", "A-1_b.c", &"x".repeat(32)] {
            assert_eq!(check_id(good), Ok(()));
        }
        for bad in ["", "a b", "a/b", "ä", "dora", &"x".repeat(33)] {
            assert!(check_id(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn paths_are_nothing_but_paths() {
        for good in ["x", "./x", "/bin/sh", "target/release/x", "../y.sh"] {
            assert_eq!(check_path(good), Ok(()));
        }
        for bad in " dynamic shell https://x.org/y $HOME/x x.py x/".split(' ') {
            assert!(check_path(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn limits_of_restarting_need_a_policy() {
        let said = faults("nodes: [{id: a, path: x, max_restarts: 2, restart_delay: 1}]");
        assert_eq!(said.len(), 2);
        assert!(said[0].starts_with("1:40: `max_restarts` without a `restart_policy`"));
        assert!(said[1].starts_with("1:58: `restart_delay` without a `restart_policy`"));
        let never = faults("nodes: [{id: a, path: x, restart_policy: never, max_restarts: 2}]");
        assert_eq!(never.len(), 1);
    }

    #[test]
    fn a_graph_has_some_nodes_but_not_too_many() {
        assert!(faults("nodes: []")[0].contains("at least one"));
        let graph = |n: usize| {
            let node = |i| format!("  - {{id: n{i}, path: x}}\n");
            format!("nodes:\n{}", (0..n).map(node).collect::<String>())
        };
        assert_eq!(faults(&graph(64)), [""; 0]);
        let many = "2:3: 65 nodes; at most 64 are allowed";
        assert_eq!(faults(&graph(65)), [many]);
    }
}
