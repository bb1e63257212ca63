//! The schemas and channels that a recording defines.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use mcap::McapError;
use mcap::read::ChannelAccumulator;
use mcap::records::Record;
use ros::Cloud;

use crate::parse::{parse, reason};
use crate::{Damage, Kind};

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    pub topic: Arc<str>,
    /// Name of its schema; empty if it has none.
    pub schema: String,
    /// Encoding of its messages; `cdr` in ROS 2.
    pub encoding: String,
    /// Type that its messages are decoded as; `None` if they are only counted.
    pub kind: Option<Kind>,
    /// Number of readable messages.
    pub messages: u64,
}

impl Channel {
    pub(crate) fn is_cloud(&self, topic: &str) -> bool {
        *self.topic == *topic && Cloud::is_schema(&self.schema)
    }

    pub(crate) fn take_cloud(&mut self, topic: &str) {
        if self.is_cloud(topic) {
            self.kind = Some(Kind::Scan);
        }
    }
}

/// All channels by id, each complete before the first message refers to it.
#[derive(Debug, Default)]
pub(crate) struct Registry {
    /// Links channels to schemas, and rejects repetitions that differ.
    known: ChannelAccumulator<'static>,
    channels: BTreeMap<u16, Channel>,
}

impl Registry {
    pub(crate) fn channel(&self, id: u16) -> Option<&Channel> {
        self.channels.get(&id)
    }

    pub(crate) fn channels(&self) -> impl Iterator<Item = &Channel> {
        self.channels.values()
    }

    /// Schema texts in ROS 2's `ros2msg` format, by schema name.
    pub(crate) fn definitions(&self) -> impl Iterator<Item = (String, String)> {
        self.channels.keys().filter_map(|id| {
            let schema = self.known.get(*id)?.schema.clone()?;
            let text = String::from_utf8(schema.data.to_vec()).ok()?;
            (schema.encoding == "ros2msg").then(|| (schema.name.clone(), text))
        })
    }

    pub(crate) fn count(&mut self, id: u16, messages: u64) {
        if let Some(channel) = self.channels.get_mut(&id) {
            channel.messages += messages;
        }
    }

    pub(crate) fn take_cloud(&mut self, topic: &str) {
        for channel in self.channels.values_mut() {
            channel.take_cloud(topic);
        }
    }

    /// Adds a schema or channel record that starts at byte `at`, or whose chunk starts there.
    pub(crate) fn add(&mut self, opcode: u8, body: &[u8], at: u64) -> Result<(), Damage> {
        match parse(opcode, body, at)? {
            Record::Schema { header, data } => {
                let id = header.id;
                self.known
                    .add_schema_from_slice(header, &data)
                    .map_err(|error| refused(&error, at, "schema", id))
            }
            Record::Channel(channel) => {
                let id = channel.id;
                self.known
                    .add_channel(channel)
                    .map_err(|error| refused(&error, at, "channel", id))?;
                self.list(id);
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn list(&mut self, id: u16) {
        if let (Entry::Vacant(free), Some(known)) = (self.channels.entry(id), self.known.get(id)) {
            let schema = known.schema.as_ref().map_or("", |schema| &schema.name);
            free.insert(Channel {
                topic: known.topic.as_str().into(),
                schema: schema.to_owned(),
                encoding: known.message_encoding.clone(),
                kind: Kind::of(schema, &known.topic),
                messages: 0,
            });
        }
    }
}

fn refused(error: &McapError, at: u64, kind: &'static str, id: u16) -> Damage {
    match *error {
        McapError::ConflictingSchemas(_) | McapError::ConflictingChannels(_) => Damage::Other(
            format!("the {kind} record at byte {at} defines number {id} again, differently"),
        ),
        McapError::UnknownSchema(_, id) => undefined(at, kind, "schema", id),
        ref other => Damage::Record {
            at,
            kind,
            reason: reason(other),
        },
    }
}

/// Damage of a record at byte `at`, or in the chunk there, that refers to what no record before it
/// defines.
pub(crate) fn undefined(at: u64, kind: &str, missing: &str, id: u16) -> Damage {
    Damage::Other(format!(
        "the {kind} record at byte {at} refers to {missing} {id}, which is not defined before it"
    ))
}

#[cfg(test)]
mod tests {
    use mcap::records::op;

    use super::*;

    fn text(text: &str) -> Vec<u8> {
        [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
    }

    fn schema(id: u16, name: &str) -> Vec<u8> {
        [
            &id.to_le_bytes()[..],
            &text(name),
            &text("ros2msg"),
            &[0; 4],
        ]
        .concat()
    }

    fn channel(id: u16, schema: u16, topic: &str) -> Vec<u8> {
        let ids = [id.to_le_bytes(), schema.to_le_bytes()].concat();
        [&ids[..], &text(topic), &text("cdr"), &[0; 4]].concat()
    }

    #[test]
    fn channels_take_their_kind_from_their_schema() {
        let mut registry = Registry::default();
        let scan = schema(1, "sensor_msgs/msg/LaserScan");
        // The summary repeats both.
        for _ in 0..2 {
            registry.add(op::SCHEMA, &scan, 0).unwrap();
            let on_scan = channel(4, 1, "/scan");
            registry.add(op::CHANNEL, &on_scan, 0).unwrap();
        }
        let raw = channel(5, 0, "/raw");
        registry.add(op::CHANNEL, &raw, 0).unwrap();
        registry.count(4, 3);

        let found = registry.channel(4).unwrap();
        assert_eq!((found.kind, found.messages), (Some(Kind::Scan), 3));
        assert_eq!(registry.channel(5).unwrap().kind, None);
        assert_eq!(registry.channels().count(), 2);
    }

    #[test]
    fn contradictions_are_damage() {
        let mut registry = Registry::default();
        registry.add(op::SCHEMA, &schema(1, "a"), 0).unwrap();
        registry
            .add(op::CHANNEL, &channel(4, 1, "/scan"), 0)
            .unwrap();
        for (opcode, body, expected) in [
            (
                op::SCHEMA,
                schema(1, "b"),
                "the schema record at byte 9 defines number 1 again, differently",
            ),
            (
                op::CHANNEL,
                channel(4, 1, "/scam"),
                "the channel record at byte 9 defines number 4 again, differently",
            ),
            (
                op::CHANNEL,
                channel(6, 2, "/b"),
                "refers to schema 2, which is not defined before it",
            ),
            (
                op::CHANNEL,
                b"\x01".to_vec(),
                "the channel record at byte 9 is damaged",
            ),
        ] {
            let damage = registry.add(opcode, &body, 9).unwrap_err().to_string();
            assert!(damage.contains(expected), "{damage}");
        }
    }
}
