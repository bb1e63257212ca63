//! Converts messages of a recording to those of the graph; errors name the message.

use messages::{FrameName, GroundTruth, Odometry};
use ros::{ConversionError, PoseStamped, measurements};

use crate::PlaybackError;

/// Topic and log time of a message, for errors.
pub(crate) struct Place<'a> {
    pub(crate) topic: &'a str,
    pub(crate) log_time_ns: i64,
}

impl Place<'_> {
    pub(crate) fn name(&self, frame: &str) -> Result<FrameName, PlaybackError> {
        measurements::frame(frame).map_err(|reason| self.unusable(reason))
    }

    pub(crate) fn odometry(&self, message: &ros::Odometry) -> Result<Odometry, PlaybackError> {
        measurements::odometry(message).map_err(|reason| self.unusable(reason))
    }

    pub(crate) fn ground_truth(&self, message: &PoseStamped) -> Result<GroundTruth, PlaybackError> {
        measurements::ground_truth(message).map_err(|reason| self.unusable(reason))
    }

    fn unusable(&self, reason: ConversionError) -> PlaybackError {
        PlaybackError::Message {
            topic: self.topic.into(),
            log_time_ns: self.log_time_ns,
            reason,
        }
    }
}
