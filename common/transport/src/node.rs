//! The `main` function of nodes: logging, joining, running, exit code.

use std::env::VarError;
use std::error::Error;
use std::io::IsTerminal;
use std::process::{ExitCode, Termination};
use std::time::{SystemTime, UNIX_EPOCH};

use tracing_subscriber::filter::LevelFilter;
use tracing_subscriber::fmt::format::Writer;
use tracing_subscriber::fmt::time::FormatTime;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::util::SubscriberInitExt;
use tracing_subscriber::{EnvFilter, Layer};

use crate::log_limit::Limit;
use crate::{Graph, log_lines, with_causes};

/// Environment variable with the format of log lines: `text`, `short` or `json`. `short` has
/// neither date, microseconds nor module path. Default: `short` on a terminal, else `text`.
pub const LOG_FORMAT_VARIABLE: &str = "BACKCAST_LOG_FORMAT";

/// Environment variable that makes a node exit after checking its arguments, with 0 or 2.
pub const CHECK_ARGUMENTS_VARIABLE: &str = "BACKCAST_CHECK_ARGUMENTS";

/// Runs one node: starts logging, joins the graph as `name` and calls `run`. Returns 1 if joining
/// or `run` failed, 2 if a logging variable is invalid, else the code of its result.
pub fn main<T: Termination, E: Error + 'static>(
    name: &str,
    run: impl FnOnce(&Graph) -> Result<T, E>,
) -> ExitCode {
    main_with_log(name, "", run)
}

/// Like [`main`], with `filter` in place of an unset `RUST_LOG`.
pub fn main_with_log<T: Termination, E: Error + 'static>(
    name: &str,
    filter: &str,
    run: impl FnOnce(&Graph) -> Result<T, E>,
) -> ExitCode {
    if std::env::var_os(CHECK_ARGUMENTS_VARIABLE).is_some() {
        return ExitCode::SUCCESS;
    }
    if let Err(problem) = start_logging_by(filter) {
        eprintln!("{name}: {problem}");
        return ExitCode::from(2);
    }
    let graph = match Graph::join(name) {
        Ok(graph) => graph,
        Err(error) => return failed(&error),
    };
    // The error is logged before the graph is dropped, so that the graph receives it.
    match run(&graph) {
        Ok(done) => done.report(),
        Err(error) => failed(&error),
    }
}

fn failed(error: &(dyn Error + 'static)) -> ExitCode {
    tracing::error!("{}", with_causes(error));
    ExitCode::FAILURE
}

/// Sends events of `tracing` to standard error, and to topic `log` of a graph that is joined later.
/// Repetitions of a message beyond twenty within ten seconds are omitted and counted.
pub fn start_logging() -> Result<(), String> {
    start_logging_by("")
}

fn start_logging_by(default: &str) -> Result<(), String> {
    let filter = variable(EnvFilter::DEFAULT_ENV, default)?;
    let filter = EnvFilter::builder()
        .with_default_directive(LevelFilter::INFO.into())
        .parse(&filter)
        .map_err(|error| format!("{} is {filter:?}: {error}", EnvFilter::DEFAULT_ENV))?;
    let console = tracing_subscriber::fmt::layer()
        .with_ansi(std::io::stderr().is_terminal())
        .with_writer(std::io::stderr);
    let console = match log_format()?.as_str() {
        "text" => console.boxed(),
        "short" => console.with_timer(TimeOfDay).with_target(false).boxed(),
        "json" => console.json().boxed(),
        other => {
            return Err(format!(
                "{LOG_FORMAT_VARIABLE} is {other:?}: allowed are text, short and json"
            ));
        }
    };
    tracing_subscriber::registry()
        .with(filter)
        .with(Limit::default())
        .with(console)
        .with(log_lines::keep())
        .try_init()
        .map_err(|error| format!("cannot start logging: {error}"))
}

fn log_format() -> Result<String, String> {
    let default = match std::io::stderr().is_terminal() {
        true => "short",
        false => "text",
    };
    variable(LOG_FORMAT_VARIABLE, default)
}

/// True if the log goes to a terminal, also through the launcher.
pub fn logs_to_terminal() -> bool {
    log_format().is_ok_and(|format| format == "short")
}

struct TimeOfDay;

impl FormatTime for TimeOfDay {
    fn format_time(&self, w: &mut Writer<'_>) -> std::fmt::Result {
        let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH);
        let second = since_1970.unwrap_or_default().as_secs() % 86_400;
        let (hour, minute) = (second / 3600, second / 60 % 60);
        write!(w, "{hour:02}:{minute:02}:{:02}Z", second % 60)
    }
}

fn variable(name: &str, default: &str) -> Result<String, String> {
    match std::env::var(name) {
        Ok(value) => Ok(value),
        Err(VarError::NotPresent) => Ok(default.into()),
        Err(VarError::NotUnicode(value)) => Err(format!("{name} is {value:?}: it must be UTF-8")),
    }
}
