//! Gathers the data for the checks in one pass over all decodable messages.

use std::collections::{BTreeMap, BTreeSet};

use offline::as_measured;
use recording::{Kind, Message, Record, Recording};
use ros::{Header, LaserScan, Mend, Quaternion, TfMessage};

#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Seen {
    pub(super) kind: Option<Kind>,
    /// Stamps of the headers, in the order of the log times.
    pub(super) stamps_ns: Vec<i64>,
    /// Frames of the headers and, if there are any, child frames.
    pub(super) frames: BTreeSet<String>,
    pub(super) children: BTreeSet<String>,
    /// Number of messages that do not decode, and the reason for the first.
    pub(super) undecodable: u64,
    pub(super) first_reason: Option<String>,
    /// Number of scans with contradictory values, and the fault of the first.
    pub(super) odd_scans: u64,
    pub(super) first_oddity: Option<String>,
    /// Number of ranges, and of those that are no return.
    pub(super) readings: u64,
    pub(super) silent: u64,
    pub(super) farthest: Option<Farthest>,
    /// Number of scans with a median range that no laser reaches, and the median of the first.
    pub(super) unreachable: u64,
    pub(super) first_middle_m: Option<f32>,
    /// Longest time from the first beam of a scan to its last.
    pub(super) longest: Option<Duration>,
    /// Number of corrected orientations, and the correction of the first.
    pub(super) mended: u64,
    pub(super) first_mend: Option<Mend>,
}

/// Largest range of all scans.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Farthest {
    pub(super) range_m: f32,
    /// Number of ranges with exactly this value.
    pub(super) count: u64,
    /// `range_max` of the first scan that has it.
    pub(super) range_max_m: f32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Duration {
    pub(super) scan_s: f64,
    /// Time from one beam to the next.
    pub(super) time_increment_s: f32,
}

/// Largest plausible median range of a scan, in metres: lasers seldom see half of their
/// surroundings at a larger distance.
const REACHABLE_M: f32 = 200.0;

/// Smallest number of distinct ranges for a meaningful median: some drivers report with one large
/// value that nothing returned.
const MIN_READINGS: usize = 30;

#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Survey {
    pub(super) channels: BTreeMap<String, Seen>,
}

impl Survey {
    pub(super) fn of(recording: &Recording) -> Self {
        let mut survey = Survey::default();
        for record in recording.records() {
            match record {
                Ok(record) => survey.see(&record),
                Err(error) => {
                    // The damage is reported by the recording itself.
                    let Some(topic) = error.topic() else { continue };
                    let seen = survey.channels.entry(topic.to_owned()).or_default();
                    seen.undecodable += 1;
                    seen.first_reason.get_or_insert_with(|| error.to_string());
                }
            }
        }
        survey
    }

    pub(super) fn of_kind(&self, kind: Kind) -> impl Iterator<Item = (&String, &Seen)> {
        let is_meant = move |(_, seen): &(&String, &Seen)| seen.kind == Some(kind);
        self.channels.iter().filter(is_meant)
    }

    /// Frames of the headers of all messages of a kind.
    pub(super) fn frames(&self, kind: Kind) -> impl Iterator<Item = &String> {
        self.of_kind(kind).flat_map(|(_, seen)| &seen.frames)
    }

    fn see(&mut self, record: &Record) {
        let seen = self.channels.entry(record.topic.to_string()).or_default();
        seen.kind = Some(record.message.kind());
        match &record.message {
            Message::Scan(scan) => seen.scan(scan),
            Message::Map(map) => {
                seen.header(&map.header);
                seen.orientation(map.info.origin.orientation);
            }
            Message::PoseStamped(pose) => {
                seen.header(&pose.header);
                seen.orientation(pose.pose.orientation);
            }
            Message::StaticTransforms(transforms) => seen.transforms(transforms),
            Message::Odometry(odometry) => {
                seen.header(&odometry.header);
                seen.orientation(odometry.pose.pose.orientation);
                seen.children.insert(odometry.child_frame_id.clone());
            }
        }
    }
}

impl Seen {
    /// Positive steps between stamps, in nanoseconds, in increasing order.
    pub(super) fn steps_ns(&self) -> Vec<i64> {
        let pairs = self.stamps_ns.windows(2);
        let steps = pairs.map(|pair| pair[1].saturating_sub(pair[0]));
        let mut steps: Vec<i64> = steps.filter(|step| *step > 0).collect();
        steps.sort_unstable();
        steps
    }

    /// Median step, in seconds.
    pub(super) fn usual_step_s(&self) -> Option<f64> {
        let steps = self.steps_ns();
        Some(*steps.get(steps.len() / 2)? as f64 * 1e-9)
    }

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

    fn orientation(&mut self, turn: Quaternion) {
        if let Ok((_, Some(mend))) = turn.mended() {
            self.mended += 1;
            self.first_mend.get_or_insert(mend);
        }
    }

    fn scan(&mut self, scan: &LaserScan) {
        self.header(&scan.header);
        let taken = as_measured(scan);
        let beams = 0..scan.ranges.len();
        let silent = beams.filter(|&beam| taken.reading(beam).is_none());
        self.silent += silent.count() as u64;
        self.readings += scan.ranges.len() as u64;
        for &range in scan.ranges.iter().filter(|range| range.is_finite()) {
            self.reach(range, scan.range_max);
        }
        if let Some(middle_m) = middle(&scan.ranges).filter(|range| *range > REACHABLE_M) {
            self.unreachable += 1;
            self.first_middle_m.get_or_insert(middle_m);
        }
        self.duration(scan);
        if let Some(oddity) = oddity(scan) {
            self.odd_scans += 1;
            self.first_oddity.get_or_insert(oddity);
        }
    }

    fn duration(&mut self, scan: &LaserScan) {
        let time_increment_s = scan.time_increment;
        let scan_s = f64::from(time_increment_s).abs() * scan.ranges.len() as f64;
        if self.longest.is_none_or(|longest| scan_s > longest.scan_s) {
            self.longest = Some(Duration {
                scan_s,
                time_increment_s,
            });
        }
    }

    fn reach(&mut self, range_m: f32, range_max_m: f32) {
        match &mut self.farthest {
            Some(farthest) if range_m < farthest.range_m => {}
            Some(farthest) if range_m == farthest.range_m => farthest.count += 1,
            farthest => {
                *farthest = Some(Farthest {
                    range_m,
                    count: 1,
                    range_max_m,
                });
            }
        }
    }
}

/// Median of the distinct ranges of a scan.
fn middle(ranges: &[f32]) -> Option<f32> {
    let mut read: Vec<f32> = ranges.iter().copied().filter(|r| r.is_finite()).collect();
    read.sort_unstable_by(f32::total_cmp);
    read.dedup();
    let middle = *read.get(read.len() / 2)?;
    (read.len() >= MIN_READINGS).then_some(middle)
}

/// Reason why the engine rejects a scan, or a contradiction between its values.
fn oddity(scan: &LaserScan) -> Option<String> {
    if let Err(refusal) = as_measured(scan).check() {
        return Some(refusal.to_string());
    }
    let LaserScan {
        angle_min,
        angle_max,
        angle_increment,
        time_increment,
        ranges,
        ..
    } = scan;
    if !time_increment.is_finite() {
        return Some(format!(
            "time_increment is {time_increment}: the driver must set it to the seconds from one \
             beam to the next, or to 0"
        ));
    }
    let beams = ranges.len();
    let last = angle_min + beams.saturating_sub(1) as f32 * angle_increment;
    // Some drivers set it to the bearing after the last beam. NaN passes this check, because the
    // field is not used.
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
        let empty = odd(|s| s.ranges.clear());
        assert_eq!(empty, "the scan is empty: it has no ranges");
        let still = odd(|s| s.angle_increment = 0.0);
        assert!(still.starts_with("angle_increment is 0"), "{still}");
        let nowhere = odd(|s| s.range_max = 0.0);
        assert!(
            nowhere.starts_with("range_min 0.1 and range_max 0"),
            "{nowhere}"
        );
        let beams = odd(|s| s.ranges.truncate(3));
        assert_eq!(
            beams,
            "its 3 beams from -1 by 0.5 rad end at 0.0000, not at 1"
        );
    }

    #[test]
    fn readings_at_the_farthest_value_are_counted() {
        let mut seen = Seen::default();
        seen.scan(&LaserScan {
            ranges: vec![1.0, 5.0, 5.0, f32::INFINITY, f32::NAN],
            ..scan()
        });
        seen.scan(&LaserScan {
            ranges: vec![6.0, 1.0, 6.0, 6.0, 5.0],
            range_max: 6.0,
            ..scan()
        });
        let expected = Farthest {
            range_m: 6.0,
            count: 3,
            range_max_m: 6.0,
        };
        assert_eq!((seen.farthest, seen.readings), (Some(expected), 10));
    }
}
