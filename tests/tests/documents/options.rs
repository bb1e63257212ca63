//! Options and exit codes, generated from `--help`.

use std::process::Command;

use tests::help::{Help, Tables, exit_codes};
use tests::{executables, root};

use crate::read;

/// Line below which a document is generated from `--help`.
const MADE: &str = "<!-- Made of --help by tests/tests/documents; what stands below is \
                    not to be changed by hand. -->\n";

/// Nodes in the order in which a scan passes them; the other nodes follow by name.
const FIRST: [&str; 5] = [
    "lms_reader",
    "map_server",
    "boundary_extractor",
    "accumulator",
    "peak_extractor",
];

/// Nodes that are built only by name: their options are compared if they are there.
const BUILT_BY_NAME: [&str; 5] = [
    "bridge",
    "fleet_monitor",
    "foxglove_server",
    "locate_server",
    "ros2_gateway",
];

/// Returns the help of an executable, or of one of its commands.
fn help(name: &str, command: Option<&str>) -> Help {
    let mut process = Command::new(executables::path(name));
    let output = process.args(command).arg("--help").output().unwrap();
    assert!(output.status.success(), "{name}: {output:?}");
    Help::parse(&String::from_utf8(output.stdout).unwrap())
}

/// Returns the commands of `backcast` except `help`, in the order of its help.
fn commands() -> Vec<String> {
    let mut process = Command::new(executables::path("backcast"));
    let output = process.arg("--help").output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let (_, commands) = text.split_once("Commands:\n").unwrap();
    let names = commands.lines().take_while(|line| !line.is_empty());
    let names = names.filter_map(|line| line.split_whitespace().next());
    let names = names.filter(|name| *name != "help");
    names.map(str::to_owned).collect()
}

fn nodes() -> Vec<String> {
    let folders = std::fs::read_dir(root().join("nodes")).unwrap();
    let names = folders.map(|folder| folder.unwrap().file_name().into_string().unwrap());
    let place = |name: &String| {
        let first = FIRST.iter().position(|other| other == name);
        first.unwrap_or(FIRST.len())
    };
    let mut nodes: Vec<String> = names.filter(|name| name != "backcast").collect();
    nodes.sort_by_key(|name| (place(name), name.clone()));
    nodes
}

/// Compares the text generated from `--help` with a document, or writes it there.
fn compare(document: &str, made: &str) {
    let path = root().join(document);
    let text = read(&path);
    let (before, found) = text.split_once(MADE).unwrap();
    if std::env::var_os("BACKCAST_ACCEPT").is_some() {
        std::fs::write(&path, format!("{before}{MADE}\n{made}")).unwrap();
        return;
    }
    let found: Vec<&str> = found.trim().lines().collect();
    let made: Vec<&str> = made.trim().lines().collect();
    let differs = |lines: &[&str], other: &[&str]| -> Vec<String> {
        let lines = lines.iter().filter(|line| !other.contains(line));
        lines.map(|line| (*line).to_owned()).collect()
    };
    assert!(
        found == made,
        "{document} lists what is not there: {:#?}, and not what is: {:#?}. Write it anew: \
         BACKCAST_ACCEPT=1 cargo test --release -p tests --test documents",
        differs(&found, &made),
        differs(&made, &found)
    );
}

#[test]
fn options_are_those_of_the_executables() {
    let nodes = nodes();
    let is_built = |name: &&String| executables::path(name).exists();
    let missing: Vec<&String> = nodes.iter().filter(|name| !is_built(name)).collect();
    let by_name = |name: &&String| BUILT_BY_NAME.contains(&name.as_str());
    assert!(missing.iter().all(by_name), "{missing:?}");
    if !missing.is_empty() {
        // The sections of the other nodes refer to options of theirs.
        eprintln!("options are not compared: not built are {missing:?}");
        return;
    }
    let mut tables = Tables::default();
    let mut made = String::new();
    made += "## Nodes\n\n";
    for node in &nodes {
        made += &tables.section(3, node, &help(node, None));
        made += "\n";
    }
    made += "## Commands\n\n";
    for command in commands() {
        let name = format!("backcast {command}");
        made += &tables.section(3, &name, &help("backcast", Some(&command)));
        made += "\n";
    }
    compare("docs/parameters.md", &format!("{}\n", made.trim()));
}

#[test]
fn exit_codes_are_those_of_the_commands() {
    let commands = commands();
    let helps = commands.iter().map(|name| help("backcast", Some(name)));
    let helps: Vec<Help> = helps.collect();
    let names = commands.iter().map(String::as_str);
    compare("docs/exit_codes.md", &exit_codes(names.zip(&helps)));
}
