//! Contents of a recording.

use std::collections::BTreeMap;

use recording::{Kind, MetadataRecord, Recording};
use schemars::JsonSchema;
use serde::Serialize;

/// Statistics of a recording. Stamps are nanoseconds since 1970.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Contents {
    pub recording: String,
    pub bytes: u64,
    pub messages: u64,
    pub first_ns: Option<i64>,
    pub last_ns: Option<i64>,
    pub chunks: usize,
    pub channels: Vec<Channel>,
    /// Topics that the commands use, by content.
    pub taken: BTreeMap<&'static str, String>,
    /// Reasons why the choice of a topic is ambiguous.
    pub unclear: Vec<String>,
    #[schemars(with = "Vec<Metadata>")]
    pub metadata: Vec<MetadataRecord>,
    pub attachments: Vec<Attachment>,
    /// Damage of the file; everything else describes the part before it.
    pub damage: Option<String>,
}

/// Named key-value entries.
// Stands for [`MetadataRecord`], whose crate does not depend on `schemars`.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "only its schema is used")]
struct Metadata {
    name: String,
    entries: BTreeMap<String, String>,
}

#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Channel {
    pub topic: String,
    pub schema: String,
    pub encoding: String,
    pub messages: u64,
    /// Messages per second over the whole recording; `None` for fewer than two messages.
    pub hz: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct Attachment {
    pub name: String,
    pub media_type: String,
    pub bytes: usize,
}

impl Contents {
    pub(crate) fn of(recording: &Recording) -> Self {
        let range = recording.time_range_ns();
        let seconds = range.map_or(0.0, |(first, last)| {
            last.saturating_sub(first) as f64 * 1e-9
        });
        Contents {
            recording: recording.path().display().to_string(),
            bytes: recording.size(),
            messages: recording.messages(),
            first_ns: range.map(|(first, _)| first),
            last_ns: range.map(|(_, last)| last),
            chunks: recording.chunks(),
            channels: channels(recording, seconds),
            taken: taken(recording),
            unclear: unclear(recording),
            metadata: recording.metadata().to_vec(),
            attachments: recording.attachments().iter().map(attachment).collect(),
            damage: damage(recording),
        }
    }
}

const TAKEN: [(&str, Kind); 3] = [
    ("scans", Kind::Scan),
    ("map", Kind::Map),
    ("odometry", Kind::Odometry),
];

fn taken(recording: &Recording) -> BTreeMap<&'static str, String> {
    let topic = |(what, kind)| Some((what, recording.topic(kind).ok()??.to_string()));
    TAKEN.into_iter().filter_map(topic).collect()
}

fn unclear(recording: &Recording) -> Vec<String> {
    let error = |(_, kind)| recording.topic(kind).err();
    let errors = TAKEN.into_iter().filter_map(error);
    errors.map(|error| error.to_string()).collect()
}

/// Describes the damage; if there are several files, names the damaged one.
fn damage(recording: &Recording) -> Option<String> {
    match recording.file_count() {
        1 => recording.damage().map(ToString::to_string),
        _ => recording.damage_error().map(|error| error.to_string()),
    }
}

/// Channels sorted by topic; a topic that is defined several times is listed several times.
fn channels(recording: &Recording, seconds: f64) -> Vec<Channel> {
    let channel = |channel: &recording::Channel| Channel {
        topic: channel.topic.to_string(),
        schema: channel.schema.clone(),
        encoding: channel.encoding.clone(),
        messages: channel.messages,
        hz: (channel.messages > 1 && seconds > 0.0)
            .then(|| (channel.messages - 1) as f64 / seconds),
    };
    let mut channels: Vec<Channel> = recording.channels().map(channel).collect();
    channels.sort_by(|a, b| a.topic.cmp(&b.topic));
    channels
}

fn attachment(file: &recording::AttachedFile) -> Attachment {
    Attachment {
        name: file.name.clone(),
        media_type: file.media_type.clone(),
        bytes: file.len(),
    }
}
