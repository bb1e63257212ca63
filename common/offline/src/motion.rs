//! Transforms scans to one time, as the graph's accumulator but with all odometry available.

use std::sync::Arc;

use engine::EngineError;
use engine::joined::{JoinConfig, Joiner, MotionConfig};
use messages::Odometry;
use recording::{Kind, Recording, RecordingError};
use ros::lasers;

use super::TakenScan;
use super::heading::each_odometry;

/// Scans of a recording's lasers, transformed to one time.
pub(crate) struct Motion<'a> {
    recording: &'a Recording,
    config: JoinConfig,
    /// The added scans; after [`Motion::bring`], at the time of the newest.
    pub(crate) joiner: Joiner,
    /// True once the odometry was read; it is needed only for scans that take time.
    is_read: bool,
    deskews: bool,
    notes: Vec<String>,
}

impl<'a> Motion<'a> {
    pub(crate) fn of(recording: &'a Recording, topics: &[Arc<str>], motion: &MotionConfig) -> Self {
        let scans = match topics {
            [_] => Vec::new(),
            several => several.iter().map(|topic| lasers::name_of(topic)).collect(),
        };
        let config = JoinConfig {
            scans,
            motion: motion.clone(),
        };
        Motion {
            recording,
            joiner: Joiner::keeping_all(config.clone()),
            config,
            is_read: false,
            deskews: motion.deskew,
            notes: Vec::new(),
        }
    }

    /// Adds a scan, and the scans of other lasers since the previous one.
    pub(crate) fn take(&mut self, scan: &TakenScan) -> anyhow::Result<()> {
        let takes_time = self.joiner.targets_base() || scan.message.time_increment != 0.0;
        if takes_time && self.deskews {
            self.read_odometry()?;
        }
        for other in &scan.others {
            self.joiner.on_scan(&other.header()?, &other.message.ranges);
        }
        self.joiner.on_scan(&scan.header()?, &scan.message.ranges);
        Ok(())
    }

    /// Reads the odometry on the first call.
    pub(crate) fn read_odometry(&mut self) -> Result<(), RecordingError> {
        if std::mem::replace(&mut self.is_read, true) {
            return Ok(());
        }
        match self.recording.topic(Kind::Odometry) {
            Ok(Some(topic)) => {
                let joiner = &mut self.joiner;
                let notes = each_odometry(self.recording, &topic, |odometry| {
                    joiner.on_odometry(odometry);
                })?;
                self.notes.extend(notes);
            }
            Ok(None) => {}
            Err(error) => self.notes.push(format!(
                "the motion within scans is not compensated: {error}; --odom-topic names one"
            )),
        }
        Ok(())
    }

    /// Drops all scans, and uses this odometry in place of the recorded one.
    pub(crate) fn begin_again(&mut self, odometry: &[Odometry]) {
        self.joiner = Joiner::keeping_all(self.config.clone());
        odometry.iter().for_each(|one| self.joiner.on_odometry(one));
        self.is_read = true;
    }

    pub(crate) fn bring(&mut self) -> Result<(), EngineError> {
        let brought = self.joiner.bring()?;
        self.notes.extend(brought.notes(self.joiner.flows()));
        Ok(())
    }

    pub(crate) fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }
}
