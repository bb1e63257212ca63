//! A graph that belongs to one test, with the node as a process in it.
#![allow(
    clippy::unwrap_used,
    reason = "the lint spares test functions but not what they share"
)]

use std::process::{Child, Command};
use std::time::Duration;

use messages::{HealthHeader, Topic, topic};
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use transport::{
    Flow, GRAPH_VARIABLE, Graph, GraphName, Subscriber, TransportError, remove_leftovers,
};

/// A name that no other test and no other run uses; what the graph leaves is
/// removed in the end. To be declared first, so that it is dropped last.
pub(crate) struct Isolated {
    pub(crate) name: GraphName,
}

impl Isolated {
    /// `tag` tells the tests of one executable apart, in at most 11 bytes.
    pub(crate) fn new(tag: &str) -> Self {
        let name = GraphName::new(&format!("t{}-{tag}", std::process::id())).unwrap();
        Isolated { name }
    }

    /// The test's own membership.
    pub(crate) fn join(&self) -> Graph {
        Graph::join_named("test", &self.name).unwrap()
    }
}

impl Drop for Isolated {
    fn drop(&mut self) {
        let outcome = remove_leftovers(&self.name);
        if !std::thread::panicking() {
            outcome.unwrap();
        }
    }
}

/// The node, killed if the test fails before it is stopped.
pub(crate) struct Node(Child);

impl Node {
    pub(crate) fn start(graph: &Graph, arguments: &[&str]) -> Node {
        let child = Command::new(env!("CARGO_BIN_EXE_boundary_extractor"))
            .args(arguments)
            .env(GRAPH_VARIABLE, graph.name().as_str())
            .env_remove("RUST_LOG")
            .spawn();
        Node(child.unwrap())
    }

    /// Asks it to end, which is no failure.
    pub(crate) fn stop(mut self) {
        kill(Pid::from_raw(self.0.id().cast_signed()), Signal::SIGTERM).unwrap();
        assert!(self.0.wait().unwrap().success());
    }
}

impl Drop for Node {
    fn drop(&mut self) {
        // Where it was stopped already, this finds nothing to do.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Waits for a message of which `take` makes something, and returns that.
/// Meanwhile the test's latched topics are served.
pub(crate) fn wait_for<T: Topic, R>(
    graph: &Graph,
    subscriber: &Subscriber<T>,
    mut take: impl FnMut(&T::Header, &[T::Item]) -> Option<R>,
) -> R {
    let mut taken = None;
    graph
        .run(&[subscriber], Duration::from_millis(20), |_| {
            while let Some(sample) = subscriber.receive()? {
                taken = take(sample.header(), sample.items());
                if taken.is_some() {
                    return Ok::<_, TransportError>(Flow::Stop);
                }
            }
            Ok(Flow::Continue)
        })
        .unwrap();
    taken.unwrap()
}

/// Waits for a report of the node that `is_awaited`; returns it and its last
/// error.
pub(crate) fn wait_for_health(
    graph: &Graph,
    health: &Subscriber<topic::Health>,
    is_awaited: impl Fn(&HealthHeader) -> bool,
) -> (HealthHeader, String) {
    wait_for(graph, health, |report, error| {
        is_awaited(report).then(|| (*report, String::from_utf8(error.to_vec()).unwrap()))
    })
}
