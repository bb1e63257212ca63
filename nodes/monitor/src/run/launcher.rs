//! The launcher of the graph, which is asked over its control socket, as from a terminal.

use std::io::{self, BufRead, BufReader, Write};
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

use dashboard::Robot;
use serde_json::{Value, json};
use transport::{Graph, control_socket, is_launched};

/// Interval at which it is asked what is recorded.
const POLL: Duration = Duration::from_secs(1);
/// Timeout for an answer, longer than that of the launcher.
const TIMEOUT: Duration = Duration::from_secs(10);

/// Sender of requests, for a graph that has a launcher.
pub(super) struct Launcher(Option<Sender<Value>>);

impl Launcher {
    /// Starts a thread that asks the launcher and tells `robot` what is recorded.
    pub(super) fn of(graph: &Graph, robot: &Arc<Robot>) -> Self {
        if !is_launched(graph.name()) {
            return Launcher(None);
        }
        let socket = control_socket(graph.name());
        let (requests, waiting) = channel();
        let robot = Arc::clone(robot);
        std::thread::spawn(move || {
            loop {
                let status = ask(&socket, &json!("status")).unwrap_or_default();
                // An older launcher records nothing on request, and says nothing about it.
                let recording = status["status"]["recording"].clone();
                if let Ok(recording) = serde_json::from_value(recording) {
                    robot.on_recording(recording);
                }
                match waiting.recv_timeout(POLL) {
                    Ok(request) => carry_out(&socket, &request),
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
        });
        Launcher(Some(requests))
    }

    pub(super) fn is_there(&self) -> bool {
        self.0.is_some()
    }

    pub(super) fn restart(&self, node: &str) {
        self.send(json!({ "restart": { "node": node } }));
    }

    pub(super) fn record(&self, on: bool) {
        self.send(json!({ "record": { "on": on } }));
    }

    fn send(&self, request: Value) {
        if let Some(requests) = &self.0 {
            // The thread ends with this sender.
            let _ = requests.send(request);
        }
    }
}

fn carry_out(socket: &Path, request: &Value) {
    match ask(socket, request) {
        Ok(answer) => {
            if let Some(why) = answer["refused"].as_str() {
                tracing::warn!("the launcher refused {request}: {why}");
            }
        }
        Err(error) => tracing::warn!("the launcher did not answer {request}: {error}"),
    }
}

/// Sends a line to the launcher and returns its answer.
fn ask(socket: &Path, request: &Value) -> io::Result<Value> {
    let mut stream = UnixStream::connect(socket)?;
    stream.set_read_timeout(Some(TIMEOUT))?;
    stream.write_all(format!("{request}\n").as_bytes())?;
    let mut line = String::new();
    BufReader::new(stream).read_line(&mut line)?;
    Ok(serde_json::from_str(&line)?)
}
