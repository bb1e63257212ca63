//! Iterates over every N-th scan of a recording, by log time.

use std::collections::BTreeMap;
use std::sync::Arc;

use engine::scan::Scan;
use geometry::{Mount, Pose};
use messages::{Name, ScanHeader};
use recording::{Kind, Message, Mounted, Recording, RecordingError, Records};
use ros::{ConversionError, LaserScan, lasers, measurements};

/// A scan with its context from the recording.
#[derive(Debug, Clone, PartialEq)]
pub struct TakenScan {
    /// Time of measurement, in nanoseconds since 1970.
    pub stamp_ns: i64,
    pub log_time_ns: i64,
    pub base_from_laser: Option<Pose>,
    /// True if the laser is mounted upside down, so that its beams turn the other way.
    pub upside_down: bool,
    pub message: LaserScan,
    /// Name of the laser; empty if there is only one.
    pub laser: String,
    /// Scans of other lasers recorded since the previous scan.
    pub others: Vec<TakenScan>,
}

impl TakenScan {
    pub fn frame(&self) -> &str {
        &self.message.header.frame_id
    }

    /// Converts to the header of a graph message.
    /// Fails if the frame's name is longer than a message can hold.
    pub fn header(&self) -> Result<ScanHeader, ConversionError> {
        let frame = measurements::frame(self.frame())?;
        let mount = self.base_from_laser.map(|base_from_laser| Mount {
            base_from_laser,
            is_upside_down: self.upside_down,
        });
        Ok(ScanHeader {
            laser: Name::new(&self.laser),
            ..measurements::scan_header(&self.message, frame, mount)
        })
    }

    /// Converts to a scan of the engine, as seen from above.
    pub fn borrowed(&self) -> Scan<'_> {
        as_measured(&self.message).seen_from_above(self.upside_down)
    }
}

/// Converts to a scan of the engine, as the laser measured it.
pub fn as_measured(message: &LaserScan) -> Scan<'_> {
    Scan {
        angle_min: message.angle_min.into(),
        angle_increment: message.angle_increment.into(),
        range_min_m: message.range_min,
        range_max_m: message.range_max,
        ranges: &message.ranges,
    }
}

/// Iterator over the scans; an undecodable one is an error in its place, damage the last item.
pub struct Scans<'a> {
    recording: &'a Recording,
    records: Records<'a>,
    /// The first one is the topic of the scans that are searched.
    topics: Vec<Arc<str>>,
    /// Scans of other lasers since the last scan that was returned.
    others: Vec<TakenScan>,
    every: u64,
    seen: u64,
    mounts: BTreeMap<String, Option<Mount>>,
    notes: Vec<String>,
}

impl<'a> Scans<'a> {
    /// Returns each `every`-th scan of the first channel, with those of the others before it.
    pub fn of(recording: &'a Recording, topics: Vec<Arc<str>>, every: u64) -> Self {
        Scans {
            recording,
            records: recording.records_of(&[Kind::Scan]),
            topics,
            others: Vec::new(),
            every,
            seen: 0,
            mounts: BTreeMap::new(),
            notes: Vec::new(),
        }
    }

    /// Number of scans, including those that cannot be decoded.
    pub fn total(&self) -> u64 {
        let channels = self.recording.channels();
        let first = channels.filter(|channel| self.topics.first() == Some(&channel.topic));
        let scans: u64 = first.map(|channel| channel.messages).sum();
        scans.div_ceil(self.every)
    }

    /// Returns the notes about mounts since the last call.
    pub(super) fn take_notes(&mut self) -> Vec<String> {
        std::mem::take(&mut self.notes)
    }

    /// Counts a scan of the channel; true if it is selected.
    fn take_next(&mut self) -> bool {
        let is_taken = self.seen.is_multiple_of(self.every);
        self.seen += 1;
        is_taken
    }

    /// Keeps the newest two scans of another laser, which also give its period.
    fn keep(&mut self, scan: TakenScan) {
        let of_laser = |other: &TakenScan| other.laser == scan.laser;
        if self.others.iter().filter(|other| of_laser(other)).count() == 2
            && let Some(oldest) = self.others.iter().position(of_laser)
        {
            self.others.remove(oldest);
        }
        self.others.push(scan);
    }

    fn with_mount(
        &mut self,
        topic: &str,
        log_time_ns: i64,
        message: LaserScan,
    ) -> Result<TakenScan, RecordingError> {
        let mount = self.mount(&message.header.frame_id)?;
        Ok(TakenScan {
            stamp_ns: message.header.stamp.as_ns(),
            log_time_ns,
            base_from_laser: mount.map(|mount| mount.base_from_laser),
            upside_down: mount.is_some_and(|mount| mount.is_upside_down),
            message,
            laser: match self.topics.len() {
                1 => String::new(),
                _ => lasers::name_of(topic),
            },
            others: Vec::new(),
        })
    }

    fn mount(&mut self, frame: &str) -> Result<Option<Mount>, RecordingError> {
        if let Some(known) = self.mounts.get(frame) {
            return Ok(*known);
        }
        let Mounted { mount, notes } = self.recording.mounted(frame)?;
        self.notes.extend(notes);
        let mount = mount.as_ref().map(Mount::from);
        self.mounts.insert(frame.to_owned(), mount);
        Ok(mount)
    }
}

impl Iterator for Scans<'_> {
    type Item = Result<TakenScan, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let is_other = |topic: &str| self.topics.iter().all(|own| **own != *topic);
            let record = match self.records.next()? {
                Ok(record) if is_other(&record.topic) => continue,
                Err(error) if error.topic().is_some_and(is_other) => continue,
                Ok(record) => record,
                // Reports the error even for a scan that is not selected.
                Err(error) => {
                    self.take_next();
                    return Some(Err(error));
                }
            };
            let Message::Scan(message) = record.message else {
                continue;
            };
            let is_first = self.topics.first() == Some(&record.topic);
            if is_first && !self.take_next() {
                continue;
            }
            let scan = self.with_mount(&record.topic, record.log_time_ns, message);
            match scan {
                Ok(scan) if !is_first => self.keep(scan),
                Ok(scan) => {
                    return Some(Ok(TakenScan {
                        others: std::mem::take(&mut self.others),
                        ..scan
                    }));
                }
                Err(error) => return Some(Err(error)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use recording::write::{Packing, RecordingWriter};
    use ros::{Header, Time};

    use super::*;

    fn recording(topics: &[&str]) -> Recording {
        let mut writer = RecordingWriter::in_memory(Packing::Zstd).unwrap();
        for (second, topic) in (0..).zip(topics) {
            let message = LaserScan {
                header: Header::new(Time::from_ns(second * 1_000_000_000 + 7).unwrap(), "laser"),
                ranges: vec![1.5],
                ..LaserScan::default()
            };
            let message = Message::Scan(message);
            writer.write(topic, 1000 * second, &message).unwrap();
        }
        let bytes = writer.finish().unwrap().into_inner();
        Recording::from_bytes("r.mcap", bytes).unwrap()
    }

    #[test]
    fn the_scans_of_other_lasers_come_with_the_next_of_the_first() {
        let recording = recording(&["/front", "/rear", "/front", "/scan"]);
        let topics = vec!["/front".into(), "/rear".into()];
        let scans = Scans::of(&recording, topics, 1);
        assert_eq!(scans.total(), 2);
        let scans: Vec<TakenScan> = scans.map(Result::unwrap).collect();
        let times: Vec<i64> = scans.iter().map(|scan| scan.log_time_ns).collect();
        assert_eq!(times, [0, 2000]);
        let others: Vec<_> = scans.iter().map(|scan| scan.others.len()).collect();
        assert_eq!(others, [0, 1]);
        let rear = &scans[1].others[0];
        assert_eq!((rear.log_time_ns, &*rear.laser), (1000, "rear"));
    }

    #[test]
    fn a_laser_upside_down_is_seen_from_above() {
        let mut scan = TakenScan {
            stamp_ns: 0,
            log_time_ns: 0,
            base_from_laser: None,
            upside_down: false,
            message: LaserScan {
                angle_min: -1.0,
                angle_increment: 0.5,
                ranges: vec![1.0, 2.0],
                range_max: 30.0,
                ..LaserScan::default()
            },
            laser: String::new(),
            others: Vec::new(),
        };
        assert_eq!(scan.borrowed().bearing(1), -0.5);
        scan.upside_down = true;
        let above = scan.borrowed();
        assert_eq!((above.angle_min, above.angle_increment), (1.0, -0.5));
        assert_eq!((above.bearing(0), above.reading(0)), (0.5, Some(2.0)));
    }
}
