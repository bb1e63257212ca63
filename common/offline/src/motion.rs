//! Brings the scans of a recording to one time, as the graph's accumulator does: with
//! the same code, and all odometry at hand.

use std::sync::Arc;

use engine::EngineError;
use engine::joined::{ByOdometry, JoinConfig, Joiner, MotionConfig, Seen};
use messages::Odometry;
use recording::{Kind, Recording, RecordingError};
use ros::lasers;

use super::TakenScan;
use super::heading::each_odometry;
use crate::OfflineError;

/// The scans of a recording's lasers, brought to one time.
pub(crate) struct Motion<'a> {
    recording: &'a Recording,
    config: JoinConfig,
    joiner: Joiner,
    /// Whether the odometry was read, which only scans that take time need.
    is_read: bool,
    deskews: bool,
    notes: Vec<String>,
}

impl<'a> Motion<'a> {
    /// Of the lasers with these topics.
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

    /// Takes a scan, and those of the other lasers that came since the one before.
    ///
    /// # Errors
    /// The scan cannot be one of the graph, or the recording cannot be read.
    pub(crate) fn take(&mut self, scan: &TakenScan) -> Result<(), OfflineError> {
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

    /// Reads the odometry, unless that has been done.
    ///
    /// # Errors
    /// The recording cannot be read.
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

    /// Forgets all scans, and takes this odometry in place of the recorded one.
    pub(crate) fn begin_again(&mut self, odometry: &[Odometry]) {
        self.joiner = Joiner::keeping_all(self.config.clone());
        odometry.iter().for_each(|one| self.joiner.on_odometry(one));
        self.is_read = true;
    }

    /// Brings what was taken to the time of the scan.
    ///
    /// # Errors
    /// The scan is refused.
    pub(crate) fn bring(&mut self) -> Result<(), EngineError> {
        let brought = self.joiner.bring()?;
        self.notes.extend(brought.notes(self.joiner.flows()));
        Ok(())
    }

    /// Where the target frame was by the odometry when the scan was taken.
    pub(crate) fn by_odometry(&self) -> Option<ByOdometry> {
        self.joiner.by_odometry()
    }

    /// What was brought.
    pub(crate) fn seen(&self) -> Seen<'_> {
        self.joiner.seen()
    }

    /// Whether places are searched for the base, of several lasers.
    pub(crate) fn targets_base(&self) -> bool {
        self.joiner.targets_base()
    }

    /// The heading of the laser, radians, as that of what is searched.
    pub(crate) fn target_heading(&self, laser_heading: f64) -> f64 {
        self.joiner.target_heading(laser_heading)
    }

    /// What is worth knowing, and has not been said yet.
    pub(crate) fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }
}
