//! Channels of the viewers, one for each ROS topic.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use foxglove::websocket::{ChannelView, Client, ServerListener};
use foxglove::{Context, PartialMetadata, RawChannel, Schema};
use recording::write::Encoded;
use ros::{OccupancyGridMsg, RosMessage};
use ros_graph::export::topics;

use crate::ServerError;
use crate::serving::Serving;

/// Encodings of messages and of their definitions.
const ENCODING: &str = "cdr";
const DEFINITIONS: &str = "ros2msg";

/// All channels. A topic is advertised from its first message on; the intensity image always,
/// because it is computed only while it is viewed.
#[derive(Debug)]
pub(crate) struct Channels {
    context: Arc<Context>,
    field: Arc<RawChannel>,
    open: Mutex<BTreeMap<Cow<'static, str>, Open>>,
}

#[derive(Debug)]
struct Open {
    channel: Arc<RawChannel>,
    /// Newest message of a latched topic, for late joiners.
    newest: Option<Encoded>,
}

impl Channels {
    /// Opens the image channel; others open on their first message.
    pub(crate) fn new(context: &Arc<Context>) -> Result<Self, ServerError> {
        let image = (OccupancyGridMsg::SCHEMA, OccupancyGridMsg::DEFINITION);
        // There are no viewers yet.
        let field = offer(context, topics::FIELD, image)?;
        let open = Open {
            channel: Arc::clone(&field),
            newest: None,
        };
        Ok(Channels {
            context: Arc::clone(context),
            field,
            open: Mutex::new(BTreeMap::from([(topics::FIELD.into(), open)])),
        })
    }

    pub(crate) fn is_field_viewed(&self) -> bool {
        self.field.has_sinks()
    }

    pub(crate) fn show(&self, serving: &Serving, message: Encoded) -> Result<(), ServerError> {
        if !self.open().contains_key(&message.topic) {
            let channel = self.offer(serving, &message)?;
            let newest = None;
            let opened = Open { channel, newest };
            self.open().insert(message.topic.clone(), opened);
        }
        if let Some(Open { channel, newest }) = self.open().get_mut(&message.topic) {
            channel.log_with_meta(&message.body, at(&message));
            if message.latched {
                *newest = Some(message);
            }
        }
        Ok(())
    }

    /// Opens the channel of a message. `open` must not be locked here, because a viewer that is
    /// served meanwhile may need it.
    fn offer(&self, serving: &Serving, message: &Encoded) -> Result<Arc<RawChannel>, ServerError> {
        let (context, topic) = (Arc::clone(&self.context), message.topic.clone());
        let schema = (message.schema, message.definition);
        let offered = serving.between(move || offer(&context, &topic, schema));
        offered.ok_or(ServerError::Thread)?
    }

    fn open(&self) -> MutexGuard<'_, BTreeMap<Cow<'static, str>, Open>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl ServerListener for Channels {
    fn on_subscribe(&self, client: Client, channel: ChannelView) {
        let open = self.open();
        let Some(Open { channel, newest }) = open.get(channel.topic()) else {
            return;
        };
        if let Some(newest) = newest {
            channel.log_with_meta_to_sink(&newest.body, at(newest), client.sink_id());
        }
    }
}

fn offer(
    context: &Arc<Context>,
    topic: &str,
    (name, definition): (&'static str, &'static str),
) -> Result<Arc<RawChannel>, ServerError> {
    let channel = context.channel_builder(topic).message_encoding(ENCODING);
    let schema = Schema::new(name, DEFINITIONS, definition.as_bytes());
    let channel = channel.schema(schema).build_raw();
    channel.map_err(|source| ServerError::Channel {
        topic: topic.to_owned(),
        source,
    })
}

fn at(message: &Encoded) -> PartialMetadata {
    // No message of ROS is from before 1970.
    PartialMetadata::with_log_time(message.log_time_ns.cast_unsigned())
}
