//! A ROS 2 robot, by libraries of others in Python.

use std::io::{BufRead, BufReader, Lines, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::{Value, json};

use crate::needs::Need;
use crate::python;

/// What it is made of, and their versions.
pub const LIBRARIES: [&str; 3] = [
    "eclipse-zenoh==1.10.2",
    "rosbags==0.11.9",
    "zenoh-ros2-sdk==0.1.8",
];

/// A process that executes commands, killed if the test fails.
pub struct Robot {
    process: Child,
    orders: ChildStdin,
    said: Lines<BufReader<ChildStdout>>,
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
        let mut process = Command::new(python)
            .args(["-c", include_str!("robot.py"), endpoint])
            .arg(recording)
            .arg(namespace)
            .env_remove("ROS_DOMAIN_ID")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let orders = process.stdin.take().unwrap();
        let said = BufReader::new(process.stdout.take().unwrap()).lines();
        let mut robot = Robot {
            process,
            orders,
            said,
        };
        robot.wait_for("there");
        Some(robot)
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
    /// If the robot ends, or a message of the gateway made it fail.
    pub fn receive(&mut self) -> Value {
        let line = self.said.next().expect("the robot has ended").unwrap();
        let said: Value = serde_json::from_str(&line).unwrap();
        assert_ne!(said["event"], "failed", "{said}");
        said
    }

    /// The next event of that name; others are passed over.
    ///
    /// # Panics
    /// As [`Robot::receive`].
    pub fn wait_for(&mut self, event: &str) -> Value {
        loop {
            let said = self.receive();
            if said["event"] == event {
                return said;
            }
        }
    }
}

impl Drop for Robot {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
