//! Records a live ROS 2 robot for a while, with the messages that a graph receives.

use std::collections::BTreeSet;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, bail};
use command_line::say;
use messages::topic;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use serde::Deserialize;
use transport::node::LOG_FORMAT_VARIABLE;
use transport::{Flow, Graph, GraphName, TransportError, control_socket, with_causes};

use crate::init::descriptor::quoted;
use crate::init::robot::{self, Lasers, Robot};

/// A recording in a temporary folder, which is removed when this is dropped.
pub(crate) struct Recorded {
    pub(crate) file: PathBuf,
    pub(crate) warnings: BTreeSet<String>,
    _folder: tempfile::TempDir,
}

#[derive(Deserialize)]
struct Line {
    level: String,
    target: String,
    fields: Fields,
}

#[derive(Deserialize)]
struct Fields {
    message: String,
}

/// Longest wait for the first scan from the start of the recording graph.
const FIRST_SCAN: Duration = Duration::from_secs(30);

const TICK: Duration = Duration::from_millis(50);

/// Records the robot of this router, or of the network, for `length` from its first scan.
pub(crate) fn record(router: Option<&str>, length: Duration) -> anyhow::Result<Recorded> {
    say("looking for the robot's nodes");
    let seen = robot::look(router, Lasers::First)?;
    seen.said.iter().for_each(|said| say(said));
    if seen.lacks_map {
        say(robot::NO_MAP);
    }
    record_seen(&seen, router, length).context("the robot cannot be recorded")
}

fn record_seen(seen: &Robot, router: Option<&str>, length: Duration) -> anyhow::Result<Recorded> {
    if seen.options.is_empty() {
        bail!("none of its nodes publishes laser scans");
    }
    let folder = tempfile::tempdir()?;
    let [descriptor, file] = ["graph.yaml", "r.mcap"].map(|name| folder.path().join(name));
    let connect = router.map(|router| ["--connect", router]);
    let options = seen.options.iter().map(String::as_str);
    let args = options.chain(connect.into_iter().flatten());
    let text = format!(
        "nodes:
  - id: ros2_gateway
    path: ros2_gateway
    args: {gateway}
    outputs: [scan, odometry, map]
  - id: recorder
    path: recorder
    args: {recorder}
    inputs: {{scan: ros2_gateway/scan, odometry: ros2_gateway/odometry, map: ros2_gateway/map}}
",
        gateway = quoted(&shlex::try_join(args).unwrap_or_default()),
        recorder = quoted(&format!("--output {}", file.display())),
    );
    std::fs::write(&descriptor, text)?;
    let seconds = length.as_secs_f64();
    say(&format!("recording the robot for {seconds} s"));
    let name = GraphName::new(&format!("doctor_{}", std::process::id()))?;
    let mut graph = Command::new(std::env::current_exe()?)
        .arg("run")
        .arg(&descriptor)
        .args(["--no-build", "--no-monitor", "--graph"])
        .arg(name.as_str())
        .env(LOG_FORMAT_VARIABLE, "json")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()?;
    let log = graph.stderr.take().map(BufReader::new);
    let reading = std::thread::spawn(move || {
        let lines = log.into_iter().flat_map(BufRead::lines);
        lines.map_while(Result::ok).collect::<Vec<String>>()
    });
    if let Err(error) = wait_for_scan(&name, &mut graph) {
        say(&with_causes(&error));
    }
    std::thread::sleep(length);
    let pid = Pid::from_raw(graph.id().cast_signed());
    kill(pid, Signal::SIGTERM)?;
    graph.wait()?;
    let lines = reading.join().unwrap_or_default();
    if !file.is_file() {
        let last = lines.last().map_or("", String::as_str);
        bail!("nothing was recorded; the graph's last words: {last}");
    }
    Ok(Recorded {
        file,
        warnings: lines.iter().filter_map(|line| warning(line)).collect(),
        _folder: folder,
    })
}

/// Waits for the first scan in a graph that starts, for [`FIRST_SCAN`] or its launcher's life.
fn wait_for_scan(name: &GraphName, launcher: &mut Child) -> Result<(), TransportError> {
    let begin = Instant::now();
    let mut is_over =
        || begin.elapsed() >= FIRST_SCAN || launcher.try_wait().is_ok_and(|end| end.is_some());
    // Joining before the launcher would keep it from starting.
    while !control_socket(name).exists() {
        if is_over() {
            return Ok(());
        }
        std::thread::sleep(TICK);
    }
    let graph = Graph::join_named("doctor", name)?;
    let scans = graph.subscriber::<topic::Scan>()?;
    graph.run(&[&scans], TICK, |_| {
        Ok(match scans.newest()?.is_some() || is_over() {
            true => Flow::Stop,
            false => Flow::Continue,
        })
    })
}

/// Returns the message if the line is a warning of the gateway.
fn warning(line: &str) -> Option<String> {
    let object = line.get(line.find('{')?..)?;
    let line: Line = serde_json::from_str(object).ok()?;
    let is_serious = line.level == "WARN" || line.level == "ERROR";
    let is_waiting = line.fields.message.starts_with("waiting for");
    let is_its =
        line.target.starts_with("ros2_gateway") || line.target.starts_with("zenoh_session");
    (is_serious && is_its && !is_waiting).then_some(line.fields.message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_of_the_gateway_are_taken() {
        let line = |level: &str, target: &str, message: &str| {
            format!(
                r#"ros2_gateway: {{"level":"{level}","fields":{{"message":"{message}"}},"target":"{target}"}}"#
            )
        };
        let found = warning(&line("WARN", "ros2_gateway::frames", "two of them"));
        assert_eq!(found.as_deref(), Some("two of them"));
        assert_eq!(warning(&line("INFO", "ros2_gateway::run", "joined")), None);
        assert_eq!(warning(&line("WARN", "recorder", "slow")), None);
        assert_eq!(warning("no JSON"), None);
    }
}
