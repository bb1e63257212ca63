//! The schemas and channels that a recording defines.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::fields::BadField;
use crate::{Damage, Kind, layout};

/// A channel of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// Its name.
    pub topic: Arc<str>,
    /// The schema's name; empty where it has none.
    pub schema: String,
    /// How its messages are encoded; `cdr` in ROS 2.
    pub encoding: String,
    /// What its messages are decoded as; `None` where they are only counted.
    pub kind: Option<Kind>,
    /// Readable messages.
    pub messages: u64,
}

/// All channels by number, each complete when the first message refers to it.
#[derive(Debug, Default)]
pub(crate) struct Registry {
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, (u16, Channel)>,
}

impl Registry {
    pub(crate) fn channel(&self, id: u16) -> Option<&Channel> {
        self.channels.get(&id).map(|(_, channel)| channel)
    }

    pub(crate) fn channels(&self) -> impl Iterator<Item = &Channel> {
        self.channels.values().map(|(_, channel)| channel)
    }

    /// Counts messages of a channel that is there.
    pub(crate) fn count(&mut self, id: u16, messages: u64) {
        if let Some((_, channel)) = self.channels.get_mut(&id) {
            channel.messages += messages;
        }
    }

    /// Takes a schema record; a repetition must be equal.
    pub(crate) fn add_schema(&mut self, body: &[u8], at: u64) -> Result<(), Damage> {
        let schema = layout::schema(body).map_err(|bad| damaged(at, "schema", bad))?;
        match self.schemas.get(&schema.id) {
            Some(name) if name != schema.name => Err(Damage::Conflict {
                at,
                kind: "schema",
                id: schema.id,
            }),
            Some(_) => Ok(()),
            None => {
                self.schemas.insert(schema.id, schema.name.to_owned());
                Ok(())
            }
        }
    }

    /// Takes a channel record; a repetition must be equal.
    pub(crate) fn add_channel(&mut self, body: &[u8], at: u64) -> Result<(), Damage> {
        let record = layout::channel(body).map_err(|bad| damaged(at, "channel", bad))?;
        if let Some((schema, known)) = self.channels.get(&record.id) {
            let is_equal = *schema == record.schema
                && &*known.topic == record.topic
                && known.encoding == record.encoding;
            return match is_equal {
                true => Ok(()),
                false => Err(Damage::Conflict {
                    at,
                    kind: "channel",
                    id: record.id,
                }),
            };
        }
        let schema = match (record.schema, self.schemas.get(&record.schema)) {
            (0, _) => "",
            (_, Some(name)) => name,
            (id, None) => {
                return Err(Damage::Undefined {
                    at,
                    kind: "channel",
                    missing: "schema",
                    id,
                });
            }
        };
        let channel = Channel {
            topic: record.topic.into(),
            schema: schema.to_owned(),
            encoding: record.encoding.to_owned(),
            kind: Kind::of(schema, record.topic),
            messages: 0,
        };
        self.channels.insert(record.id, (record.schema, channel));
        Ok(())
    }
}

/// The damage that a bad field is.
pub(crate) fn damaged(at: u64, kind: &'static str, bad: BadField) -> Damage {
    Damage::Record {
        at,
        kind,
        reason: bad.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Vec<u8> {
        [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
    }

    fn schema(id: u16, name: &str) -> Vec<u8> {
        [&id.to_le_bytes()[..], &text(name), &text("ros2msg")].concat()
    }

    fn channel(id: u16, schema: u16, topic: &str) -> Vec<u8> {
        let ids = [id.to_le_bytes(), schema.to_le_bytes()].concat();
        [&ids[..], &text(topic), &text("cdr")].concat()
    }

    #[test]
    fn channels_take_their_kind_from_their_schema() {
        let mut registry = Registry::default();
        let scan = schema(1, "sensor_msgs/msg/LaserScan");
        registry.add_schema(&scan, 0).unwrap();
        registry.add_channel(&channel(4, 1, "/scan"), 0).unwrap();
        registry.add_channel(&channel(5, 0, "/raw"), 0).unwrap();
        // Both are repeated in the summary.
        registry.add_schema(&scan, 0).unwrap();
        registry.add_channel(&channel(4, 1, "/scan"), 0).unwrap();
        registry.count(4, 3);

        let found = registry.channel(4).unwrap();
        assert_eq!((found.kind, found.messages), (Some(Kind::Scan), 3));
        assert_eq!(registry.channel(5).unwrap().kind, None);
        assert_eq!(registry.channels().count(), 2);
    }

    #[test]
    fn contradictions_are_damage() {
        let mut registry = Registry::default();
        registry.add_schema(&schema(1, "a"), 0).unwrap();
        registry.add_channel(&channel(4, 1, "/scan"), 0).unwrap();
        assert!(matches!(
            registry.add_schema(&schema(1, "b"), 9),
            Err(Damage::Conflict {
                at: 9,
                kind: "schema",
                id: 1
            })
        ));
        assert!(matches!(
            registry.add_channel(&channel(4, 1, "/scam"), 9),
            Err(Damage::Conflict {
                at: 9,
                kind: "channel",
                id: 4
            })
        ));
        assert!(matches!(
            registry.add_channel(&channel(6, 2, "/b"), 9),
            Err(Damage::Undefined {
                missing: "schema",
                id: 2,
                ..
            })
        ));
        assert!(matches!(
            registry.add_channel(b"\x01", 9),
            Err(Damage::Record {
                at: 9,
                kind: "channel",
                ..
            })
        ));
    }
}
