//! Selects channels of a recording by topic.

use std::sync::Arc;

use recording::{Kind, Recording, RecordingError};
use ros::CloudOptions;

/// Topics of the channels to use.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
#[command(next_help_heading = "Topics")]
pub struct TopicOptions {
    /// The topic of the scans; several lasers are named one by one [default: the
    /// only one, or /scan]
    #[arg(long, value_name = "TOPIC", conflicts_with = "cloud_topic")]
    pub scan_topic: Vec<String>,

    /// The topic of the odometry [default: the only one, or /odom]
    #[arg(long, value_name = "TOPIC")]
    pub odom_topic: Option<String>,

    /// The topic of the map [default: the only one, or /map]
    #[arg(long, value_name = "TOPIC")]
    pub map_topic: Option<String>,

    #[command(flatten)]
    pub cloud: CloudOptions,
}

impl TopicOptions {
    /// Selects these topics in the recording.
    /// Fails if the recording does not contain one of them, or not the mount of the point cloud.
    pub fn apply(&self, recording: &mut Recording) -> Result<(), RecordingError> {
        recording.take_cloud(&self.cloud)?;
        // Last, the first one, which is used where only one topic can be.
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

    /// Returns the topics of the scans: the given ones or the default.
    /// Fails if there are no scans, or several topics contain scans.
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
