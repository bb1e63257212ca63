//! The first reading of a log: what has to be known before its first scan can be
//! written.

use std::collections::BTreeMap;
use std::io::BufRead;

use super::angles;
use super::carmen::{Kind, Laser, Line};
use super::file::for_each_line;
use super::parameters::Parameters;
use super::read;
use super::turning::Turning;

/// What a log says of its lasers.
#[derive(Debug, Default)]
pub(super) struct Survey {
    pub(super) parameters: Parameters,
    /// Scans that can be read.
    scans: BTreeMap<(u8, Kind), u64>,
    /// Of lasers that are said to be mounted upside down.
    turnings: BTreeMap<(u8, Kind), Turning>,
}

impl Survey {
    /// Reads a log to its end, or to where it is damaged.
    pub(super) fn of(log: impl BufRead) -> Survey {
        let mut survey = Survey::default();
        let mut heading = None;
        let read = for_each_line(log, |_, line| {
            match read::parse(line) {
                Ok(Line::Laser(laser)) => survey.laser(&laser, heading),
                Ok(Line::Odometry(odometry)) => heading = Some(odometry.robot.yaw),
                Ok(Line::Parameter(parameter)) => survey.parameters.note(&parameter),
                Ok(Line::Nothing | Line::Other(_)) | Err(_) => {}
            }
            Ok::<_, std::convert::Infallible>(())
        });
        // What cannot be read is reported by the second pass.
        drop(read);
        survey
    }

    fn laser(&mut self, laser: &Laser, heading: Option<f64>) {
        let key = (laser.number, laser.kind);
        *self.scans.entry(key).or_default() += 1;
        let mounting = self.parameters.of(laser.number);
        if mounting.flipped.is_none() {
            return;
        }
        let yaw = laser.poses.map(|poses| poses.laser.yaw).or(heading);
        if let (Some(yaw), Ok((_, step))) = (yaw, angles::of(laser, mounting)) {
            self.turnings.entry(key).or_default().note(laser, yaw, step);
        }
    }

    /// The numbers of all lasers, from the front one.
    pub(super) fn lasers(&self) -> Vec<u8> {
        let mut numbers: Vec<u8> = self.scans.keys().map(|(number, _)| *number).collect();
        numbers.dedup();
        numbers
    }

    /// The kind of line that a laser's scans are taken from. CARMEN logs the same scan
    /// as it comes and again with poses; the lines with more data are taken, unless
    /// they are the fewer by far.
    pub(super) fn kind_of(&self, number: u8) -> Option<Kind> {
        let of = |kind| self.scans.get(&(number, kind)).copied().unwrap_or_default();
        let kinds = [Kind::Robot, Kind::Old, Kind::Raw];
        let most = kinds.iter().map(|kind| of(*kind)).max()?;
        kinds
            .into_iter()
            .find(|kind| of(*kind) > 0 && 2 * of(*kind) >= most)
    }

    /// For a laser that is said to be mounted upside down: whether its beams run the
    /// other way than the line says, or `None` if the scans do not show it.
    pub(super) fn is_mirrored(&self, number: u8, kind: Kind) -> Option<bool> {
        self.turnings.get(&(number, kind))?.is_mirrored()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lines_that_show_more_are_taken() {
        let raw = "RAWLASER1 0 -1 2 1 80 0 0 1 5 0 1.0 h 1\n";
        let robot = "ROBOTLASER1 0 -1 2 1 80 0 0 1 5 0 0 0 0 0 0 0 0 0 0 0 0 1.0 h 1\n";
        let old = "FLASER 1 5 0 0 0 0 0 0 1.0 h 1\n";
        let rear = "RLASER 1 5 0 0 0 0 0 0 1.0 h 1\n";
        let of = |lines: &[&str]| {
            let survey = Survey::of(lines.concat().as_bytes());
            (survey.lasers(), survey.kind_of(1))
        };
        assert_eq!(of(&[]), (vec![], None));
        assert_eq!(of(&[raw, raw]), (vec![1], Some(Kind::Raw)));
        assert_eq!(
            of(&[raw, robot, old, rear]),
            (vec![1, 2], Some(Kind::Robot))
        );
        assert_eq!(of(&[raw, old]), (vec![1], Some(Kind::Old)));
        assert_eq!(of(&[raw, raw, raw, old]), (vec![1], Some(Kind::Raw)));
    }
}
