//! `--record`: adds a recorder to a graph, from an executable next to the others. Sources wait for
//! it, so that nothing is missed.

use std::path::{Path, PathBuf};

use anyhow::Context;
use command_line::output;
use dataflow::{Dataflow, Node};

use super::added;
use super::arguments::{MAP_SERVER, PLAYERS, add_to_list, set, value};
use super::options::RecordOptions;
use crate::descriptor::NO_FOLDER;

pub(super) const RECORDER: &str = "recorder";

pub(crate) fn add(
    options: &RecordOptions,
    dataflow: &mut Dataflow,
    file: &Path,
    folder: &Path,
) -> anyhow::Result<()> {
    let Some(output) = &options.record else {
        return Ok(());
    };
    let output = std::path::absolute(output).context(NO_FOLDER)?;
    check(&output, options, dataflow)?;
    let mut node = node(dataflow, file, folder);
    node.build = added::build(dataflow, RECORDER);
    set(&mut node, "--output", Some(&output.to_string_lossy()));
    for (name, value) in options.ending() {
        if value.is_some() {
            set(&mut node, name, value);
        }
    }
    if options.record_field {
        node.args.push("--field".to_owned());
    }
    for source in &mut dataflow.nodes {
        if PLAYERS.contains(&source.executable()) {
            add_to_list(source, "--wait-for", RECORDER);
        }
    }
    dataflow.nodes.push(node);
    Ok(())
}

/// Creates a recorder that is not built; when restarted, it continues in another file.
pub(super) fn node(dataflow: &Dataflow, file: &Path, folder: &Path) -> Node {
    let mut node = added::node(dataflow, RECORDER, Vec::new());
    let attached = attached(dataflow, file, folder).into_iter();
    node.args
        .extend(attached.map(|file| format!("--attach={}", file.display())));
    node
}

fn check(output: &Path, options: &RecordOptions, dataflow: &Dataflow) -> anyhow::Result<()> {
    added::check_new(dataflow, "--record", RECORDER)?;
    let is_whole = options.ending().iter().all(|(_, value)| value.is_none());
    output::prepare(output, options.force || !is_whole)?;
    // The recorder overwrites nothing, and would add a number to the name.
    if is_whole && output.exists() {
        std::fs::remove_file(output)
            .with_context(|| format!("cannot remove {}", output.display()))?;
    }
    Ok(())
}

/// Returns the files to attach: the descriptor, the served map and its image, if they exist.
fn attached(dataflow: &Dataflow, file: &Path, folder: &Path) -> Vec<PathBuf> {
    let server = dataflow.node(MAP_SERVER);
    let map = server.and_then(|server| value(server, "--map"));
    let yaml = map.map(|map| folder.join(map));
    let image = yaml.as_ref().and_then(|yaml| map::image_of(yaml).ok());
    let descriptor = std::path::absolute(file).ok();
    let all = [descriptor, yaml, image].into_iter().flatten();
    all.filter(|file| file.is_file()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing::{options, parsed};

    const GRAPH: &str = "nodes:
  - {id: r, path: bin/replayer, outputs: [scan], args: --wait-for a, build: cargo build --package replayer}
  - {id: a, path: bin/accumulator, build: cargo build --package replayer}
  - {id: o, path: bin/other, build: make}
";

    fn added(line: &str, text: &str, folder: &Path) -> anyhow::Result<Dataflow> {
        let mut dataflow = parsed(text);
        let file = Path::new("g.yaml");
        add(&options(line).record, &mut dataflow, file, folder)?;
        Ok(dataflow)
    }

    #[test]
    fn the_recorder_joins_the_others_and_sources_wait_for_it() {
        let folder = tempfile::TempDir::new().unwrap();
        let output = folder.path().join("no/such/folder/r.mcap");
        let line = format!("--record {} --split-time 10m", output.display());
        let dataflow = added(&line, GRAPH, folder.path()).unwrap();
        let [replayer, accumulator, other, recorder] = &dataflow.nodes[..] else {
            panic!("{dataflow:?}");
        };
        assert_eq!(replayer.args, ["--wait-for=a,recorder"]);
        assert_eq!(&*recorder.path, "bin/recorder");
        assert_eq!(&*recorder.id, "recorder");
        let to = format!("--output={}", output.display());
        assert_eq!(recorder.args, [&to, "--split-time=10m"]);
        assert!(output.parent().unwrap().is_dir());
        let build = "cargo build --package replayer --package recorder";
        for node in [replayer, accumulator, recorder] {
            assert_eq!(node.build[0].to_string(), build);
        }
        assert_eq!(other.build[0].to_string(), "make");
    }

    #[test]
    fn files_and_recorders_that_exist_are_kept() {
        let folder = tempfile::TempDir::new().unwrap();
        let existing = folder.path().join("r.mcap");
        std::fs::write(&existing, "").unwrap();
        let add = |options: &str, text: &str| {
            let line = format!("--record {}{options}", existing.display());
            added(&line, text, folder.path())
        };
        let refused = |options: &str, text: &str, expected: &str| {
            let said = format!("{:#}", add(options, text).unwrap_err());
            assert!(said.contains(expected), "{said}");
        };
        refused("", GRAPH, "r.mcap is there already");
        refused("/s.mcap", GRAPH, "r.mcap/s.mcap: not a directory");
        add(" --force", GRAPH).unwrap();
        assert!(!existing.exists());
        let recorder = "nodes: [{id: x, path: bin/recorder}]";
        refused("", recorder, "has one already");
    }
}
