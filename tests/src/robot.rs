//! A ROS 2 robot, by libraries of others in Python.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use serde_json::{Value, json};

use crate::needs::Need;
use crate::python;

/// What it is made of, and their versions.
pub const LIBRARIES: [&str; 3] = [
    "eclipse-zenoh==1.10.2",
    "rosbags==0.11.9",
    "zenoh-ros2-sdk==0.1.8",
];

/// The robot's program: what each robot does, then what one with Nav2 does besides.
const PROGRAM: &str = concat!(include_str!("robot.py"), include_str!("nav2.py"));

/// How long it may say nothing that a test waits for: many times as long as its
/// libraries take to be loaded on a busy machine.
const TIMEOUT: Duration = Duration::from_secs(120);

/// A process that executes commands, killed if the test fails.
pub struct Robot {
    process: Child,
    orders: ChildStdin,
    said: Receiver<String>,
    /// What it has said that no call has returned yet.
    passed_over: Vec<Value>,
}

impl Robot {
    /// A robot that has what is in the recording, in `namespace`, and joins the router
    /// at `endpoint`; none where the libraries cannot be had, which is said.
    ///
    /// # Panics
    /// If it does not start.
    #[must_use]
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

    /// A robot that is a program of Python, and says that it is there.
    ///
    /// # Panics
    /// If it does not start.
    #[must_use]
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
            process,
            orders,
            said,
            passed_over: Vec::new(),
        };
        robot.wait_for("there");
        robot
    }

    /// Gives an order.
    ///
    /// # Panics
    /// If the robot has ended.
    pub fn order(&mut self, what: &str, mut how: Value) {
        how["do"] = json!(what);
        writeln!(self.orders, "{how}").unwrap();
    }

    /// The next that it says.
    ///
    /// # Panics
    /// If the robot ends or says nothing, or a message of the gateway made it fail.
    pub fn receive(&mut self) -> Value {
        if self.passed_over.is_empty() {
            self.read()
        } else {
            self.passed_over.remove(0)
        }
    }

    /// The next event of that name. Others that come before it are kept: topics reach
    /// the robot in no certain order.
    ///
    /// # Panics
    /// As [`Robot::receive`].
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

impl Drop for Robot {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
