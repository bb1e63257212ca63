//! Lasers of a log, each of which becomes a topic of a recording.

use std::collections::BTreeMap;

use recording::SCAN;
use ros::{Header, LaserScan, Time};

use super::angles;
use super::carmen::{Kind, Laser, Line, name_of};
use super::parameters::Parameters;
use super::turning::Turning;

/// Data of a whole log that must be known before its first scan is written.
#[derive(Debug, Default)]
pub(super) struct Survey {
    pub(super) parameters: Parameters,
    /// Heading by the last odometry, in radians.
    heading: Option<f64>,
    /// Scans by laser and kind of line.
    seen: BTreeMap<(u8, Kind), Seen>,
}

#[derive(Debug, Default)]
struct Seen {
    scans: u64,
    /// Direction of the beams of a laser that is marked as upside down.
    turning: Turning,
}

impl Survey {
    pub(super) fn see(&mut self, line: &Line) {
        match line {
            Line::Laser(laser) => self.laser(laser),
            Line::Odometry(odometry) => self.heading = Some(odometry.robot.yaw),
            Line::Parameter(parameter) => self.parameters.note(parameter),
            Line::Nothing | Line::Other(_) => {}
        }
    }

    fn laser(&mut self, laser: &Laser) {
        let seen = self.seen.entry((laser.number, laser.kind)).or_default();
        seen.scans += 1;
        let mounting = self.parameters.of(laser.number);
        let yaw = laser.poses.map(|poses| poses.laser.yaw).or(self.heading);
        if mounting.flipped.is_some()
            && let Some(yaw) = yaw
            && let Ok((_, step)) = angles::of(laser, mounting)
        {
            seen.turning.note(laser, yaw, step);
        }
    }

    /// Kind of line that the scans of a laser are taken from. CARMEN logs a scan when it arrives
    /// and again with poses; lines with more data are preferred, unless there are less than half as
    /// many of them.
    fn kind_of(&self, number: u8) -> Option<Kind> {
        let of = |kind| self.seen.get(&(number, kind)).map_or(0, |seen| seen.scans);
        let kinds = [Kind::Robot, Kind::Old, Kind::Raw];
        let most = kinds.iter().map(|kind| of(*kind)).max()?;
        kinds
            .into_iter()
            .find(|kind| of(*kind) > 0 && 2 * of(*kind) >= most)
    }

    /// Returns all lasers, by their numbers; the first one gets the topic `/scan`.
    pub(super) fn sources(&self) -> Vec<Source> {
        let mut sources: Vec<Source> = Vec::new();
        for number in 1..=5 {
            let Some(kind) = self.kind_of(number) else {
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
            let seen = self.seen.get(&(number, kind));
            sources.push(Source {
                number,
                kind,
                topic,
                frame: format!("laser{suffix}"),
                flipped: self.parameters.of(number).flipped.clone(),
                is_mirrored: seen.and_then(|seen| seen.turning.is_mirrored()),
                scans: 0,
                first: None,
            });
        }
        sources
    }
}

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

#[cfg(test)]
mod tests {
    use super::super::read::parse;
    use super::*;

    #[test]
    fn the_lines_that_show_more_are_taken() {
        let raw = "RAWLASER1 0 -1 2 1 80 0 0 1 5 0 1.0 h 1\n";
        let robot = "ROBOTLASER1 0 -1 2 1 80 0 0 1 5 0 0 0 0 0 0 0 0 0 0 0 0 1.0 h 1\n";
        let old = "FLASER 1 5 0 0 0 0 0 0 1.0 h 1\n";
        let rear = "RLASER 1 5 0 0 0 0 0 0 1.0 h 1\n";
        let of = |lines: &[&str]| {
            let mut survey = Survey::default();
            let lines = lines.iter().map(|line| parse(line).unwrap());
            lines.for_each(|line| survey.see(&line));
            let sources = survey.sources().into_iter();
            sources.map(|it| (it.number, it.kind)).collect::<Vec<_>>()
        };
        assert_eq!(of(&[]), []);
        assert_eq!(of(&[raw, raw]), [(1, Kind::Raw)]);
        let both = [(1, Kind::Robot), (2, Kind::Old)];
        assert_eq!(of(&[raw, robot, old, rear]), both);
        assert_eq!(of(&[raw, old]), [(1, Kind::Old)]);
        assert_eq!(of(&[raw, raw, raw, old]), [(1, Kind::Raw)]);
    }
}
