//! Tests of the schemas in `docs/schemas`: they are those of the types, and what is written follows
//! them.
//!
//! `BACKCAST_ACCEPT=1 cargo test --release -p backcast --test tools schemas` writes them.

use std::collections::BTreeMap;
use std::fs;

use serde_json::Value;
use tests::schemas::assert_follows;

use crate::drawn::{recordings, run, sound};

#[test]
fn the_schemas_are_those_of_the_types() {
    let made = [
        bench::schemas(),
        evaluation::schemas(),
        launcher::schemas(),
        recording_tools::schemas(),
    ];
    let made = made.concat().into_iter();
    let made: BTreeMap<String, Value> = made
        .map(|(name, schema)| (format!("{name}.json"), schema.to_value()))
        .collect();
    let folder = tests::root().join("docs/schemas");
    if std::env::var_os("BACKCAST_ACCEPT").is_some() {
        fs::create_dir_all(&folder).unwrap();
        for (file, schema) in &made {
            fs::write(folder.join(file), format!("{schema:#}\n")).unwrap();
        }
    }
    let files = fs::read_dir(&folder).unwrap().map(Result::unwrap);
    let found: BTreeMap<String, Value> = files
        .map(|file| {
            let schema = serde_json::from_slice(&fs::read(file.path()).unwrap()).unwrap();
            (file.file_name().into_string().unwrap(), schema)
        })
        .collect();
    let names = |schemas: &BTreeMap<String, Value>| schemas.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&found), names(&made));
    for (file, schema) in made {
        assert_eq!(
            found[&file], schema,
            "docs/schemas/{file} is not of its type"
        );
    }
}

#[test]
fn what_is_printed_follows_the_schemas() {
    let folder = sound();
    let evaluate = "evaluate evaluate evaluate_total";
    let sequence = "evaluate_sequence evaluate_sequence evaluate_sequence_total";
    for (arguments, names) in [
        ("info --json r.mcap", "info"),
        ("doctor --json r.mcap", "doctor"),
        ("locate --json r.mcap", "locate locate"),
        ("locate --json --particles 2 r.mcap", "locate locate"),
        ("evaluate --json r.mcap ./r.mcap", evaluate),
        ("evaluate --sequence --json r.mcap ./r.mcap", sequence),
    ] {
        let (_, stdout, stderr) = run(folder.path(), arguments);
        let (lines, names) = (stdout.lines(), names.split(' '));
        let (found, expected) = (lines.clone().count(), names.clone().count());
        assert_eq!(found, expected, "{arguments}: {stdout}{stderr}");
        lines
            .zip(names)
            .for_each(|(line, name)| assert_follows(name, line));
    }
}

#[test]
fn expectations_follow_the_schema() {
    for case in fs::read_dir(recordings()).unwrap() {
        let file = case.unwrap().path().join("expected.json");
        assert_follows("expected", &fs::read_to_string(file).unwrap());
    }
}
