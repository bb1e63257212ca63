//! What the documents say that a program can compare with the code: links, the list of
//! the book, options, exit codes, messages and JSON.
//!
//! Tables of options and exit codes are written from `--help`:
//! `BACKCAST_ACCEPT=1 cargo test --release -p tests --test documents`.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use syn::punctuated::Punctuated;
use syn::{Attribute, Fields, Item, ItemStruct, LitStr, Meta, Token};
use tests::help::{Help, Tables, exit_codes};
use tests::{executables, markdown, root};

/// Beside those in `docs`.
const OTHERS: [&str; 5] = [
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "README.md",
    "SECURITY.md",
    "packaging/python/README.md",
];

/// Below this line, a document is made of `--help`.
const MADE: &str = "<!-- Made of --help by tests/tests/documents.rs; what stands below is \
                    not to be changed by hand. -->\n";

/// In the order in which a scan goes through them; the other nodes follow by name.
const FIRST: [&str; 5] = [
    "lms_reader",
    "map_server",
    "boundary_extractor",
    "accumulator",
    "peak_extractor",
];

/// These are built by those who name them: they are looked at where they were.
const BUILT_BY_NAME: [&str; 5] = [
    "bridge",
    "fleet_monitor",
    "foxglove_server",
    "locate_server",
    "ros2_gateway",
];

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// All documents below `docs`, from the root.
fn documents() -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    let mut folders = vec![PathBuf::from("docs")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root().join(&folder)).unwrap() {
            let name = entry.unwrap().file_name();
            let path = folder.join(name);
            if root().join(&path).is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                found.insert(path);
            }
        }
    }
    found
}

fn all() -> BTreeSet<PathBuf> {
    let others = OTHERS.map(PathBuf::from);
    documents().into_iter().chain(others).collect()
}

/// The links of a document to files of the repository, from the root, each with its
/// anchor, empty where it has none.
fn links_of(document: &Path) -> Vec<(PathBuf, String)> {
    let text = read(&root().join(document));
    let outside = |link: &String| link.contains("://") || link.starts_with("mailto:");
    let links = markdown::links(&text).into_iter();
    links
        .filter(|link| !outside(link))
        .map(|link| {
            let (file, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let folder = document.parent().unwrap();
            let file = match file {
                "" => document.to_owned(),
                file => plain(&folder.join(file)),
            };
            (file, anchor.to_owned())
        })
        .collect()
}

/// Without `..`; one that leads out of the repository stays.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if plain.parent().is_some() => _ = plain.pop(),
            part => plain.push(part),
        }
    }
    plain
}

#[test]
fn every_document_stands_in_the_book_once() {
    let summary = Path::new("docs/SUMMARY.md");
    let listed: Vec<PathBuf> = links_of(summary)
        .into_iter()
        .map(|(file, _)| file)
        .collect();
    let once: BTreeSet<PathBuf> = listed.iter().cloned().collect();
    assert_eq!(listed.len(), once.len(), "one is listed twice");
    let mut expected = documents();
    expected.remove(summary);
    assert_eq!(once, expected);
}

#[test]
fn every_link_leads_somewhere() {
    let mut anchors: BTreeMap<PathBuf, Vec<String>> = BTreeMap::new();
    let mut broken = Vec::new();
    let mut count = 0;
    for document in all() {
        for (file, anchor) in links_of(&document) {
            count += 1;
            let path = root().join(&file);
            let known = match path.exists() {
                true if anchor.is_empty() => true,
                true => anchors
                    .entry(file.clone())
                    .or_insert_with(|| markdown::anchors(&read(&path)))
                    .contains(&anchor),
                false => false,
            };
            if !known {
                broken.push(format!(
                    "{}: {}#{anchor}",
                    document.display(),
                    file.display()
                ));
            }
        }
    }
    assert!(count > 100, "{count}");
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn every_document_is_reached_from_the_readme() {
    let mut reached = BTreeSet::from([PathBuf::from("README.md")]);
    let mut left = vec![PathBuf::from("README.md")];
    while let Some(document) = left.pop() {
        for (file, _) in links_of(&document) {
            let is_document = file.extension().is_some_and(|ending| ending == "md");
            let is_there = root().join(&file).is_file();
            if is_document && is_there && reached.insert(file.clone()) {
                left.push(file);
            }
        }
    }
    let mut expected = documents();
    expected.remove(Path::new("docs/SUMMARY.md"));
    let missed: Vec<_> = expected.difference(&reached).collect();
    assert!(missed.is_empty(), "{missed:?}");
}

/// What an executable says of itself, or one of its commands.
fn help(name: &str, command: Option<&str>) -> Help {
    let mut process = Command::new(executables::path(name));
    let output = process.args(command).arg("--help").output().unwrap();
    assert!(output.status.success(), "{name}: {output:?}");
    Help::parse(&String::from_utf8(output.stdout).unwrap())
}

/// The commands of `backcast` but `help`, in the order of its help.
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

/// Compares what is made of `--help` with what stands in a document, or writes it there.
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
        // Their sections stand between others, which name options of theirs.
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

/// The structs of a source, by name.
fn structs(file: &str) -> Vec<ItemStruct> {
    let source = syn::parse_file(&read(&root().join(file))).unwrap();
    let structs = source.items.into_iter().filter_map(|item| match item {
        Item::Struct(item) => Some(item),
        _ => None,
    });
    structs.collect()
}

/// The versioned name of a message, as `type_name("Scan/v1")` beside its derivation.
fn type_name(item: &ItemStruct) -> Option<String> {
    let attribute = item.attrs.iter().find(|a| a.path().is_ident("cfg_attr"))?;
    let parts = attribute.parse_args_with(Punctuated::<Meta, Token![,]>::parse_terminated);
    let parts = parts.ok()?.into_iter();
    let mut lists = parts.filter_map(|part| part.require_list().ok().cloned());
    let named = lists.find(|list| list.path.is_ident("type_name"))?;
    Some(named.parse_args::<LitStr>().ok()?.value())
}

/// The name that serde gives a field, as `#[serde(rename = "type")]`.
fn renamed(attributes: &[Attribute]) -> Option<String> {
    let attribute = attributes.iter().find(|a| a.path().is_ident("serde"))?;
    let mut found = None;
    // What is not `rename = "text"` has no text to be found.
    let _ = attribute.parse_nested_meta(|meta| {
        if meta.path.is_ident("rename") {
            let text: LitStr = meta.value()?.parse()?;
            found = Some(text.value());
        }
        Ok(())
    });
    found
}

/// Whether serde has this word for the field, as `flatten` or `skip`.
fn has_word(attributes: &[Attribute], word: &str) -> bool {
    let mut found = false;
    for attribute in attributes.iter().filter(|a| a.path().is_ident("serde")) {
        // What stands behind the word is of another one.
        let _ = attribute.parse_nested_meta(|meta| {
            found |= meta.path.is_ident(word);
            Ok(())
        });
    }
    found
}

/// The names under which the fields of a struct are sent, those that are flattened or
/// skipped left out.
fn fields(item: &ItemStruct) -> Vec<String> {
    let Fields::Named(fields) = &item.fields else {
        return Vec::new();
    };
    let sent = fields.named.iter();
    let sent = sent.filter(|f| !has_word(&f.attrs, "flatten") && !has_word(&f.attrs, "skip"));
    sent.map(|field| {
        renamed(&field.attrs).unwrap_or_else(|| field.ident.as_ref().unwrap().to_string())
    })
    .collect()
}

#[test]
fn every_message_has_its_table() {
    let text = read(&root().join("docs/topics.md"));
    let topics = markdown::first_cells(&text, "All topics");
    let expected: Vec<&str> = messages::topic::NAMES.to_vec();
    let sorted = |names: &[&str]| names.iter().map(|&n| n.to_owned()).collect::<BTreeSet<_>>();
    assert_eq!(
        topics.into_iter().collect::<BTreeSet<_>>(),
        sorted(&expected)
    );
    let mut count = 0;
    for entry in std::fs::read_dir(root().join("common/messages/src")).unwrap() {
        let file = entry.unwrap().file_name().into_string().unwrap();
        for item in structs(&format!("common/messages/src/{file}")) {
            let Some(name) = type_name(&item) else {
                continue;
            };
            let found = markdown::first_cells(&text, &format!("`{name}`"));
            assert_eq!(found, fields(&item), "{name} in docs/topics.md");
            count += 1;
        }
    }
    assert!(count > 20, "{count}");
}

/// The structs that are sent as JSON, each with the section that has its fields: those of
/// several structs where they are sent as one object.
const JSON: &[(&str, &[(&str, &str)])] = &[
    (
        "`backcast locate --json`",
        &[("common/evaluation/src/locate/object.rs", "Object")],
    ),
    (
        "Votes of a scan",
        &[("common/evaluation/src/locate/object.rs", "Votes")],
    ),
    (
        "Beams of a scan",
        &[("common/evaluation/src/locate/object.rs", "Beams")],
    ),
    (
        "Places of a scan",
        &[("common/evaluation/src/locate/object.rs", "Hypothesis")],
    ),
    (
        "Particles of a scan",
        &[("common/evaluation/src/locate/particles.rs", "Particles")],
    ),
    (
        "`backcast evaluate --json`",
        &[("common/evaluation/src/evaluate/judge.rs", "Evaluation")],
    ),
    (
        "Probabilities of a file",
        &[("common/evaluation/src/evaluate/trust.rs", "Said")],
    ),
    (
        "`backcast evaluate --sequence --json`",
        &[("common/evaluation/src/sequence/figures.rs", "Figures")],
    ),
    (
        "Of the single scan",
        &[("common/pose_table/src/line.rs", "Line")],
    ),
    (
        "Of the tracker",
        &[("common/pose_table/src/pose_line.rs", "PoseLine")],
    ),
    (
        "Of the run",
        &[
            ("common/launcher/src/run/summary.rs", "Summary"),
            ("common/statistics/src/lib.rs", "Figures"),
        ],
    ),
    (
        "`backcast status --json`",
        &[("common/launcher/src/run/control.rs", "Status")],
    ),
    (
        "A node of a graph",
        &[("common/launcher/src/run/control.rs", "NodeStatus")],
    ),
    (
        "`backcast logs --json`",
        &[("common/launcher/src/control/logs.rs", "LogLine")],
    ),
    (
        "`backcast info --json`",
        &[("common/recording_tools/src/info/contents.rs", "Contents")],
    ),
    (
        "`backcast doctor --json`",
        &[("common/recording_tools/src/doctor/command.rs", "Report")],
    ),
    (
        "`backcast soak --json`",
        &[
            ("common/soak/src/report.rs", "Report"),
            ("common/soak/src/tally.rs", "PoseFigures"),
            ("common/soak/src/launched.rs", "Losses"),
        ],
    ),
    (
        "`backcast bench --json`",
        &[("common/bench/src/row.rs", "Row")],
    ),
    (
        "The last pose",
        &[("nodes/tracker/src/memory.rs", "Remembered")],
    ),
    (
        "`snapshot`",
        &[("common/dashboard/src/view.rs", "Snapshot")],
    ),
    ("`map`", &[("common/dashboard/src/view/map.rs", "MapInfo")]),
    (
        "`answer`",
        &[("common/dashboard/src/view/answer.rs", "Answer")],
    ),
    (
        "A place",
        &[("common/dashboard/src/view/answer.rs", "Place")],
    ),
    ("An ellipse", &[("common/dashboard/src/view.rs", "Ellipse")]),
    (
        "`pose`",
        &[("common/dashboard/src/view/tracked.rs", "Tracked")],
    ),
    (
        "`state`",
        &[("common/dashboard/src/view/history.rs", "Period")],
    ),
    (
        "`beams`",
        &[("common/dashboard/src/view/beams.rs", "Beams")],
    ),
    (
        "`node`",
        &[("common/dashboard/src/view/roster.rs", "NodeReport")],
    ),
    ("`log`", &[("common/dashboard/src/view/log.rs", "LogLine")]),
    ("`region`", &[("common/dashboard/src/view.rs", "Region")]),
    (
        "`abilities`",
        &[("common/dashboard/src/robot.rs", "Abilities")],
    ),
    ("`field`", &[("common/dashboard/src/view/field.rs", "Head")]),
];

#[test]
fn every_object_in_json_has_its_table() {
    let text = read(&root().join("docs/json.md"));
    for (section, sources) in JSON {
        let mut sent = BTreeSet::new();
        for (file, name) in *sources {
            let structs = structs(file);
            let item = structs.iter().find(|item| item.ident == name);
            let item = item.unwrap_or_else(|| panic!("{file} has no struct {name}"));
            sent.extend(fields(item));
        }
        // Every object has it, and the document says so once.
        sent.remove("schema");
        let listed: BTreeSet<String> = markdown::first_cells(&text, section).into_iter().collect();
        assert_eq!(listed, sent, "section {section} of docs/json.md");
    }
}
