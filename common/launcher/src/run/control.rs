//! Control requests to a running launcher: lines of JSON over a socket in this user's folder. A
//! thread receives them; the launcher answers once per tick.

use std::fs::remove_file;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

use anyhow::Context;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use transport::Waker;

const MAX_QUESTION: u64 = 4096;
const TIMEOUT: Duration = Duration::from_secs(5);

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Question {
    Status,
    Stop,
    Restart { node: String },
    Record { on: bool },
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    Status(Status),
    Done,
    /// The recording to this file begins or ends.
    Record(String),
    Refused(String),
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Status {
    pub graph: String,
    /// Process id of the launcher.
    pub pid: u32,
    /// Path of the descriptor.
    pub descriptor: String,
    /// Time since the launcher started, in seconds.
    pub uptime_s: u64,
    /// A sentence for each failed node that the graph continues without.
    pub given_up: Vec<String>,
    #[serde(default)]
    pub recording: Recording,
    /// Nodes in the order of the descriptor.
    pub nodes: Vec<NodeStatus>,
}

/// Recording of the graph.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Recording {
    /// File that is being written; `None` while nothing is recorded.
    pub file: Option<String>,
    /// Its size so far, in megabytes (10^6 bytes).
    pub size_mb: Option<f64>,
    /// Reason why no recording can be started.
    pub refused: Option<String>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NodeStatus {
    /// Id in the descriptor.
    pub id: String,
    /// `running`, `waiting to start` or `ended`.
    pub state: String,
    /// Process id while the node runs.
    pub pid: Option<i32>,
    /// Time since the process started, in seconds.
    pub uptime_s: Option<u64>,
    /// Age of the last health message of the process, in seconds.
    pub reported_s: Option<u64>,
    /// Number of restarts since the graph was started.
    pub restarts: u64,
    /// Exit status of the last process that ended.
    pub last_end: Option<String>,
    /// A sentence if the node fails again and again.
    pub fails: Option<String>,
}

pub struct Asked {
    pub question: Question,
    pub answer: Sender<Answer>,
}

/// Receives requests on a socket at `path`; `waker` wakes the launcher for each.
pub fn listen(path: &Path, waker: Waker) -> anyhow::Result<Receiver<Asked>> {
    // Removes the socket of a killed launcher; a living one would hold the graph's name.
    let _ = remove_file(path);
    let failed = || format!("cannot listen on {}", path.display());
    let listener = UnixListener::bind(path).with_context(failed)?;
    let (asked, questions) = channel();
    let body = move || {
        for stream in listener.incoming().flatten() {
            // A client that hangs up or sends an invalid request is ignored.
            let _ = serve(&stream, &asked, &waker);
        }
    };
    let thread = thread::Builder::new().name("control".into());
    thread.spawn(body).with_context(failed)?;
    Ok(questions)
}

fn serve(mut stream: &UnixStream, asked: &Sender<Asked>, waker: &Waker) -> std::io::Result<()> {
    stream.set_read_timeout(Some(TIMEOUT))?;
    stream.set_write_timeout(Some(TIMEOUT))?;
    let mut line = String::new();
    BufReader::new(stream.take(MAX_QUESTION)).read_line(&mut line)?;
    let answer = match serde_json::from_str(&line) {
        Err(error) => Answer::Refused(format!("this version does not know the request: {error}")),
        Ok(question) => {
            let (answer, answered) = channel();
            // If it cannot be asked, the sender of the answer is dropped.
            let _ = asked.send(Asked { question, answer });
            waker.wake();
            let busy = |_| Answer::Refused("the launcher does not answer".to_owned());
            answered.recv_timeout(TIMEOUT).unwrap_or_else(busy)
        }
    };
    let mut text = serde_json::to_string(&answer)?;
    text.push('\n');
    stream.write_all(text.as_bytes())
}

pub fn ask(path: &Path, question: &Question) -> std::io::Result<Answer> {
    let stream = UnixStream::connect(path)?;
    stream.set_read_timeout(Some(2 * TIMEOUT))?;
    let mut text = serde_json::to_string(question)?;
    text.push('\n');
    (&stream).write_all(text.as_bytes())?;
    let mut line = String::new();
    BufReader::new(&stream).read_line(&mut line)?;
    Ok(serde_json::from_str(&line)?)
}

/// Reason for rejecting a node that the graph does not have.
pub fn no_node(node: &str, nodes: &[NodeStatus]) -> String {
    let ids: Vec<&str> = nodes.iter().map(|node| node.id.as_str()).collect();
    format!("there is no node {node}: allowed are {}", ids.join(", "))
}
