//! Finds the requested graph, sends a request to its launcher and prints the answer.

use std::process::ExitCode;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow, bail};
use clap::{Args, ValueEnum};
use command_line::{stdout::print, wrong_use};
use nix::unistd::{Uid, User};
use transport::{GraphName, control_socket, graphs_of_others, is_launched, running_graphs};

use super::text;
use crate::run::control::{Answer, Question, Status, ask, no_node};

/// Longest time that a graph may take to stop, and the polling interval.
const STOPPED_WITHIN: Duration = Duration::from_secs(30);
const LOOK: Duration = Duration::from_millis(20);

#[derive(Debug, Args)]
pub struct StatusConfig {
    /// Only this graph [default: all that this user runs]
    #[arg(long, value_name = "NAME", value_parser = GraphName::new)]
    graph: Option<GraphName>,

    /// Print JSON, one object per line and graph
    #[arg(long)]
    json: bool,
}

/// Graph that a command is for.
#[derive(Debug, Args)]
pub struct OneGraph {
    /// The graph [default: the only one that this user runs]
    #[arg(long, value_name = "NAME", value_parser = GraphName::new)]
    graph: Option<GraphName>,
}

#[derive(Debug, Args)]
pub struct RestartConfig {
    /// The node's id in the descriptor
    node: String,

    #[command(flatten)]
    graph: OneGraph,
}

#[derive(Debug, Args)]
pub struct RecordConfig {
    /// Start a recording, or stop the one that runs
    action: RecordAction,

    #[command(flatten)]
    graph: OneGraph,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum RecordAction {
    Start,
    Stop,
}

pub fn status(config: &StatusConfig) -> anyhow::Result<ExitCode> {
    let graphs = match &config.graph {
        Some(graph) => vec![graph.clone()],
        None => running_graphs(),
    };
    if graphs.is_empty() {
        return Err(no_graph());
    }
    for graph in &graphs {
        let status = status_of(graph)?;
        print(&match config.json {
            true => command_line::json::object(&status) + "\n",
            false => text::status(&status),
        })?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Stops a graph in order and waits until it has ended and its name is free.
pub fn stop(graph: &OneGraph) -> anyhow::Result<ExitCode> {
    let graph = graph.find()?;
    asked(&graph, &Question::Stop)?;
    wait_while(&format!("graph {graph}"), || Ok(is_launched(&graph)))?;
    Ok(ExitCode::SUCCESS)
}

/// Starts or stops a recording of a graph and prints its file, complete once stopped.
pub fn record(config: &RecordConfig) -> anyhow::Result<ExitCode> {
    let graph = config.graph.find()?;
    let on = config.action == RecordAction::Start;
    let Answer::Record(file) = asked(&graph, &Question::Record { on })? else {
        return Err(wrong_use("unexpected answer"));
    };
    wait_while("the recorder", || {
        Ok(!on && status_of(&graph)?.recording.file.is_some())
    })?;
    print(&format!("{file}\n"))?;
    Ok(ExitCode::SUCCESS)
}

fn wait_while(what: &str, mut runs: impl FnMut() -> anyhow::Result<bool>) -> anyhow::Result<()> {
    let begin = Instant::now();
    while runs()? {
        if begin.elapsed() >= STOPPED_WITHIN {
            bail!(
                "{what} still runs {} s after it was asked to stop: `backcast status` shows what runs",
                STOPPED_WITHIN.as_secs()
            );
        }
        thread::sleep(LOOK);
    }
    Ok(())
}

pub fn restart(config: &RestartConfig) -> anyhow::Result<ExitCode> {
    let graph = config.graph.find()?;
    let node = config.node.clone();
    asked(&graph, &Question::Restart { node })?;
    Ok(ExitCode::SUCCESS)
}

impl OneGraph {
    pub(super) fn find(&self) -> anyhow::Result<GraphName> {
        if let Some(graph) = &self.graph {
            return Ok(graph.clone());
        }
        match &running_graphs()[..] {
            [] => Err(no_graph()),
            [graph] => Ok(graph.clone()),
            several => {
                let names: Vec<_> = several.iter().map(ToString::to_string).collect();
                let names = names.join(", ");
                Err(wrong_use(format!(
                    "several graphs are running: choose one with --graph; running are {names}"
                )))
            }
        }
    }
}

fn no_graph() -> anyhow::Error {
    let sentence = |(user, graph): (u32, GraphName)| {
        let name = User::from_uid(Uid::from_raw(user)).ok().flatten();
        let name = name.map_or_else(|| format!("#{user}"), |user| user.name);
        format!("; user {name} runs graph {graph}: `sudo -u {name} backcast status`")
    };
    let others: String = graphs_of_others().into_iter().map(sentence).collect();
    anyhow!("no graph of this user is running{others}")
}

fn status_of(graph: &GraphName) -> anyhow::Result<Status> {
    match asked(graph, &Question::Status)? {
        Answer::Status(status) => Ok(status),
        _ => Err(wrong_use("unexpected answer")),
    }
}

pub(super) fn known_node(graph: &GraphName, node: &str) -> anyhow::Result<()> {
    let nodes = status_of(graph)?.nodes;
    match nodes.iter().any(|known| known.id == node) {
        true => Ok(()),
        false => Err(wrong_use(no_node(node, &nodes))),
    }
}

/// Returns the answer of the graph's launcher; one that refuses is an error.
fn asked(graph: &GraphName, question: &Question) -> anyhow::Result<Answer> {
    let answer = ask(&control_socket(graph), question).with_context(|| {
        format!("no launcher of graph {graph} answers: `backcast status` lists the graphs that run")
    })?;
    match answer {
        Answer::Refused(why) => Err(wrong_use(why)),
        answer => Ok(answer),
    }
}
