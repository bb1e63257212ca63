//! Subscribes to the graph and shows its messages.

use std::sync::Arc;
use std::time::Duration;

use foxglove::Context;
use messages::{NodeState, topic};
use ros_graph::export::{Entry, Inputs, Listener, Transcript};
use transport::{Flow, Graph, Subscriber};

use crate::channels::Channels;
use crate::listening::Listening;
use crate::serving::Serving;
use crate::{Config, ServerError};

/// Longest delay of an image and of a health report.
const TICK: Duration = Duration::from_millis(50);

/// Serves viewers until the stop flag is set.
pub fn run(graph: &Graph, config: &Config) -> Result<(), ServerError> {
    let context = Context::new();
    let serving = Serving::start().map_err(ServerError::Start)?;
    let channels = Arc::new(Channels::new(&context)?);
    let mut listening = Listening::start(&context, serving.handle(), &channels, config)?;
    let inputs = Inputs::open(graph, false)?;
    let mut node = Node {
        transcript: Transcript::new(graph, &config.transcript)?,
        channels,
        serving,
        field: None,
    };
    node.transcript.health.state(NodeState::Ready)?;
    let outcome = graph.run(&inputs.all(), TICK, |wake| {
        if let Some(problem) = listening.check() {
            tracing::warn!("{problem}");
            node.transcript.health.error(&problem)?;
        }
        node.step(graph, &inputs, wake.tick)?;
        Ok(Flow::Continue)
    });
    listening.stop();
    outcome
}

struct Node {
    transcript: Transcript,
    channels: Arc<Channels>,
    serving: Serving,
    /// Subscription to the image, which is computed only while it is viewed.
    field: Option<Subscriber<topic::Field>>,
}

impl Node {
    fn step(&mut self, graph: &Graph, inputs: &Inputs, tick: bool) -> Result<(), ServerError> {
        inputs.take(self)?;
        if tick {
            self.follow_field(graph)?;
        }
        let mut shown = 0;
        for entry in self.transcript.entries.take() {
            if let Entry::Message(message) = entry {
                self.channels.show(&self.serving, message)?;
                shown += 1;
            }
        }
        self.transcript.health.count_sent(shown);
        Ok(self.transcript.health.tick()?)
    }

    fn follow_field(&mut self, graph: &Graph) -> Result<(), ServerError> {
        match (self.channels.is_field_viewed(), &self.field) {
            (true, None) => self.field = Some(graph.subscriber()?),
            (false, Some(_)) => self.field = None,
            _ => {}
        }
        let newest = self.field.as_ref().map_or(Ok(None), Subscriber::newest)?;
        if let Some(image) = newest {
            let outcome = self.transcript.entries.field(image.header(), image.items());
            self.transcript.taken(0, outcome)?;
        }
        Ok(())
    }
}

impl Listener for Node {
    type Error = ServerError;

    fn transcript(&mut self) -> &mut Transcript {
        &mut self.transcript
    }
}
