//! Machines that run one graph between them: each has a part of its nodes, joined
//! by bridges.
//!
//! A machine is a graph of its own and, where a test wants it, a network namespace.
//! Its bridge is started by itself, so that a run without it can be compared.

use std::path::{Path, PathBuf};

use tempfile::TempDir;
use transport::Graph;
use transport::testing::{Isolated, NodeProcess, wait_until_ready};

use crate::executables;
use crate::network::Namespace;

/// The machine with the laser and the map; what comes in is for whoever waits for
/// answers there.
pub const LASER: &str = "nodes:
  - {id: replayer, path: x, outputs: [scan, odometry]}
  - {id: map_server, path: x, outputs: [map]}
  - id: bridge
    path: x
    inputs: {scan: replayer/scan, map: map_server/map}
    outputs: [hypotheses, health]
";
/// The one with the engine.
pub const ENGINE: &str = "nodes:
  - {id: peak_extractor, path: x, outputs: [hypotheses]}
  - id: bridge
    path: x
    inputs: {hypotheses: peak_extractor/hypotheses}
    outputs: [scan, map]
";
/// The one that watches.
pub const MONITOR: &str = "nodes:
  - {id: bridge, path: x, outputs: [map, hypotheses, health]}
";

/// One machine.
pub struct Machine<'a> {
    /// The executable of its bridge.
    bridge: &'a str,
    /// What its robot is called.
    robot: &'a str,
    /// The test's own membership of the machine's graph.
    pub graph: Graph,
    place: Option<&'a Namespace>,
    folder: TempDir,
    // Behind the graph, so that it is dropped after it.
    isolated: Isolated,
}

impl<'a> Machine<'a> {
    /// A machine whose `bridge`, an executable, finds its ports in `descriptor`, in
    /// the network that is given, else in that of the test. `tag` is as for
    /// [`Isolated::new`].
    ///
    /// # Panics
    /// If there is no place for temporary files.
    #[must_use]
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

    /// The same of another robot than `r1`.
    #[must_use]
    pub fn of_robot(mut self, robot: &'a str) -> Self {
        self.robot = robot;
        self
    }

    /// The machine's graph, for others who join it.
    #[must_use]
    pub fn isolated(&self) -> &Isolated {
        &self.isolated
    }

    /// An endpoint on the test's loopback that no other machine has.
    #[must_use]
    pub fn loopback(&self) -> String {
        format!("tcp/{}:7447", self.isolated.name().loopback())
    }

    /// Starts a node.
    #[must_use]
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

    /// Starts its bridge, with more arguments.
    #[must_use]
    pub fn bridge(&self, network: &[&str]) -> NodeProcess {
        let descriptor = self.folder.path().join("dataflow.yaml");
        let descriptor = descriptor.to_str().unwrap();
        let common = ["--robot", self.robot, "--dataflow", descriptor];
        self.run(self.bridge, &[&common[..], network].concat())
    }

    /// The same, and waits until it has joined the network.
    #[must_use]
    pub fn joined_bridge(&self, network: &[&str]) -> NodeProcess {
        let bridge = self.bridge(network);
        wait_until_ready(&self.graph, "bridge");
        bridge
    }

    /// Starts the three nodes that find places.
    #[must_use]
    pub fn engine(&self) -> Vec<NodeProcess> {
        let nodes = ["boundary_extractor", "accumulator", "peak_extractor"];
        nodes.map(|node| self.start(node, &[])).into()
    }

    /// Starts the server of a map.
    #[must_use]
    pub fn map_server(&self, map: &Path) -> NodeProcess {
        self.start("map_server", &["--map", map.to_str().unwrap()])
    }

    /// Starts the player of a recording, with more arguments.
    #[must_use]
    pub fn replayer(&self, recording: &Path, arguments: &[&str]) -> NodeProcess {
        let recording = ["--recording", recording.to_str().unwrap()];
        self.start("replayer", &[&recording[..], arguments].concat())
    }

    /// A copy of a map and its image that the test may change.
    ///
    /// # Panics
    /// If it cannot be copied.
    #[must_use]
    pub fn copy_of_map(&self, map: &Path) -> PathBuf {
        let from = map.parent().unwrap();
        for file in ["map.yaml", "map.png"] {
            std::fs::copy(from.join(file), self.folder.path().join(file)).unwrap();
        }
        self.folder.path().join("map.yaml")
    }
}
