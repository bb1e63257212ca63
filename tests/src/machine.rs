//! Machines that run one graph together: each has a part of its nodes, and bridges join them.
//!
//! A machine is a graph of its own and, if a test wants it, a network namespace. Its bridge is
//! started separately, so that a run without it can be compared.

use std::path::{Path, PathBuf};

use tempfile::TempDir;
use transport::Graph;
use transport::testing::{Isolated, NodeProcess, wait_until_ready};

use crate::executables;
use crate::network::Namespace;

/// The machine with the laser and the map; its bridge's outputs are for subscribers to results
/// there.
pub const LASER: &str = "nodes:
  - {id: replayer, path: x, outputs: [scan, odometry]}
  - {id: map_server, path: x, outputs: [map]}
  - id: bridge
    path: x
    inputs: {scan: replayer/scan, map: map_server/map}
    outputs: [hypotheses, health]
";
/// The machine with the engine.
pub const ENGINE: &str = "nodes:
  - {id: peak_extractor, path: x, outputs: [hypotheses]}
  - id: bridge
    path: x
    inputs: {hypotheses: peak_extractor/hypotheses}
    outputs: [scan, map]
";
/// The machine that monitors.
pub const MONITOR: &str = "nodes:
  - {id: bridge, path: x, outputs: [map, hypotheses, health]}
";

pub struct Machine<'a> {
    /// Executable of its bridge.
    bridge: &'a str,
    /// Name of its robot.
    robot: &'a str,
    /// The test's own participant in the machine's graph.
    pub graph: Graph,
    place: Option<&'a Namespace>,
    folder: TempDir,
    // Declared after the graph, so that it is dropped after it.
    isolated: Isolated,
}

impl<'a> Machine<'a> {
    /// Makes a machine whose bridge executable `bridge` finds its ports in `descriptor`. It is in
    /// network `place`, or else in that of the test; `tag` is that of [`Isolated::new`].
    pub fn new(tag: &str, bridge: &'a str, descriptor: &str, place: Option<&'a Namespace>) -> Self {
        let isolated = Isolated::new(tag);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("dataflow.yaml"), descriptor).unwrap();
        Machine {
            bridge,
            robot: "r1",
            graph: isolated.join("test"),
            place,
            folder,
            isolated,
        }
    }

    /// Changes the name of the robot, which is `r1` by default.
    pub fn of_robot(mut self, robot: &'a str) -> Self {
        self.robot = robot;
        self
    }

    /// Returns the machine's graph, for others to join.
    pub fn isolated(&self) -> &Isolated {
        &self.isolated
    }

    /// Returns an endpoint on the test's loopback that no other machine has.
    pub fn loopback(&self) -> String {
        format!("tcp/{}:7447", self.isolated.name().loopback())
    }

    pub fn start(&self, node: &str, arguments: &[&str]) -> NodeProcess {
        let executable = executables::path(node);
        self.run(executable.to_str().unwrap(), arguments)
    }

    fn run(&self, executable: &str, arguments: &[&str]) -> NodeProcess {
        match self.place {
            Some(place) => place.start(&self.graph, executable, arguments),
            None => NodeProcess::start(executable, &self.graph, arguments),
        }
    }

    /// Starts its bridge with further arguments.
    pub fn bridge(&self, network: &[&str]) -> NodeProcess {
        let descriptor = self.folder.path().join("dataflow.yaml");
        let descriptor = descriptor.to_str().unwrap();
        let common = ["--robot", self.robot, "--dataflow", descriptor];
        self.run(self.bridge, &[&common[..], network].concat())
    }

    /// Starts its bridge, and waits until it has joined the network.
    pub fn joined_bridge(&self, network: &[&str]) -> NodeProcess {
        let bridge = self.bridge(network);
        wait_until_ready(&self.graph, "bridge");
        bridge
    }

    /// Starts the three nodes that locate scans.
    pub fn engine(&self) -> Vec<NodeProcess> {
        let nodes = ["boundary_extractor", "accumulator", "peak_extractor"];
        nodes.map(|node| self.start(node, &[])).into()
    }

    pub fn map_server(&self, map: &Path) -> NodeProcess {
        self.start("map_server", &["--map", map.to_str().unwrap()])
    }

    /// Starts the player of a recording with further arguments.
    pub fn replayer(&self, recording: &Path, arguments: &[&str]) -> NodeProcess {
        let recording = ["--recording", recording.to_str().unwrap()];
        self.start("replayer", &[&recording[..], arguments].concat())
    }

    /// Copies a map and its image, so that the test may change them.
    pub fn copy_of_map(&self, map: &Path) -> PathBuf {
        let from = map.parent().unwrap();
        for file in ["map.yaml", "map.png"] {
            std::fs::copy(from.join(file), self.folder.path().join(file)).unwrap();
        }
        self.folder.path().join("map.yaml")
    }
}
