//! First pass over a log: gathers what must be known before the first scan is written.

use std::collections::BTreeMap;
use std::io::BufRead;

use super::angles;
use super::carmen::{Kind, Laser, Line};
use super::file::for_each_line;
use super::parameters::Parameters;
use super::read;
use super::turning::Turning;

#[derive(Debug, Default)]
pub(super) struct Survey {
    pub(super) parameters: Parameters,
    /// Number of readable scans, by laser and kind of line.
    scans: BTreeMap<(u8, Kind), u64>,
    /// Beam directions of lasers that are marked as upside down.
    turnings: BTreeMap<(u8, Kind), Turning>,
}

impl Survey {
    /// Reads a log to its end, or to its damage.
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
        // Damage is reported by the second pass.
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

    /// Numbers of all lasers in increasing order; 1 is the front one.
    pub(super) fn lasers(&self) -> Vec<u8> {
        let mut numbers: Vec<u8> = self.scans.keys().map(|(number, _)| *number).collect();
        numbers.dedup();
        numbers
    }

    /// Kind of line that the scans of a laser are taken from. CARMEN logs a scan when it arrives
    /// and again with poses; lines with more data are preferred, unless there are less than half as
    /// many of them.
    pub(super) fn kind_of(&self, number: u8) -> Option<Kind> {
        let of = |kind| self.scans.get(&(number, kind)).copied().unwrap_or_default();
        let kinds = [Kind::Robot, Kind::Old, Kind::Raw];
        let most = kinds.iter().map(|kind| of(*kind)).max()?;
        kinds
            .into_iter()
            .find(|kind| of(*kind) > 0 && 2 * of(*kind) >= most)
    }

    /// For a laser that is marked as upside down: true if its beams run opposite to the order in
    /// the line; `None` if the scans do not show it.
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
