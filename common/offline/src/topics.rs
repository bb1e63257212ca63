//! Which channels of a recording are meant, where that is not clear.

use std::sync::Arc;

use recording::{Kind, Recording, RecordingError};

/// Channels by their names.
#[derive(Debug, Clone, Default, PartialEq, Eq, clap::Args)]
#[command(next_help_heading = "Topics")]
pub struct TopicOptions {
    /// The topic of the scans; several lasers are named one by one [default: the
    /// only one, or /scan]
    #[arg(long, value_name = "TOPIC")]
    pub scan_topic: Vec<String>,

    /// The topic of the odometry [default: the only one, or /odom]
    #[arg(long, value_name = "TOPIC")]
    pub odom_topic: Option<String>,

    /// The topic of the map [default: the only one, or /map]
    #[arg(long, value_name = "TOPIC")]
    pub map_topic: Option<String>,
}

impl TopicOptions {
    /// From now on, these are meant in the recording.
    ///
    /// # Errors
    /// The recording does not have one of them.
    pub fn apply(&self, recording: &mut Recording) -> Result<(), RecordingError> {
        // The first is the one where only one can be meant.
        for topic in self.scan_topic.iter().rev() {
            recording.prefer(Kind::Scan, topic)?;
        }
        if let Some(topic) = &self.odom_topic {
            recording.prefer(Kind::Odometry, topic)?;
        }
        if let Some(topic) = &self.map_topic {
            recording.prefer(Kind::Map, topic)?;
        }
        Ok(())
    }

    /// The channels with the scans: those that are named, or the one that is meant.
    ///
    /// # Errors
    /// There are no scans, or it is not clear which ones are meant.
    pub fn scans(&self, recording: &Recording) -> Result<Vec<Arc<str>>, RecordingError> {
        let mut topics: Vec<Arc<str>> = Vec::new();
        for topic in &self.scan_topic {
            if !topics.iter().any(|other| **other == **topic) {
                topics.push(topic.as_str().into());
            }
        }
        if topics.is_empty() {
            topics.push(recording.required_topic(Kind::Scan)?);
        }
        Ok(topics)
    }
}

/// Whether an error is about a message of a channel other than `topic`.
pub(super) fn concerns_other(error: &RecordingError, topic: &str) -> bool {
    match error {
        RecordingError::Message { topic: of, .. } | RecordingError::NotCdr { topic: of, .. } => {
            of != topic
        }
        _ => false,
    }
}
