//! `backcast info`: lists the contents of a recording. Faults are left to `doctor`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

use command_line::LOST_DATA;
use offline::TopicOptions;
use recording::{Kind, MetadataRecord, Recording};
use schemars::JsonSchema;
use serde::Serialize;

use crate::each::each;

/// Options of `backcast info`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// The recordings to describe: MCAP files, or bags of rosbag2 (their folders, or .db3)
    #[arg(required = true, value_name = "FILE")]
    recordings: Vec<PathBuf>,

    #[command(flatten)]
    topics: TopicOptions,

    /// Print JSON, one object per file
    #[arg(long)]
    json: bool,
}

/// Describes the given recordings one after another; a damaged one up to its damage.
pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let mut code = ExitCode::SUCCESS;
    let any_failed = each(&config.recordings, &config.topics, |_, recording| {
        let contents = Contents::of(&recording);
        if contents.damage.is_some() {
            code = ExitCode::from(LOST_DATA);
        }
        Ok(match config.json {
            true => command_line::json::object(&contents) + "\n",
            false => contents.text(),
        })
    })?;
    Ok(match any_failed {
        true => ExitCode::FAILURE,
        false => code,
    })
}

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

    /// Formats paragraphs for people: the file, its channels, metadata, attachments, damage.
    fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.write(&mut text);
        text
    }

    fn write(&self, text: &mut String) -> std::fmt::Result {
        let Contents {
            recording,
            messages,
            chunks,
            ..
        } = self;
        let megabytes = self.bytes as f64 * 1e-6;
        writeln!(
            text,
            "{recording}: {megabytes:.2} MB, {messages} messages in {chunks} chunks"
        )?;
        if let Some((first, last)) = self.first_ns.zip(self.last_ns) {
            let (from, to) = (first as f64 * 1e-9, last as f64 * 1e-9);
            writeln!(text, "from {from:.3} to {to:.3} s, {:.1} s long", to - from)?;
        }
        table(&self.channels, text)?;
        let taken = self.taken.iter();
        let taken: Vec<String> = taken
            .map(|(what, topic)| format!("{what} {topic}"))
            .collect();
        if !taken.is_empty() {
            writeln!(text, "\n  taken: {}", taken.join(", "))?;
        }
        for unclear in &self.unclear {
            writeln!(text, "\n  unclear: {unclear}")?;
        }
        for metadata in &self.metadata {
            writeln!(text, "\nmetadata {}", metadata.name)?;
            for (key, value) in &metadata.entries {
                writeln!(text, "  {key:<14} {value}")?;
            }
        }
        for file in &self.attachments {
            writeln!(
                text,
                "\nattachment {}: {} bytes, {}",
                file.name, file.bytes, file.media_type
            )?;
        }
        if let Some(damage) = &self.damage {
            writeln!(
                text,
                "\ndamaged: {damage}; all that is listed here comes before it"
            )?;
        }
        Ok(())
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

/// Largest width of the column of topics; longer topics break the alignment.
const MAX_WIDTH: usize = 80;

fn table(channels: &[Channel], text: &mut String) -> std::fmt::Result {
    let topics = channels.iter().map(|channel| channel.topic.len());
    let width = topics.max().unwrap_or(0).clamp("channel".len(), MAX_WIDTH);
    writeln!(
        text,
        "\n  {:<width$} {:>9} {:>8}  schema",
        "channel", "messages", "hz"
    )?;
    for channel in channels {
        let hz = channel.hz.map_or(String::new(), |hz| format!("{hz:.2}"));
        let encoding = match channel.encoding.as_str() {
            "cdr" => String::new(),
            other => format!(" ({other})"),
        };
        writeln!(
            text,
            "  {:<width$} {:>9} {hz:>8}  {}{encoding}",
            channel.topic, channel.messages, channel.schema
        )?;
    }
    Ok(())
}
