//! Recorded drive: the scans of the device and the other recorded messages.
//!
//! Times of measurement are rounded down to microseconds, the unit of the device's clock, so that
//! messages with equal times still match.

use std::path::Path;

use messages::{GroundTruth, Odometry, Stamp};
use recording::{Kind, Recording};
use ros_graph::replay::{Channels, Content, InOrder, PlaybackError, Selection, Source, Timed};

use crate::EmulatorError;
use crate::sweep::Sweep;

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Happening {
    Scan(usize),
    Odometry(Box<Odometry>),
    GroundTruth(Box<GroundTruth>),
}

/// Scans and other events of the recording, by log time in nanoseconds.
#[derive(Debug)]
pub(crate) struct Drive {
    pub(crate) sweep: Sweep,
    pub(crate) happenings: Vec<(i64, Happening)>,
    pub(crate) refused: Vec<PlaybackError>,
}

impl Drive {
    /// Reads a recording; the topics of scans and odometry are those to use if it has several.
    pub(crate) fn open(
        path: &Path,
        scan: Option<&str>,
        odometry: Option<&str>,
    ) -> Result<Self, EmulatorError> {
        let mut recording = Recording::open(path)?;
        for (kind, topic) in [(Kind::Scan, scan), (Kind::Odometry, odometry)] {
            if let Some(topic) = topic {
                recording.prefer(kind, topic)?;
            }
        }
        let all = Selection::all();
        let channels = Channels::of(&recording, &all)?;
        let mut sweep: Option<Sweep> = None;
        let (mut happenings, mut refused) = (Vec::new(), Vec::new());
        for item in InOrder::new(Source::new(&recording, channels, all)) {
            match item {
                Ok(timed) => happenings.push((timed.log_time_ns, take(timed, &mut sweep)?)),
                Err(error) if error.is_about_one_message() => refused.push(error),
                Err(error) => return Err(error.into()),
            }
        }
        let mut sweep = sweep.ok_or_else(|| {
            EmulatorError::Recorded(format!("{}: there is no scan in it", path.display()))
        })?;
        sweep.measure_time();
        Ok(Drive {
            sweep,
            happenings,
            refused,
        })
    }
}

/// Converts a message to an event and adds its scan to `sweep`.
fn take(timed: Timed, sweep: &mut Option<Sweep>) -> Result<Happening, EmulatorError> {
    Ok(match timed.content {
        Content::Scan(header, ranges) => match sweep {
            Some(sweep) => {
                sweep.add(timed.log_time_ns, &header, ranges)?;
                Happening::Scan(sweep.scans.len() - 1)
            }
            None => {
                *sweep = Some(Sweep::first(timed.log_time_ns, &header, ranges)?);
                Happening::Scan(0)
            }
        },
        Content::Odometry(mut odometry) => {
            round(&mut odometry.stamp);
            Happening::Odometry(odometry)
        }
        Content::GroundTruth(mut truth) => {
            round(&mut truth.stamp);
            Happening::GroundTruth(truth)
        }
    })
}

/// Rounds a stamp down to a whole microsecond.
fn round(stamp: &mut Stamp) {
    stamp.measured_ns = stamp.measured_ns.div_euclid(1000) * 1000;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corridor_is_reported_in_order_and_truths_keep_to_their_scans() {
        let path = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../recordings/malaga_corridor/recording.mcap"
        );
        let drive = Drive::open(Path::new(path), None, None).unwrap();
        assert!(drive.refused.is_empty());
        assert!(drive.happenings.is_sorted_by_key(|(log_ns, _)| *log_ns));
        let mut truth_us = None;
        let mut scans = 0;
        for (_, happening) in &drive.happenings {
            match happening {
                Happening::Scan(index) => {
                    assert_eq!(truth_us, Some(drive.sweep.stamps_us[*index]));
                    scans += 1;
                }
                Happening::GroundTruth(truth) => {
                    assert_eq!(truth.stamp.measured_ns % 1000, 0);
                    truth_us = Some(truth.stamp.measured_ns / 1000);
                }
                Happening::Odometry(_) => {}
            }
        }
        assert_eq!(scans, 37);
    }
}
