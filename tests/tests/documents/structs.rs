//! Messages and JSON, compared with the structs that are sent.

use std::collections::BTreeSet;

use syn::parse::ParseBuffer;
use syn::{Attribute, Fields, Item, ItemMacro, ItemStruct, LitStr};
use tests::{markdown, root};

use crate::read;

/// Returns the structs of a file, and of the blocks `message! { … }` in it.
fn structs(file: &str) -> Vec<ItemStruct> {
    let source = syn::parse_file(&read(&root().join(file))).unwrap();
    let items = source.items.into_iter().flat_map(|item| match item {
        Item::Macro(block) if is_message(&block) => {
            block.mac.parse_body::<syn::File>().unwrap().items
        }
        item => vec![item],
    });
    let structs = items.filter_map(|item| match item {
        Item::Struct(item) => Some(item),
        _ => None,
    });
    structs.collect()
}

fn is_message(block: &ItemMacro) -> bool {
    let name = block.mac.path.segments.last();
    name.is_some_and(|name| name.ident == "message")
}

/// Returns the versioned name of a message, from its attribute `type_name("Scan/v1")`.
fn type_name(item: &ItemStruct) -> Option<String> {
    let named = item.attrs.iter().find(|a| a.path().is_ident("type_name"))?;
    Some(named.parse_args::<LitStr>().ok()?.value())
}

/// Returns the words of a field for serde, such as `flatten`, each with its text, as in
/// `#[serde(rename = "type")]`.
fn serde_words(attributes: &[Attribute]) -> Vec<(String, Option<String>)> {
    let mut found = Vec::new();
    for attribute in attributes.iter().filter(|a| a.path().is_ident("serde")) {
        let _ = attribute.parse_nested_meta(|meta| {
            let text = meta.value().and_then(ParseBuffer::parse::<LitStr>);
            let word = meta.path.require_ident()?.to_string();
            found.push((word, text.ok().map(|text| text.value())));
            Ok(())
        });
    }
    found
}

/// Returns the names under which the fields of a struct are sent, without flattened and skipped
/// ones.
fn fields(item: &ItemStruct) -> Vec<String> {
    let Fields::Named(fields) = &item.fields else {
        return Vec::new();
    };
    let sent = fields.named.iter().filter_map(|field| {
        let words = serde_words(&field.attrs);
        if words
            .iter()
            .any(|(word, _)| word == "flatten" || word == "skip")
        {
            return None;
        }
        let renamed = words.into_iter().find(|(word, _)| word == "rename");
        let own = field.ident.as_ref().map(ToString::to_string);
        renamed.and_then(|(_, text)| text).or(own)
    });
    sent.collect()
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

/// Structs that are sent as JSON, with the section that lists their fields; several structs if they
/// are sent as one object.
#[rustfmt::skip]
const JSON: &[(&str, &[(&str, &str)])] = &[
    ("A place", &[("common/answers/src/place.rs", "Place"), ("common/answers/src/place.rs", "Candidate")]),
    ("The answer to a scan", &[("common/answers/src/answer.rs", "ScanAnswer")]),
    ("The tracker's pose", &[("common/answers/src/tracked.rs", "TrackedPose")]),
    ("`locate_server`", &[("nodes/locate_server/src/json.rs", "Answer")]),
    ("`health/json`", &[("nodes/bridge/src/json.rs", "Health")]),
    ("`backcast locate --json`", &[("common/evaluation/src/locate/object.rs", "Object")]),
    ("Votes of a scan", &[("common/evaluation/src/locate/object.rs", "Votes")]),
    ("Beams of a scan", &[("common/evaluation/src/locate/object.rs", "Beams")]),
    ("Particles of a scan", &[("common/evaluation/src/locate/particles.rs", "Particles")]),
    ("`backcast evaluate --json`", &[("common/evaluation/src/evaluate/judge.rs", "Evaluation")]),
    ("Probabilities of a file", &[("common/evaluation/src/trust.rs", "Said")]),
    ("`backcast evaluate --answers --json`", &[("common/evaluation/src/evaluate/answers.rs", "Figures")]),
    ("Answers of another program", &[("common/evaluation/src/evaluate/given.rs", "Line")]),
    ("`backcast evaluate --sequence --json`", &[("common/evaluation/src/sequence/figures.rs", "Figures")]),
    ("`backcast evaluate --sequence --stress --json`", &[("common/evaluation/src/sequence/stress/figures.rs", "Figures")]),
    ("Of a scan", &[("common/answers/src/tracked.rs", "Row")]),
    ("Of the run", &[("common/launcher/src/run/summary.rs", "Summary"), ("common/answers/src/statistics.rs", "Figures")]),
    ("`backcast regress --json`", &[("common/evaluation/src/regression/outcome.rs", "Object")]),
    ("`backcast status --json`", &[("common/launcher/src/run/control.rs", "Status")]),
    ("A node of a graph", &[("common/launcher/src/run/control.rs", "NodeStatus")]),
    ("The recording of a graph", &[("common/launcher/src/run/control.rs", "Recording")]),
    ("`backcast logs --json`", &[("common/launcher/src/control/logs.rs", "LogLine")]),
    ("`backcast info --json`", &[("common/recording_tools/src/info.rs", "Contents")]),
    ("`backcast doctor --json`", &[("common/recording_tools/src/doctor/command.rs", "Report")]),
    ("`backcast bench --json`", &[("common/bench/src/row.rs", "Row")]),
    ("The last pose", &[("nodes/tracker/src/memory.rs", "Remembered")]),
    ("VDA 5050", &[("nodes/ros2_gateway/src/vda5050.rs", "Position")]),
    ("`snapshot`", &[("common/dashboard/src/view.rs", "Snapshot")]),
    ("`map`", &[("common/dashboard/src/view/map.rs", "MapInfo")]),
    ("`answer`", &[("common/dashboard/src/view/answer.rs", "Answer")]),
    ("`pose`", &[("common/dashboard/src/view/tracked.rs", "Tracked")]),
    ("`state`", &[("common/dashboard/src/view/history.rs", "Period")]),
    ("A webhook's object", &[("common/dashboard/src/view/history.rs", "StateChange")]),
    ("`beams`", &[("common/dashboard/src/view/beams.rs", "Beams")]),
    ("`scan`", &[("common/dashboard/src/view/scan.rs", "Scan")]),
    ("`node`", &[("common/dashboard/src/view/roster.rs", "NodeReport")]),
    ("`log`", &[("common/dashboard/src/view/log.rs", "LogLine")]),
    ("`region`", &[("common/dashboard/src/view.rs", "Region")]),
    ("`abilities`", &[("common/dashboard/src/view.rs", "Abilities")]),
    ("`recording`", &[("common/dashboard/src/view.rs", "Recording")]),
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
        // Every object has it, and the document says so once for all.
        sent.remove("schema");
        let listed: BTreeSet<String> = markdown::first_cells(&text, section).into_iter().collect();
        assert_eq!(listed, sent, "section {section} of docs/json.md");
    }
}
