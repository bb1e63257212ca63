//! A graph with a gateway and a tracker that the test plays, for robots on Zenoh and on DDS.

use bytemuck::Zeroable;
use messages::{FrameName, NodeState, Pose2, PoseHeader, Stamp, TrackState, topic};
use tests::executables;
use tests::robot::Robot;
use transport::testing::{Isolated, NodeProcess, wait_until};
use transport::{Graph, Publisher};

/// The engine's nodes and the tracker.
pub(crate) const NODES: [&str; 4] = [
    "boundary_extractor",
    "accumulator",
    "peak_extractor",
    "tracker",
];

/// Starts these nodes; they are ready once they have a map.
pub(crate) fn start_nodes(graph: &Graph, nodes: &[&str]) -> Vec<NodeProcess> {
    let start = |name: &&str| executables::start(name, graph, &[]);
    nodes.iter().map(start).collect()
}

/// A graph with a gateway, and a robot in the same domain.
pub(crate) struct Joined {
    pub(crate) robot: Robot,
    pub(crate) gateway: Option<NodeProcess>,
    pub(crate) graph: Graph,
    #[allow(dead_code, reason = "gateways on Zenoh start once")]
    pub(crate) arguments: Vec<String>,
    // Declared after the graph, so that it is dropped after it.
    _isolated: Isolated,
}

impl Joined {
    /// Starts the gateway, and then the robot; returns `None` if the robot's libraries are missing.
    pub(crate) fn new(
        isolated: Isolated,
        arguments: &[&str],
        robot: impl FnOnce(&Graph) -> Option<Robot>,
    ) -> Option<Self> {
        let graph = isolated.join("test");
        let arguments: Vec<String> = arguments.iter().map(|word| (*word).to_owned()).collect();
        let gateway = Some(start_gateway(&graph, &arguments));
        Some(Joined {
            robot: robot(&graph)?,
            gateway,
            graph,
            arguments,
            _isolated: isolated,
        })
    }

    pub(crate) fn stop(&mut self) {
        self.gateway.take().unwrap().stop();
    }
}

pub(crate) fn start_gateway(graph: &Graph, arguments: &[String]) -> NodeProcess {
    NodeProcess::start(env!("CARGO_BIN_EXE_ros2_gateway"), graph, arguments)
}

/// Waits until the gateway reports that it waits, with these words among others.
pub(crate) fn wait_until_waiting(graph: &Graph, words: &str) {
    let health = graph.subscriber::<topic::Health>().unwrap();
    wait_until(graph, &health, |report, error| {
        let is_waiting = report.state == NodeState::Waiting as u32;
        let is_gateway = report.node.as_str() == "ros2_gateway";
        is_gateway && is_waiting && String::from_utf8_lossy(error).contains(words)
    });
}

pub(crate) fn pose2(x: f64, y: f64, yaw: f64) -> Pose2 {
    Pose2 { x, y, yaw }
}

/// Returns the pose of a tracker that is sure of it.
pub(crate) fn tracked(stamp: Stamp) -> PoseHeader {
    PoseHeader {
        stamp,
        map_id: 0xff,
        since_ns: 5_000_000_000,
        probability: 0.75,
        places: 1,
        state: TrackState::Unique as u32,
        from_scan: 1,
        pose_known: 1,
        mount_known: 1,
        odom_known: 1,
        odom_frame: FrameName::new("odom"),
        map_from_base: pose2(3.0, 1.0, 0.25),
        map_from_laser: pose2(3.5, 1.0, 0.25),
        map_from_odom: pose2(-2.0, 0.5, 0.25),
        base_covariance: [4e-4, 0.0, 0.0, 0.0, 1e-2, 0.0, 0.0, 0.0, 1e-6],
        ..PoseHeader::zeroed()
    }
}

pub(crate) fn poses_of(graph: &Graph) -> Publisher<topic::Tracked> {
    graph.publisher_for(PoseHeader::WORDS_CAPACITY).unwrap()
}
