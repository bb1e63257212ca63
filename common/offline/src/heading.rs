//! Headings of scans from the data of a recording.

use std::sync::Arc;

use bytemuck::Zeroable;
use engine::heading::{HeadingConfig, HeadingError, HeadingSource, History};
use engine::joined::MotionConfig;
use messages::{FrameName, GroundTruth, Odometry, ScanHeader, Stamp};
use recording::{Kind, Message, Record, Recording, RecordingError};
use ros::measurements;
use transport::with_causes;

use super::TakenScan;

/// Heading data of a recording, and the configured source.
#[derive(Debug, Clone)]
pub(crate) struct Headings {
    pub(crate) source: HeadingSource,
    history: History,
    pub(crate) notes: Vec<String>,
}

impl Headings {
    /// Reads the data that the configured source needs.
    pub(crate) fn of(
        config: &HeadingConfig,
        motion: &MotionConfig,
        recording: &Recording,
    ) -> Result<Self, RecordingError> {
        let source = config.source();
        let mut history = History::keeping(usize::MAX, motion);
        let mut notes = Vec::new();
        match source {
            HeadingSource::Searched | HeadingSource::Fixed(_) => {}
            HeadingSource::Odometry { .. } => notes = read_odometry(recording, &mut history)?,
            HeadingSource::Truth => read_truths(recording, &mut history)?,
        }
        Ok(Headings {
            source,
            history,
            notes,
        })
    }

    /// Heading of the laser at the time of `scan`, in radians; `None` if it is to be searched.
    pub(crate) fn of_scan(&self, scan: &TakenScan) -> Result<Option<f64>, HeadingError> {
        let header = ScanHeader {
            stamp: measured(scan.stamp_ns),
            base_from_laser: scan.base_from_laser.unwrap_or_default().into(),
            mount_known: scan.base_from_laser.is_some().into(),
            frame: FrameName::new(scan.frame()),
            ..ScanHeader::zeroed()
        };
        self.source.heading_of(&header, &self.history)
    }
}

fn measured(measured_ns: i64) -> Stamp {
    Stamp {
        measured_ns,
        ..Stamp::default()
    }
}

fn read_truths(recording: &Recording, history: &mut History) -> Result<(), RecordingError> {
    recording.required_topic(Kind::PoseStamped)?;
    for (ns, truth) in recording.ground_truths()? {
        history.on_truth(&GroundTruth {
            stamp: measured(ns),
            map_from_laser: truth.pose.into(),
            frame: FrameName::new(&truth.frame),
        });
    }
    Ok(())
}

fn read_odometry(
    recording: &Recording,
    history: &mut History,
) -> Result<Vec<String>, RecordingError> {
    let topic = recording.required_topic(Kind::Odometry)?;
    each_odometry(recording, &topic, |odometry| {
        history.on_odometry(odometry);
    })
}

/// Passes each message of a channel to `take`; returns a note about those that cannot be used.
pub fn each_odometry(
    recording: &Recording,
    topic: &Arc<str>,
    mut take: impl FnMut(&Odometry),
) -> Result<Vec<String>, RecordingError> {
    let (mut left_out, mut first) = (0, None);
    for record in recording.records_of(&[Kind::Odometry]) {
        let received = match record {
            Ok(record) if record.topic != *topic => continue,
            Ok(Record {
                log_time_ns,
                message: Message::Odometry(message),
                ..
            }) => {
                let odometry = measurements::odometry(&message);
                odometry.map_err(|source| recording.unusable(topic, log_time_ns, source))
            }
            Ok(_) => continue,
            // The damage follows all readable messages, and is reported with the scans.
            Err(RecordingError::Damaged { .. }) => break,
            Err(error) if error.topic().is_some_and(|of| *of != **topic) => continue,
            Err(error @ RecordingError::Message { .. }) => Err(error),
            Err(error) => return Err(error),
        };
        match received {
            Ok(odometry) => take(&odometry),
            Err(error) => {
                left_out += 1;
                first.get_or_insert_with(|| with_causes(&error));
            }
        }
    }
    let note = |first| format!("{left_out} messages of {topic} are ignored; the first: {first}");
    Ok(first.map(note).into_iter().collect())
}
