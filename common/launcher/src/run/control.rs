//! What is asked of a running launcher from another terminal, and its answers.
//!
//! A line of JSON each over a socket in this user's folder: only this user can open it.
//! A thread takes the questions; the launcher answers them between two looks at its
//! processes.

use std::{
    fs::remove_file,
    io::{BufRead, BufReader, Read, Write},
    os::unix::net::{UnixListener, UnixStream},
    path::Path,
    sync::mpsc::{Receiver, Sender, channel},
    thread,
    time::Duration,
};

use serde::{Deserialize, Serialize};
use transport::Waker;

use crate::LauncherError;

/// The longest question, bytes.
const MAX_QUESTION: u64 = 4096;
/// How long a question may take to come, and its answer to be given and taken.
const TIMEOUT: Duration = Duration::from_secs(5);

/// What can be asked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Question {
    /// The state of the graph.
    Status,
    /// That it stop in order.
    Stop,
    /// That one node be ended in order and started again.
    Restart {
        /// Its id.
        node: String,
    },
}

/// What is answered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// The state of the graph.
    Status(Status),
    /// It is being done.
    Done,
    /// It cannot be done.
    Refused(String),
}

/// The state of a graph.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Status {
    /// The graph's name.
    pub graph: String,
    /// Of the launcher.
    pub pid: u32,
    /// The descriptor's file.
    pub descriptor: String,
    /// How long it runs, seconds.
    pub uptime_s: u64,
    /// A sentence on each node that the graph continues without.
    pub given_up: Vec<String>,
    /// Its nodes, as the descriptor has them.
    pub nodes: Vec<NodeStatus>,
}

/// The state of a node.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NodeStatus {
    /// Its name in the descriptor.
    pub id: String,
    /// `running`, `waiting to start` or `ended`.
    pub state: String,
    /// Its process, while it runs.
    pub pid: Option<i32>,
    /// How long the process runs, seconds.
    pub uptime_s: Option<u64>,
    /// Age of the last report of the process on itself, seconds.
    pub reported_s: Option<u64>,
    /// Since the graph was started.
    pub restarts: u64,
    /// How its last process ended.
    pub last_end: Option<String>,
    /// A sentence where the node fails again and again.
    pub fails: Option<String>,
}

/// A question, and where its answer goes.
pub struct Asked {
    /// What is asked.
    pub question: Question,
    /// Where the answer goes.
    pub answer: Sender<Answer>,
}

/// Takes questions at `path`; whoever waits is woken with `waker`.
///
/// # Errors
/// The socket cannot be made.
pub fn listen(path: &Path, waker: Waker) -> Result<Receiver<Asked>, LauncherError> {
    // What a launcher has left that was killed; a living one holds the graph's name.
    let _ = remove_file(path);
    let failed = |source| LauncherError::File {
        action: "listen on",
        file: path.to_owned(),
        source,
    };
    let listener = UnixListener::bind(path).map_err(failed)?;
    let (asked, questions) = channel();
    let body = move || {
        for stream in listener.incoming().flatten() {
            // One that hangs up, or asks nonsense, is nobody's loss but its own.
            let _ = serve(&stream, &asked, &waker);
        }
    };
    let thread = thread::Builder::new().name("control".into());
    thread.spawn(body).map_err(failed)?;
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
            let busy = || Answer::Refused("the launcher does not answer".to_owned());
            match asked.send(Asked { question, answer }) {
                Ok(()) => {
                    waker.wake();
                    answered.recv_timeout(TIMEOUT).unwrap_or_else(|_| busy())
                }
                Err(_) => busy(),
            }
        }
    };
    let mut text = serde_json::to_string(&answer)?;
    text.push('\n');
    stream.write_all(text.as_bytes())
}

/// Asks the launcher that listens at `path`.
///
/// # Errors
/// Nobody listens, or the answer is invalid.
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
