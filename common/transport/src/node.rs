//! What every node's `main` does: logging, joining, running, the exit code.
//!
//! The one place where an outcome becomes an exit code. Arguments are parsed
//! before, by the node itself.

use std::env::VarError;
use std::error::Error;
use std::io::IsTerminal;
use std::process::ExitCode;

use tracing_subscriber::EnvFilter;
use tracing_subscriber::filter::LevelFilter;

use crate::{Graph, with_causes};

/// The environment variable that picks the form of log lines: `text` or `json`.
pub const LOG_FORMAT_VARIABLE: &str = "BACKCAST_LOG_FORMAT";

/// Runs one node: starts logging to standard error, joins the graph as `name`
/// and calls `run`.
///
/// Returns 0 if `run` did, 1 if it or joining failed, 2 if a logging variable
/// holds something that is not allowed.
pub fn main<E: Error + 'static>(name: &str, run: impl FnOnce(&Graph) -> Result<(), E>) -> ExitCode {
    if let Err(problem) = start_logging() {
        eprintln!("{name}: {problem}");
        return ExitCode::from(2);
    }
    let outcome = Graph::join(name)
        .map_err(|error| with_causes(&error))
        .and_then(|graph| run(&graph).map_err(|error| with_causes(&error)));
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            tracing::error!("{problem}");
            ExitCode::FAILURE
        }
    }
}

/// Sends events of `tracing` to standard error: `RUST_LOG` filters them (`info`
/// where it is unset), [`LOG_FORMAT_VARIABLE`] picks their form.
///
/// # Errors
/// A sentence that names the variable, its value and what is allowed; or that
/// logging has been started already.
pub fn start_logging() -> Result<(), String> {
    let filter = variable(EnvFilter::DEFAULT_ENV, "")?;
    let filter = EnvFilter::builder()
        .with_default_directive(LevelFilter::INFO.into())
        .parse(&filter)
        .map_err(|error| format!("{} is {filter:?}: {error}", EnvFilter::DEFAULT_ENV))?;
    let builder = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_ansi(std::io::stderr().is_terminal())
        .with_writer(std::io::stderr);
    let started = match variable(LOG_FORMAT_VARIABLE, "text")?.as_str() {
        "text" => builder.try_init(),
        "json" => builder.json().try_init(),
        other => {
            return Err(format!(
                "{LOG_FORMAT_VARIABLE} is {other:?}: allowed are text and json"
            ));
        }
    };
    started.map_err(|error| format!("cannot start logging: {error}"))
}

fn variable(name: &str, default: &str) -> Result<String, String> {
    match std::env::var(name) {
        Ok(value) => Ok(value),
        Err(VarError::NotPresent) => Ok(default.into()),
        Err(VarError::NotUnicode(value)) => Err(format!("{name} is {value:?}: it must be UTF-8")),
    }
}
