//! The engine's settings as keywords. They are the options of `backcast locate` and of the
//! tracker, read by the same parser, with the same defaults and the same limits:
//! `max_beams=90` is `--max-beams 90`.

use std::error::Error;

use clap::error::ErrorKind;
use clap::{ArgAction, CommandFactory, FromArgMatches};
use engine::grid::CellRules;
use engine::joined::MotionConfig;
use engine::limits::{HeadingInterval, Region};
use engine::peaks::PeakConfig;
use engine::tracking::TrackingConfig;
use engine::vote_search::VoteSearchConfig;
use index_cache::IndexCacheConfig;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyString};

use crate::error::value;
use crate::numbers::{row, rows};

/// Settings for locating a scan.
#[derive(Debug, Clone, clap::Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
pub(crate) struct EngineSettings {
    #[command(flatten)]
    pub(crate) cells: CellRules,
    #[command(flatten)]
    pub(crate) vote_search: VoteSearchConfig,
    #[command(flatten)]
    pub(crate) peaks: PeakConfig,
    #[command(flatten)]
    pub(crate) index_cache: IndexCacheConfig,
}

/// Settings for locating a scan, and for tracking the robot.
#[derive(Debug, Clone, clap::Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
pub(crate) struct TrackerSettings {
    #[command(flatten)]
    pub(crate) engine: EngineSettings,
    #[command(flatten)]
    pub(crate) tracking: TrackingConfig,
    #[command(flatten)]
    pub(crate) motion: MotionConfig,
}

impl EngineSettings {
    /// Reads the settings from keywords.
    pub(crate) fn new(keywords: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        parse(keywords, |settings: &mut EngineSettings| settings)
    }
}

impl TrackerSettings {
    /// Reads the settings from keywords.
    pub(crate) fn new(keywords: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        parse(keywords, |settings: &mut TrackerSettings| {
            &mut settings.engine
        })
    }
}

fn parse<T: CommandFactory + FromArgMatches>(
    keywords: Option<&Bound<'_, PyDict>>,
    engine: impl Fn(&mut T) -> &mut EngineSettings,
) -> PyResult<T> {
    // These two are not one number or word in Python, and are set after the others.
    let (mut region, mut headings_within) = (None, None);
    let mut words = Vec::new();
    let mut command = T::command();
    for (key, given) in keywords.iter().flat_map(|keywords| keywords.iter()) {
        let key: String = key.extract()?;
        let Some(option) = command.get_arguments().find(|arg| arg.get_id() == &*key) else {
            return Err(unknown(&key, &command));
        };
        if given.is_none() {
            continue;
        }
        match &*key {
            "region" => region = Some(polygon(&given)?),
            "headings_within" => headings_within = Some(interval(&given)?),
            _ => words.extend(word(&key, option, &given)?),
        }
    }
    let settings = command
        .try_get_matches_from_mut(words)
        .and_then(|matches| T::from_arg_matches(&matches));
    let mut settings = settings.map_err(|error| refused(&error))?;
    let limits = &mut engine(&mut settings).vote_search.limits;
    (limits.region, limits.headings_within) = (region, headings_within);
    Ok(settings)
}

/// Converts a keyword to an option of the command; `None` for a flag that is not set.
fn word(key: &str, option: &clap::Arg, given: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    let name = format!("--{}", option.get_long().unwrap_or(key));
    let kind = given.get_type().name()?;
    let wrong = |allowed: &str| {
        PyTypeError::new_err(format!("{key} is {given}, a {kind}; allowed: {allowed}"))
    };
    let is_flag = matches!(option.get_action(), ArgAction::SetTrue);
    if let Ok(flag) = given.cast::<PyBool>() {
        return match (is_flag, flag.is_true()) {
            (true, is_set) => Ok(is_set.then_some(name)),
            (false, is_set) if key == "deskew" => Ok(Some(format!("{name}={is_set}"))),
            (false, _) => Err(wrong("a number or a word")),
        };
    }
    if is_flag || key == "deskew" {
        return Err(wrong("True or False"));
    }
    let text = if let Ok(text) = given.cast::<PyString>() {
        text.to_string()
    } else if let Ok(number) = given.extract::<i64>() {
        number.to_string()
    } else if let Ok(number) = given.extract::<f64>() {
        // Rust's shortest form is read back to the same number.
        number.to_string()
    } else {
        return Err(wrong("a number or a word"));
    };
    Ok(Some(format!("{name}={text}")))
}

fn unknown(key: &str, command: &clap::Command) -> PyErr {
    let known: Vec<&str> = command
        .get_arguments()
        .map(|arg| arg.get_id().as_str())
        .collect();
    PyTypeError::new_err(format!(
        "{key} is no setting; allowed: {}",
        known.join(", ")
    ))
}

/// Converts an error of the command's parser: keyword, value and what is allowed.
fn refused(error: &clap::Error) -> PyErr {
    let rendered = error.to_string();
    let text = match (error.kind(), error.source()) {
        (ErrorKind::ValueValidation, Some(reason)) => {
            let option = rendered.split('\'').nth(3).unwrap_or_default();
            let option = option.split(' ').next().unwrap_or_default();
            let key = option.trim_start_matches('-').replace('-', "_");
            format!("{key}: {reason}")
        }
        _ => {
            let lines = rendered.lines().map(str::trim);
            let lines = lines.take_while(|line| !line.starts_with("For more"));
            lines.collect::<Vec<_>>().join(" ").trim().to_owned()
        }
    };
    value(text)
}

fn polygon(given: &Bound<'_, PyAny>) -> PyResult<Region> {
    let allowed = "two corners of an upright rectangle, or all of any other polygon, each (x, y) \
                   in metres";
    let wrong = || value(format!("region is {given}; allowed: {allowed}"));
    let corners = rows::<2>(given).ok_or_else(wrong)?;
    Region::new(&corners).map_err(|reason| value(format!("region: {reason}")))
}

fn interval(given: &Bound<'_, PyAny>) -> PyResult<HeadingInterval> {
    let allowed = "(from, to) counter-clockwise, each within a turn, radians";
    // The command's limit of 360 degrees, with what converting degrees may round up.
    let most = std::f64::consts::TAU * (1.0 + 1e-12);
    match row("headings_within", given, allowed)?[..] {
        [from, to] if from.abs() <= most && to.abs() <= most => Ok(HeadingInterval { from, to }),
        _ => Err(value(format!(
            "headings_within is {given}; allowed: {allowed}"
        ))),
    }
}
