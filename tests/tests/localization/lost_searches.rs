//! A search that is lost with one of its processes: the tracker does not wait for its result until
//! the timeout, but continues as soon as another process has taken over.

use std::path::PathBuf;

use messages::{HealthHeader, PoseHeader, ScanHeader, TrackState, topic};
use nix::sys::signal::{Signal, kill};
use tests::executables;
use tests::world::{World, as_the_graph_has_it};
use transport::testing::{Isolated, NodeProcess, wait_for, wait_for_health, wait_until_ready};
use transport::{Graph, Publisher, Subscriber};

/// A graph whose scans the test sends.
pub(super) struct Robot {
    pub(super) world: World,
    /// Maps that are served instead of the recording's own.
    maps: Option<PathBuf>,
    scans: Publisher<topic::Scan>,
    poses: Subscriber<topic::Tracked>,
    requests: Subscriber<topic::Attention>,
    health: Subscriber<topic::Health>,
    nodes: Vec<(&'static str, NodeProcess)>,
    pub(super) graph: Graph,
}

impl Robot {
    pub(super) fn start(isolated: &Isolated) -> Self {
        Self::start_on(isolated, None)
    }

    /// Starts the graph on several maps, if a file names some.
    pub(super) fn start_on(isolated: &Isolated, maps: Option<PathBuf>) -> Self {
        let graph = isolated.join("test");
        let mut robot = Robot {
            world: World::of("malaga_corridor"),
            maps,
            scans: graph.publisher().unwrap(),
            poses: graph.subscriber().unwrap(),
            requests: graph.subscriber().unwrap(),
            health: graph.subscriber().unwrap(),
            nodes: Vec::new(),
            graph,
        };
        robot.start_node("map_server");
        if robot.maps.is_none() {
            robot.start_node("boundary_extractor");
        }
        for node in ["accumulator", "peak_extractor", "tracker"] {
            robot.start_node(node);
            wait_until_ready(&robot.graph, node);
        }
        robot
    }

    fn start_node(&mut self, name: &'static str) {
        let (option, maps) = match &self.maps {
            Some(maps) => ("--maps", maps.clone()),
            None => ("--map", self.world.map()),
        };
        let arguments: &[&str] = match name {
            "map_server" => &[option, maps.to_str().unwrap()],
            "accumulator" if self.maps.is_none() => &["--search", "asked"],
            _ => &[],
        };
        let node = executables::start(name, &self.graph, arguments);
        self.nodes.push((name, node));
    }

    fn take(&mut self, name: &str) -> NodeProcess {
        let at = self.nodes.iter().position(|(node, _)| *node == name);
        self.nodes.remove(at.unwrap()).1
    }

    /// Sends the recording's scan of this number.
    pub(super) fn send(&self, counter: u64) -> ScanHeader {
        let scan = &self.world.scans()[counter as usize];
        let header = as_the_graph_has_it(scan, counter);
        self.scans.send(header, &scan.ranges).unwrap();
        header
    }

    /// Waits for the tracker's pose after this scan, and its words.
    pub(super) fn pose_after(&self, scan: &ScanHeader) -> (PoseHeader, String) {
        wait_for(&self.graph, &self.poses, |pose, words| {
            let words = String::from_utf8_lossy(words).into_owned();
            (pose.from_scan == 1 && pose.stamp == scan.stamp).then_some((*pose, words))
        })
    }

    /// Stops the graph, receivers first.
    pub(super) fn stop(&mut self) {
        for (_, node) in self.nodes.drain(..).rev() {
            node.stop();
        }
    }

    /// Waits until a search of this scan is requested.
    fn wait_for_request(&self, scan: &ScanHeader) {
        wait_for(&self.graph, &self.requests, |request, _| {
            (request.stamp == scan.stamp).then_some(())
        });
    }
}

/// Checks the case that the node with this name dies during a search.
fn check(victim: &'static str) {
    let isolated = Isolated::new(victim.get(..8).unwrap());
    let mut robot = Robot::start(&isolated);
    let lost = robot.take(victim);
    kill(lost.pid(), Signal::SIGSTOP).unwrap();
    let first = robot.send(0);
    robot.wait_for_request(&first);
    lost.kill();
    robot.start_node(victim);
    // The search is requested again; the new process does not know the scan.
    robot.wait_for_request(&first);
    wait_until_ready(&robot.graph, victim);
    let mut scan = robot.send(1);
    assert_eq!(
        robot.pose_after(&first).0.state,
        TrackState::Searching as u32
    );
    // The new process has no scan to search until it is sent one.
    for counter in 2.. {
        if robot.pose_after(&scan).0.state != TrackState::Searching as u32 {
            break;
        }
        scan = robot.send(counter);
    }
    // The last message of a node reaches only subscribers that have received from it before.
    wait_for_health(&robot.graph, &robot.health, |report| {
        report.node.as_str() == "tracker"
    });
    robot.stop();
    let is_last = |report: &HealthHeader| {
        report.node.as_str() == "tracker" && report.state == messages::NodeState::Stopped as u32
    };
    let (report, error) = wait_for_health(&robot.graph, &robot.health, is_last);
    // A tracker that gives up waiting would report it.
    assert_eq!((report.refused, error.as_str()), (0, ""));
}

#[test]
fn a_search_that_died_with_its_accumulator_is_not_waited_for() {
    check("accumulator");
}

#[test]
fn a_search_that_died_with_its_peak_extractor_is_not_waited_for() {
    check("peak_extractor");
}
