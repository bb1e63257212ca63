//! A laser of a log that becomes a topic of a recording.

use recording::SCAN;
use ros::{Header, LaserScan, Time};

use super::carmen::{Kind, Laser, name_of};
use super::survey::Survey;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Source {
    number: u8,
    kind: Kind,
    pub(super) topic: String,
    pub(super) frame: String,
    /// Parameter that marks the laser as upside down.
    flipped: Option<String>,
    /// True if the scans show that its beams run the other way.
    is_mirrored: Option<bool>,
    scans: u64,
    /// Number of beams of the first scan, and bearings of its first and last beam in radians.
    first: Option<(usize, f32, f32)>,
}

impl Source {
    /// Returns all lasers of a log; the first one gets the topic `/scan`.
    pub(super) fn all(survey: &Survey) -> Vec<Source> {
        let mut sources: Vec<Source> = Vec::new();
        for number in survey.lasers() {
            let Some(kind) = survey.kind_of(number) else {
                continue;
            };
            let suffix = match number {
                1 => String::new(),
                2 => "_rear".to_owned(),
                other => format!("_{other}"),
            };
            let topic = match sources.is_empty() {
                true => SCAN.to_owned(),
                false => format!("{SCAN}{suffix}"),
            };
            sources.push(Source {
                number,
                kind,
                topic,
                frame: format!("laser{suffix}"),
                flipped: survey.parameters.of(number).flipped.clone(),
                is_mirrored: survey.is_mirrored(number, kind),
                scans: 0,
                first: None,
            });
        }
        sources
    }

    pub(super) fn is_of(&self, laser: &Laser) -> bool {
        (self.number, self.kind) == (laser.number, laser.kind)
    }

    /// Converts a scan to a message with its beams counter-clockwise.
    pub(super) fn scan(
        &mut self,
        laser: &Laser,
        (mut start, mut step): (f64, f64),
        stamp: Time,
        range_max_m: f32,
    ) -> LaserScan {
        if self.mirrors() {
            (start, step) = (-start, -step);
        }
        let steps = laser.ranges.len().saturating_sub(1) as f64;
        let mut ranges = laser.ranges.clone();
        if step < 0.0 {
            ranges.reverse();
            (start, step) = (start + steps * step, -step);
        }
        let scan = LaserScan {
            header: Header::new(stamp, &self.frame),
            angle_min: start as f32,
            angle_max: (start + steps * step) as f32,
            angle_increment: step as f32,
            range_min: 0.0,
            range_max: laser.range_max_m.map_or(range_max_m, |range| range as f32),
            ranges,
            ..LaserScan::default()
        };
        self.scans += 1;
        let ends = (scan.ranges.len(), scan.angle_min, scan.angle_max);
        self.first.get_or_insert(ends);
        scan
    }

    /// A laser that is marked as upside down is mirrored, unless its scans show that its readings
    /// were reversed before they were logged.
    fn mirrors(&self) -> bool {
        self.flipped.is_some() && self.is_mirrored.unwrap_or(true)
    }

    pub(super) fn text(&self) -> String {
        let name = name_of(self.kind, self.number);
        let (topic, scans) = (&self.topic, self.scans);
        let plural = if scans == 1 { "" } else { "s" };
        let mut text = format!("{topic} holds {name}: {scans} scan{plural}");
        if let Some((beams, first, last)) = self.first {
            let (first, last) = (first.to_degrees(), last.to_degrees());
            text += &format!(", at first of {beams} beams from {first:.1} to {last:.1}°");
        }
        if let Some(flipped) = &self.flipped {
            let how = match self.is_mirrored {
                Some(true) => "its beams run clockwise, and are turned about",
                Some(false) => "its beams were turned about before they were logged, and are kept",
                None => {
                    "its beams are turned about, without a scan that shows whether they have to be"
                }
            };
            text += &format!("; by {flipped} it is mounted upside down: {how}");
        }
        text
    }
}
