//! A ROS 2 robot made of third-party Python libraries.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use serde_json::{Value, json};

use crate::needs::Need;
use crate::{Killed, python};

/// Libraries and their versions.
pub const LIBRARIES: [&str; 3] = [
    "eclipse-zenoh==1.10.2",
    "rosbags==0.11.9",
    "zenoh-ros2-sdk==0.1.8",
];

/// Program of the robot: the part of all robots, then that of a robot with Nav2.
const PROGRAM: &str = concat!(include_str!("robot.py"), include_str!("nav2.py"));

/// Longest silence before an event that a test waits for: many times the time that its libraries
/// take to load on a busy machine.
const TIMEOUT: Duration = Duration::from_secs(120);

/// A process that executes orders, killed if the test fails.
pub struct Robot {
    _process: Killed,
    orders: ChildStdin,
    said: Receiver<String>,
    /// Events that no call has returned yet.
    passed_over: Vec<Value>,
}

impl Robot {
    /// Starts a robot in `namespace` with the data of the recording, which joins the router at
    /// `endpoint`. Returns `None` if the libraries are not available, which is reported.
    pub fn start(endpoint: &str, recording: &Path, namespace: &str) -> Option<Self> {
        let python = python::with("robot", &LIBRARIES, "zenoh_ros2_sdk, rosbags")
            .map_err(|why| Need::Python.is_missing("a robot with ROS 2", &why))
            .ok()?;
        let mut command = Command::new(python);
        command
            .args(["-c", PROGRAM, endpoint])
            .arg(recording)
            .arg(namespace)
            .env_remove("ROS_DOMAIN_ID");
        Some(Self::run(&mut command))
    }

    /// Starts a robot that is a program in Python, and waits until it is there.
    pub fn run(command: &mut Command) -> Self {
        let mut process = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let orders = process.stdin.take().unwrap();
        let lines = BufReader::new(process.stdout.take().unwrap()).lines();
        let (say, said) = channel();
        std::thread::spawn(move || {
            // A test that has ended reads no more.
            for line in lines.map_while(Result::ok) {
                let _ = say.send(line);
            }
        });
        let mut robot = Robot {
            _process: Killed(process),
            orders,
            said,
            passed_over: Vec::new(),
        };
        robot.wait_for("there");
        robot
    }

    pub fn order(&mut self, what: &str, mut how: Value) {
        how["do"] = json!(what);
        writeln!(self.orders, "{how}").unwrap();
    }

    /// Returns the next event.
    pub fn receive(&mut self) -> Value {
        if self.passed_over.is_empty() {
            self.read()
        } else {
            self.passed_over.remove(0)
        }
    }

    /// Waits for the next event of that name. Events before it are kept: topics reach the robot in
    /// no certain order.
    pub fn wait_for(&mut self, event: &str) -> Value {
        let is_awaited = |said: &Value| said["event"] == event;
        if let Some(index) = self.passed_over.iter().position(is_awaited) {
            return self.passed_over.remove(index);
        }
        loop {
            let said = self.read();
            if is_awaited(&said) {
                return said;
            }
            self.passed_over.push(said);
        }
    }

    fn read(&mut self) -> Value {
        let line = self.said.recv_timeout(TIMEOUT).unwrap_or_else(|why| {
            let what = match why {
                RecvTimeoutError::Timeout => "says nothing",
                RecvTimeoutError::Disconnected => "has ended",
            };
            panic!("the robot {what}; before that: {:#?}", self.passed_over)
        });
        let said: Value = serde_json::from_str(&line).unwrap();
        assert_ne!(said["event"], "failed", "{said}");
        said
    }
}
