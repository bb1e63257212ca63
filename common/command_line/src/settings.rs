//! The file of the settings that several nodes share. Its keys are options with `_` for `-`; a node
//! takes its own, and an option on the command line wins.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use clap::{CommandFactory, Parser};
use serde::Deserialize;

/// Settings by which accumulator and tracker read scans.
pub const READING_KEYS: [&str; 6] = [
    "scans",
    "odometry_delay_s",
    "scan_stamp",
    "deskew",
    "max_beams",
    "beam_arc_m",
];

/// Settings by which peak_extractor and tracker compare scans with the map.
pub const FIT_KEYS: [&str; 5] = [
    "fit_sigma_m",
    "fit_sigma_cells",
    "through_penalty",
    "unknown_score",
    "drawn_doubt",
];

/// The option of a node for the shared settings.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct SettingsFile {
    /// File of the settings that accumulator, peak_extractor and tracker share, as YAML; its keys
    /// are names of their options, as in `max_beams: 90`. Options on the command line win.
    #[arg(long, value_name = "FILE")]
    pub settings: Option<PathBuf>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Value {
    Flag(bool),
    Number(f64),
    Text(String),
    List(Vec<String>),
}

/// Reads the settings of a file by key; all must be known, and scalars or lists.
pub fn read(file: &Path) -> anyhow::Result<BTreeMap<String, String>> {
    let path = file.display();
    let text = fs::read_to_string(file).with_context(|| format!("cannot read {path}"))?;
    let values: Option<BTreeMap<String, Value>> = serde_saphyr::from_str(&text)
        .map_err(|error| anyhow!("{path}: {}", error.to_string().trim_end()))?;
    let values = values.unwrap_or_default();
    if let Some(key) = values.keys().find(|key| !is_shared(key)) {
        let allowed = [&READING_KEYS[..], &FIT_KEYS].concat().join(", ");
        bail!("{path}: {key} is not a setting that nodes share: allowed are {allowed}");
    }
    let text = |value| match value {
        Value::Flag(flag) => flag.to_string(),
        Value::Number(number) => number.to_string(),
        Value::Text(text) => text,
        Value::List(texts) => texts.join(","),
    };
    Ok(values
        .into_iter()
        .map(|(key, value)| (key, text(value)))
        .collect())
}

fn is_shared(key: &str) -> bool {
    READING_KEYS.contains(&key) || FIT_KEYS.contains(&key)
}

/// Parses the command line of a node, with the settings of its file; exits with code 2 if one of
/// them is invalid or `check` finds a problem.
pub fn parse<C: Parser>(
    file: impl Fn(&C) -> &SettingsFile,
    check: impl Fn(&C) -> Result<(), String>,
) -> C {
    try_parse(std::env::args_os().collect(), file, check).unwrap_or_else(|error| error.exit())
}

fn try_parse<C: Parser>(
    words: Vec<OsString>,
    file: impl Fn(&C) -> &SettingsFile,
    check: impl Fn(&C) -> Result<(), String>,
) -> Result<C, clap::Error> {
    let wrong = |problem| C::command().error(clap::error::ErrorKind::ValueValidation, problem);
    let mut config = C::try_parse_from(&words)?;
    if let Some(file) = &file(&config).settings {
        let settings = read(file).map_err(|error| wrong(format!("{error:#}")))?;
        let words = with_settings::<C>(words, &settings);
        config = C::try_parse_from(words)
            .map_err(|error| wrong(format!("{}: {}", file.display(), error.render())))?;
    }
    check(&config).map_err(wrong)?;
    Ok(config)
}

/// Adds the settings that are options of the program and not given on the command line.
fn with_settings<C: CommandFactory>(
    words: Vec<OsString>,
    settings: &BTreeMap<String, String>,
) -> Vec<OsString> {
    let command = C::command();
    let added = settings.iter().filter_map(|(key, value)| {
        let option = key.replace('_', "-");
        let mut options = command.get_arguments().filter_map(clap::Arg::get_long);
        let is_option = options.any(|known| known == option);
        let option = format!("--{option}");
        let start = format!("{option}=");
        let is_given = words.iter().any(|word| {
            let word = word.to_string_lossy();
            *word == *option || word.starts_with(&start)
        });
        (is_option && !is_given).then(|| OsString::from(start + value))
    });
    let added: Vec<OsString> = added.collect();
    words.into_iter().chain(added).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Parser)]
    struct Node {
        #[command(flatten)]
        file: SettingsFile,
        #[arg(long, default_value_t = 180)]
        max_beams: u32,
        #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
        odometry_delay_s: f64,
        #[arg(long, value_delimiter = ',')]
        scans: Vec<String>,
        #[arg(long, default_value_t = true, action = clap::ArgAction::Set)]
        deskew: bool,
    }

    fn node(text: &str, arguments: &str) -> Result<Node, String> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("localization.yaml");
        fs::write(&file, text).unwrap();
        let file = format!("--settings={}", file.display());
        let words = ["node", &file]
            .into_iter()
            .chain(arguments.split_whitespace());
        let words = words.map(OsString::from).collect();
        try_parse(words, |node: &Node| &node.file, |_| Ok(())).map_err(|error| error.to_string())
    }

    #[test]
    fn a_node_takes_the_settings_that_are_its_options() {
        let text = "# shared\nmax_beams: 90\nodometry_delay_s: -0.05\nscans: [front, rear]\ndeskew: false\nfit_sigma_m: 0.2\n";
        let read = node(text, "").unwrap();
        assert_eq!((read.max_beams, read.odometry_delay_s), (90, -0.05));
        assert_eq!(
            (read.scans, read.deskew),
            (vec!["front".into(), "rear".into()], false)
        );
        for arguments in ["--max-beams 60", "--max-beams=60"] {
            assert_eq!(node(text, arguments).unwrap().max_beams, 60, "{arguments}");
        }
        assert_eq!(node("", "").unwrap().max_beams, 180);
    }

    #[test]
    fn what_is_wrong_is_said_with_the_file() {
        for (text, expected) in [
            ("max_beam: 90", "max_beam is not a setting that nodes"),
            ("max_beams: many", "localization.yaml: error: invalid value"),
            ("max_beams: 90\nmax_beams: 80", "localization.yaml: "),
            ("max_beams: {a: 1}", "localization.yaml: "),
        ] {
            let error = node(text, "").unwrap_err();
            assert!(error.contains(expected), "{text}: {error}");
        }
        let words = ["node", "--settings", "/nowhere.yaml"]
            .map(OsString::from)
            .to_vec();
        let error = try_parse(words, |node: &Node| &node.file, |_| Ok(())).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains("cannot read /nowhere.yaml: No such file"),
            "{error}"
        );
    }
}
