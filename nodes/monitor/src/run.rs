//! Subscribes to the graph and feeds the server.

mod inputs;
mod launcher;
mod outputs;

use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::Duration;

use dashboard::{Request, Robot, Robots, Server};
use messages::{NodeState, topic};
use transport::{Flow, Graph, Health, Subscriber, TransportError, monotonic_ns};

use crate::{Config, MonitorError};
use inputs::Inputs;
use launcher::Launcher;
use outputs::Outputs;

/// Longest delay for a request, an image and the detection of a silent node.
const TICK: Duration = Duration::from_millis(50);

/// Serves the page until the stop flag is set.
pub fn run(graph: &Graph, config: &Config) -> Result<(), MonitorError> {
    let (robot, requests) = Robot::new(config.robot.clone(), Some(graph.name().to_string()));
    let inputs = Inputs::open(graph)?;
    let mut node = Node {
        robot: Arc::clone(&robot),
        requests,
        field: None,
        outputs: Outputs::open(graph)?,
        launcher: Launcher::of(graph, &robot),
        health: graph.health()?,
    };
    let robots = Robots::default();
    robots.add(robot);
    let server = Server::start(config.listen, &config.page, robots)?;
    server.announce("watch it", config.listen);
    // A request of a previous monitor is not known here, so it is withdrawn.
    node.outputs.region(&[])?;
    node.health.state(NodeState::Ready)?;
    graph.run(&inputs.all(), TICK, |wake| {
        server.check()?;
        node.step(graph, &inputs, wake.tick)?;
        Ok(Flow::Continue)
    })
}

struct Node {
    robot: Arc<Robot>,
    requests: Receiver<Request>,
    /// Subscription to the image, which is computed only while it is viewed.
    field: Option<Subscriber<topic::Field>>,
    outputs: Outputs,
    launcher: Launcher,
    health: Health,
}

impl Node {
    fn step(&mut self, graph: &Graph, inputs: &Inputs, tick: bool) -> Result<(), TransportError> {
        inputs.take(&self.robot, &mut self.health)?;
        if tick {
            self.follow_field(graph)?;
            self.handle_requests()?;
            let abilities = self.outputs.abilities(self.launcher.is_there());
            self.robot.on_abilities(abilities);
            self.robot.look_for_silence(monotonic_ns());
        }
        self.health.tick()
    }

    fn follow_field(&mut self, graph: &Graph) -> Result<(), TransportError> {
        match (self.robot.is_field_viewed(), &self.field) {
            (true, None) => self.field = Some(graph.subscriber()?),
            (false, Some(_)) => self.field = None,
            _ => {}
        }
        let newest = self.field.as_ref().map_or(Ok(None), Subscriber::newest)?;
        if let Some(image) = newest {
            self.health.count_received(1);
            if !self.robot.on_field(image.header(), image.items()) {
                inputs::refuse(&mut self.health, "the image contradicts its header")?;
            }
        }
        Ok(())
    }

    fn handle_requests(&mut self) -> Result<(), TransportError> {
        while let Ok(request) = self.requests.try_recv() {
            match request {
                Request::Region(corners) => {
                    tracing::info!(corners = corners.len(), "search region set");
                    self.outputs.region(&corners)?;
                    self.robot.on_region(corners);
                }
                Request::Hint(pose) => {
                    let (x, y, yaw) = (pose.x, pose.y, pose.yaw);
                    tracing::info!(x, y, yaw, "hint for the tracker");
                    self.outputs.hint(pose)?;
                }
                Request::Restart(node) => {
                    tracing::info!("asking the launcher to restart {node}");
                    self.launcher.restart(&node);
                }
                Request::Record(on) => {
                    let what = if on { "start" } else { "stop" };
                    tracing::info!("asking the launcher to {what} a recording");
                    self.launcher.record(on);
                }
                Request::Save => {
                    tracing::info!("asking the recorder to save the last minutes");
                    self.outputs.save()?;
                }
            }
            self.health.count_sent(1);
        }
        Ok(())
    }
}
