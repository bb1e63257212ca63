//! The scans of a recording, by log time, each N-th of them.

use std::collections::BTreeMap;
use std::sync::Arc;

use engine::scan::Scan;
use geometry::Pose;
use recording::ros::LaserScan;
use recording::{Kind, Message, Recording, RecordingError, Records};

use super::heading::concerns_other;

/// A scan and what the recording says about it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TakenScan {
    /// When it was measured, nanoseconds since 1970.
    pub(crate) stamp_ns: i64,
    /// Where the laser sits on the robot, if that is known.
    pub(crate) base_from_laser: Option<Pose>,
    pub(crate) message: LaserScan,
}

impl TakenScan {
    /// The laser's frame.
    pub(crate) fn frame(&self) -> &str {
        &self.message.header.frame_id
    }

    /// As the engine takes it.
    pub(crate) fn borrowed(&self) -> Scan<'_> {
        let message = &self.message;
        Scan {
            angle_min: message.angle_min.into(),
            angle_increment: message.angle_increment.into(),
            range_min_m: message.range_min,
            range_max_m: message.range_max,
            ranges: &message.ranges,
        }
    }
}

/// Iterates over the scans. One that does not decode is an error in its place;
/// damage of the file is the last item.
pub(crate) struct Scans<'a> {
    recording: &'a Recording,
    records: Records<'a>,
    topic: Arc<str>,
    every: u64,
    seen: u64,
    mounts: BTreeMap<String, Option<Pose>>,
}

impl<'a> Scans<'a> {
    /// Each `every`-th scan of the channel that holds scans; `every` is at
    /// least 1.
    ///
    /// # Errors
    /// There are no scans, or it is not clear which ones are meant.
    pub(crate) fn of(recording: &'a Recording, every: u64) -> Result<Self, RecordingError> {
        Ok(Scans {
            recording,
            records: recording.records_of(&[Kind::Scan]),
            topic: recording.required_topic(Kind::Scan)?,
            every,
            seen: 0,
            mounts: BTreeMap::new(),
        })
    }

    /// How many there are, those that do not decode included.
    pub(crate) fn total(&self) -> u64 {
        let mut channels = self.recording.channels();
        let channel = channels.find(|channel| channel.topic == self.topic);
        channel.map_or(0, |channel| channel.messages.div_ceil(self.every))
    }

    /// Counts a scan of the channel; whether it is taken.
    fn take_next(&mut self) -> bool {
        let is_taken = self.seen.is_multiple_of(self.every);
        self.seen += 1;
        is_taken
    }

    fn with_mount(&mut self, message: LaserScan) -> Result<TakenScan, RecordingError> {
        let frame = &message.header.frame_id;
        let base_from_laser = match self.mounts.get(frame) {
            Some(known) => *known,
            None => {
                let mount = self.recording.base_from_laser(frame)?;
                let mount = mount.map(|mount| mount.base_from_laser);
                self.mounts.insert(frame.clone(), mount);
                mount
            }
        };
        Ok(TakenScan {
            stamp_ns: message.header.stamp.as_ns(),
            base_from_laser,
            message,
        })
    }
}

impl Iterator for Scans<'_> {
    type Item = Result<TakenScan, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let record = match self.records.next()? {
                Ok(record) if record.topic != self.topic => continue,
                Err(error) if concerns_other(&error, &self.topic) => continue,
                other => other,
            };
            let is_taken = self.take_next();
            match record.map(|record| record.message) {
                Ok(Message::Scan(message)) if is_taken => return Some(self.with_mount(message)),
                Ok(_) => {}
                // Also where it would not be taken: the file is not sound.
                Err(error) => return Some(Err(error)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use recording::ros::{Header, Time};
    use recording::write::{Packing, RecordingWriter};

    use super::*;

    fn recording(topics: &[&str]) -> Recording {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        for (second, topic) in (0..).zip(topics) {
            let message = LaserScan {
                header: Header {
                    stamp: Time {
                        sec: second,
                        nanosec: 7,
                    },
                    frame_id: "laser".into(),
                },
                ranges: vec![1.5],
                ..LaserScan::default()
            };
            let log_time_ns = i64::from(second) * 1000;
            writer
                .write(topic, log_time_ns, &Message::Scan(message))
                .unwrap();
        }
        let bytes = writer.finish().unwrap().into_inner();
        Recording::from_bytes("r.mcap", bytes).unwrap()
    }

    fn seconds(recording: &Recording, every: u64) -> Vec<i64> {
        let scans = Scans::of(recording, every).unwrap();
        let total = scans.total();
        let seconds: Vec<i64> = scans
            .map(|scan| scan.unwrap().stamp_ns / 1_000_000_000)
            .collect();
        assert_eq!(seconds.len() as u64, total);
        seconds
    }

    #[test]
    fn each_nth_scan_of_the_channel_is_taken() {
        let recording = recording(&["/scan", "/scan", "/rear", "/scan", "/scan", "/scan"]);
        assert_eq!(seconds(&recording, 1), [0, 1, 3, 4, 5]);
        assert_eq!(seconds(&recording, 2), [0, 3, 5]);
        assert_eq!(seconds(&recording, 9), [0]);
    }

    #[test]
    fn a_scan_that_does_not_decode_is_told_and_not_the_end() {
        let mut writer = RecordingWriter::in_memory(Packing::Plain).unwrap();
        let sound = Message::Scan(LaserScan::default());
        writer.write("/scan", 0, &sound).unwrap();
        let (schema, text) = ("sensor_msgs/msg/LaserScan", "float32[] ranges");
        for topic in ["/scan", "/rear"] {
            writer
                .write_bytes(topic, schema, text, "cdr", 1, &[0, 1, 0, 0, 9])
                .unwrap();
        }
        writer.write("/scan", 2, &sound).unwrap();
        let bytes = writer.finish().unwrap().into_inner();
        let recording = Recording::from_bytes("r.mcap", bytes).unwrap();
        let scans = Scans::of(&recording, 1).unwrap();
        let sound: Vec<bool> = scans.map(|scan| scan.is_ok()).collect();
        assert_eq!(sound, [true, false, true]);
    }
}
