//! What is looked at: one pass over all messages that are read.

use std::collections::{BTreeMap, BTreeSet};

use recording::ros::{Header, LaserScan, TfMessage};
use recording::{Kind, Message, Record, Recording, RecordingError};

/// What was seen on one channel.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Seen {
    pub(super) kind: Option<Kind>,
    /// Stamps of the headers, in the order of the log times.
    pub(super) stamps_ns: Vec<i64>,
    /// Frames of the headers, and where there are some of their children.
    pub(super) frames: BTreeSet<String>,
    pub(super) children: BTreeSet<String>,
    /// Messages that do not decode, and why the first does not.
    pub(super) undecodable: u64,
    pub(super) first_reason: Option<String>,
    /// Scans whose numbers contradict each other, and what the first says.
    pub(super) odd_scans: u64,
    pub(super) first_oddity: Option<String>,
    /// Readings, and those that say nothing.
    pub(super) readings: u64,
    pub(super) silent: u64,
}

/// What was seen on all channels.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Patient {
    pub(super) channels: BTreeMap<String, Seen>,
}

impl Patient {
    pub(super) fn of(recording: &Recording) -> Self {
        let mut patient = Patient::default();
        for record in recording.records() {
            match record {
                Ok(record) => patient.see(&record),
                Err(
                    ref error @ (RecordingError::Message { ref topic, .. }
                    | RecordingError::NotCdr { ref topic, .. }),
                ) => {
                    let seen = patient.channels.entry(topic.clone()).or_default();
                    seen.undecodable += 1;
                    seen.first_reason.get_or_insert_with(|| error.to_string());
                }
                // The damage is known from the recording itself.
                Err(_) => {}
            }
        }
        patient
    }

    /// The channels of a kind.
    pub(super) fn of_kind(&self, kind: Kind) -> impl Iterator<Item = (&String, &Seen)> {
        let is_meant = move |(_, seen): &(&String, &Seen)| seen.kind == Some(kind);
        self.channels.iter().filter(is_meant)
    }

    fn see(&mut self, record: &Record) {
        let seen = self.channels.entry(record.topic.to_string()).or_default();
        seen.kind = Some(record.message.kind());
        match &record.message {
            Message::Scan(scan) => seen.scan(scan),
            Message::Map(map) => seen.header(&map.header),
            Message::PoseStamped(pose) => seen.header(&pose.header),
            Message::StaticTransforms(transforms) => seen.transforms(transforms),
            Message::Odometry(odometry) => {
                seen.header(&odometry.header);
                seen.children.insert(odometry.child_frame_id.clone());
            }
        }
    }
}

impl Seen {
    fn header(&mut self, header: &Header) {
        self.stamps_ns.push(header.stamp.as_ns());
        if !self.frames.contains(&header.frame_id) {
            self.frames.insert(header.frame_id.clone());
        }
    }

    fn transforms(&mut self, message: &TfMessage) {
        for transform in &message.transforms {
            self.frames.insert(transform.header.frame_id.clone());
            self.children.insert(transform.child_frame_id.clone());
        }
    }

    fn scan(&mut self, scan: &LaserScan) {
        self.header(&scan.header);
        let says = |range: &&f32| (scan.range_min..=scan.range_max).contains(*range);
        let saying = scan.ranges.iter().filter(says).count();
        self.readings += scan.ranges.len() as u64;
        self.silent += (scan.ranges.len() - saying) as u64;
        if let Some(oddity) = oddity(scan) {
            self.odd_scans += 1;
            self.first_oddity.get_or_insert(oddity);
        }
    }
}

/// What about a scan's numbers does not fit together.
fn oddity(scan: &LaserScan) -> Option<String> {
    let LaserScan {
        angle_min,
        angle_max,
        angle_increment,
        range_min,
        range_max,
        ranges,
        ..
    } = scan;
    let beams = ranges.len();
    if beams == 0 {
        return Some("it has no readings".to_owned());
    }
    let finite = [angle_min, angle_max, angle_increment]
        .iter()
        .all(|x| x.is_finite());
    if !finite || *angle_increment == 0.0 {
        return Some(format!(
            "its angles are {angle_min} to {angle_max} by {angle_increment} rad"
        ));
    }
    if range_min.partial_cmp(range_max) != Some(std::cmp::Ordering::Less) {
        return Some(format!("its ranges are {range_min} to {range_max} m"));
    }
    let last = angle_min + (beams - 1) as f32 * angle_increment;
    // Some drivers say where the beam behind the last one would point.
    if (last - angle_max).abs() > 1.5 * angle_increment.abs() {
        return Some(format!(
            "its {beams} beams from {angle_min} by {angle_increment} rad end at {last:.4}, not at \
             {angle_max}"
        ));
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan() -> LaserScan {
        LaserScan {
            angle_min: -1.0,
            angle_max: 1.0,
            angle_increment: 0.5,
            range_min: 0.1,
            range_max: 30.0,
            ranges: vec![1.0; 5],
            ..LaserScan::default()
        }
    }

    #[test]
    fn numbers_that_do_not_fit_are_odd() {
        assert_eq!(oddity(&scan()), None);
        let odd = |spoil: fn(&mut LaserScan)| {
            let mut scan = scan();
            spoil(&mut scan);
            oddity(&scan).unwrap()
        };
        assert_eq!(odd(|s| s.ranges.clear()), "it has no readings");
        assert_eq!(
            odd(|s| s.angle_increment = 0.0),
            "its angles are -1 to 1 by 0 rad"
        );
        assert_eq!(odd(|s| s.range_max = 0.0), "its ranges are 0.1 to 0 m");
        let beams = odd(|s| s.ranges.truncate(3));
        assert_eq!(
            beams,
            "its 3 beams from -1 by 0.5 rad end at 0.0000, not at 1"
        );
    }
}
