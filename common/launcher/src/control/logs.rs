//! `backcast logs`: prints the log lines of the nodes of a running graph, from topic `log`.

use std::process::ExitCode;
use std::time::{Duration, Instant, SystemTime};

use clap::Args;
use command_line::stdout::print;
use messages::{LogHeader, LogLevel, topic};
use schemars::JsonSchema;
use serde::Serialize;
use transport::{Flow, Graph, is_launched};

use super::command::{OneGraph, known_node};
use crate::run::console::{LAUNCHER, say};

/// Time to wait for the lines that nodes keep for late subscribers.
const KEPT_LINES: Duration = Duration::from_millis(700);
const TICK: Duration = Duration::from_millis(100);
const LOOK: Duration = Duration::from_secs(1);

#[derive(Debug, Args)]
pub struct LogsConfig {
    /// Only this node
    node: Option<String>,

    /// Keep printing new lines, until the graph ends or Ctrl-C
    #[arg(long, short)]
    follow: bool,

    /// Print JSON, one object per line
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    graph: OneGraph,
}

pub fn logs(config: &LogsConfig) -> anyhow::Result<ExitCode> {
    let name = config.graph.find()?;
    let graph = Graph::join_named("logs", &name)?;
    let lines = graph.subscriber::<topic::Log>()?;
    let begin = Instant::now();
    let mut kept: Vec<LogLine> = Vec::new();
    let (mut all_kept, mut printed) = (false, 0u64);
    // Without a launcher, the end of the graph cannot be detected.
    let was_launched = is_launched(&name);
    let (mut has_ended, mut looked) = (false, begin);
    graph.run(&[&lines], TICK, |_| {
        if was_launched && looked.elapsed() >= LOOK {
            has_ended = !is_launched(&name);
            looked = Instant::now();
        }
        while let Some(line) = lines.receive()? {
            let line = LogLine::of(line.header(), line.items());
            if config.node.as_ref().is_none_or(|node| *node == line.node) {
                kept.push(line);
            }
        }
        // The kept lines arrive node by node, so they are sorted by time first.
        all_kept = all_kept || begin.elapsed() >= KEPT_LINES;
        if all_kept {
            kept.sort_by_key(|line| line.wall_ns);
            for line in kept.drain(..) {
                printed += 1;
                print(&match config.json {
                    true => line.json(),
                    false => line.text(),
                })?;
            }
        }
        let goes_on = !all_kept || config.follow && !has_ended;
        Ok::<_, anyhow::Error>(if goes_on { Flow::Continue } else { Flow::Stop })
    })?;
    if has_ended {
        say(LAUNCHER, &format!("graph {name} has ended"));
        return Ok(ExitCode::SUCCESS);
    }
    match &config.node {
        // A known node that has logged nothing is not an error.
        Some(node) if printed == 0 => known_node(&name, node)?,
        _ => {}
    }
    Ok(ExitCode::SUCCESS)
}

/// A line of a node's log.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LogLine {
    /// Time of logging, in nanoseconds since 1970.
    pub wall_ns: i64,
    /// Name of the node.
    pub node: String,
    /// Process id of the node.
    pub pid: u32,
    /// `DEBUG`, `INFO`, `WARN`, `ERROR` or `?`.
    pub level: &'static str,
    pub text: String,
}

impl LogLine {
    pub fn of(header: &LogHeader, text: &[u8]) -> Self {
        let level = match LogLevel::from_code(header.level) {
            Some(LogLevel::Debug) => "DEBUG",
            Some(LogLevel::Info) => "INFO",
            Some(LogLevel::Warn) => "WARN",
            Some(LogLevel::Error) => "ERROR",
            None => "?",
        };
        LogLine {
            wall_ns: header.wall_ns,
            node: header.node.as_str().to_owned(),
            pid: header.pid,
            level,
            text: String::from_utf8_lossy(text).into_owned(),
        }
    }

    pub fn json(&self) -> String {
        command_line::json::object(self) + "\n"
    }

    fn text(&self) -> String {
        let since = Duration::from_nanos(self.wall_ns.max(0).cast_unsigned());
        let when = humantime::format_rfc3339_millis(SystemTime::UNIX_EPOCH + since);
        let LogLine {
            node, level, text, ..
        } = self;
        format!("{when} {level:>5} {node:>18} | {text}\n")
    }
}
