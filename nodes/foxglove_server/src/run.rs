//! Subscribes to the graph and shows its messages.

use std::sync::Arc;
use std::time::Duration;

use foxglove::{Context, WebSocketServerHandle};
use messages::{NodeState, topic};
use ros_export::{Entry, Inputs, Listener, Transcript};
use tokio::runtime::Handle;
use transport::{Flow, Graph, Subscriber};

use crate::channels::Channels;
use crate::serving::Serving;
use crate::{Config, ServerError};

/// Longest delay of an image and of a health report.
const TICK: Duration = Duration::from_millis(50);

/// Number of messages queued for each viewer; beyond it the oldest ones are dropped.
const BACKLOG: usize = 256;

/// Serves viewers until the stop flag is set.
///
/// # Errors
/// If it cannot listen, or the transport fails.
pub fn run(graph: &Graph, config: &Config) -> Result<(), ServerError> {
    let context = Context::new();
    let serving = Serving::start().map_err(ServerError::Start)?;
    let channels = Arc::new(Channels::new(&context)?);
    let server = start((&context, serving.handle()), &channels, config)?;
    let inputs = Inputs::open(graph, false)?;
    let mut node = Node {
        transcript: Transcript::new(graph, &config.transcript)?,
        channels,
        serving,
        field: None,
    };
    node.transcript.health.state(NodeState::Ready)?;
    let outcome = graph.run(&inputs.all(), TICK, |wake| {
        node.step(graph, &inputs, wake.tick)?;
        Ok(Flow::Continue)
    });
    server.stop().wait_blocking();
    outcome
}

fn start(
    (context, handle): (&Arc<Context>, &Handle),
    channels: &Arc<Channels>,
    config: &Config,
) -> Result<WebSocketServerHandle, ServerError> {
    let listen = config.listen;
    let server = context
        .websocket_server()
        .name(config.robot())
        .bind(listen.ip().to_string(), listen.port())
        .listener(Arc::clone(channels) as _)
        .message_backlog_size(BACKLOG)
        .tokio_runtime(handle)
        .start_blocking();
    let server = server.map_err(|source| ServerError::Listen {
        address: listen,
        source,
    })?;
    let mut address = listen;
    address.set_port(server.port());
    tracing::info!("watch it in Foxglove or Lichtblick: open a connection to ws://{address}");
    Ok(server)
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
