//! A picture for each scan whose answer is not as expected.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use geometry::Pose;
use map::OccupancyGrid;
use plots::{Contrast, PlotError, draw_contrast};
use recording::{Kind, Message, Recording};
use ros::LaserScan;

use super::answer::Answer;
use super::case::Case;
use super::compare::Difference;
use crate::RegressionError;

/// Most pictures of one recording: who changes all answers looks at some.
const MAX: usize = 20;

/// What is said of a recording's pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Drawn {
    pub(super) pictures: usize,
    /// Scans that differ.
    pub(super) scans: usize,
}

/// Draws the scans that differ, at most the first twenty, each to a file in
/// `folder` that is called after the recording and the scan's stamp.
///
/// # Errors
/// The recording or its map cannot be read, or a picture not be written.
pub(super) fn write(
    folder: &Path,
    case: &Case,
    (expected, found): (&[Answer], &[Answer]),
    differences: &[Difference],
) -> Result<Drawn, RegressionError> {
    let by_scan = by_scan(differences);
    let drawn = Drawn {
        pictures: by_scan.len().min(MAX),
        scans: by_scan.len(),
    };
    if by_scan.is_empty() {
        return Ok(drawn);
    }
    let map = map::load(case.map())?;
    let scans = scans(case, |stamp_ns| by_scan.contains_key(&stamp_ns))?;
    fs::create_dir_all(folder).map_err(|source| failed(folder.to_owned(), source))?;
    for (stamp_ns, differences) in by_scan.iter().take(MAX) {
        let contrast = Contrast {
            title: format!("{} · scan of {stamp_ns} ns", case.name),
            says: says(differences),
            ends: scans.get(stamp_ns).map(ends).unwrap_or_default(),
            expected: pose_of(expected, *stamp_ns),
            found: pose_of(found, *stamp_ns),
        };
        let file = folder.join(format!("{}_{stamp_ns}.png", case.name));
        draw(&file, &map, &contrast)?;
    }
    Ok(drawn)
}

fn draw(file: &Path, map: &OccupancyGrid, contrast: &Contrast) -> Result<(), RegressionError> {
    let picture = drawing::to_png(&draw_contrast(map, contrast)?)?;
    fs::write(file, picture).map_err(|source| failed(file.to_owned(), source))
}

fn failed(file: PathBuf, source: std::io::Error) -> RegressionError {
    PlotError::Picture { file, source }.into()
}

fn by_scan(differences: &[Difference]) -> BTreeMap<i64, Vec<&Difference>> {
    let mut by_scan: BTreeMap<i64, Vec<&Difference>> = BTreeMap::new();
    for difference in differences {
        let of_scan = by_scan.entry(difference.stamp_ns).or_default();
        of_scan.push(difference);
    }
    by_scan
}

/// What differs, in a line.
fn says(differences: &[&Difference]) -> String {
    let one = |d: &&Difference| format!("{} {}, expected {}", d.what, d.found, d.expected);
    let all: Vec<String> = differences.iter().map(one).collect();
    all.join(" · ")
}

/// The scans of some stamps.
fn scans(
    case: &Case,
    is_wanted: impl Fn(i64) -> bool,
) -> Result<BTreeMap<i64, LaserScan>, RegressionError> {
    let recording = Recording::open(case.recording())?;
    let topic = recording.required_topic(Kind::Scan)?;
    let mut scans = BTreeMap::new();
    // What cannot be read, the graph did not answer either.
    for record in recording.records_of(&[Kind::Scan]).flatten() {
        if let Message::Scan(scan) = record.message
            && record.topic == topic
            && is_wanted(scan.header.stamp.as_ns())
        {
            scans.insert(scan.header.stamp.as_ns(), scan);
        }
    }
    Ok(scans)
}

/// Where the beams end, in the laser's frame.
fn ends(scan: &LaserScan) -> Vec<(f64, f64)> {
    let bearing =
        |beam: usize| f64::from(scan.angle_min) + beam as f64 * f64::from(scan.angle_increment);
    let is_return = |range: f32| (scan.range_min..=scan.range_max).contains(&range);
    let beams = scan.ranges.iter().enumerate();
    beams
        .filter(|&(_, &range)| is_return(range))
        .map(|(beam, &range)| {
            let (sin, cos) = bearing(beam).sin_cos();
            (f64::from(range) * cos, f64::from(range) * sin)
        })
        .collect()
}

fn pose_of(answers: &[Answer], stamp_ns: i64) -> Option<Pose> {
    let answer = answers.iter().find(|answer| answer.stamp_ns == stamp_ns)?;
    let heading = answer.heading_deg?.to_radians();
    Some(Pose::new(answer.x_m?, answer.y_m?, heading))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beams_end_where_they_point_and_what_is_no_return_ends_nowhere() {
        let scan = LaserScan {
            angle_min: 0.0,
            angle_increment: std::f32::consts::FRAC_PI_2,
            range_min: 0.1,
            range_max: 10.0,
            ranges: vec![2.0, 3.0, f32::INFINITY, f32::NAN, 0.05],
            ..LaserScan::default()
        };
        let ends = ends(&scan);
        assert_eq!(ends[0], (2.0, 0.0));
        // A right angle of 32 bits.
        assert!((ends[1].0.abs() + (ends[1].1 - 3.0).abs()) < 1e-6);
        assert_eq!(ends.len(), 2);
    }

    #[test]
    fn differences_of_one_scan_share_a_line() {
        let difference = |stamp_ns, what| Difference {
            stamp_ns,
            what,
            expected: "1".to_owned(),
            found: "2".to_owned(),
        };
        let all = [
            difference(1, "best"),
            difference(2, "x_m"),
            difference(1, "votes"),
        ];
        let by_scan = by_scan(&all);
        assert_eq!(by_scan.len(), 2);
        assert_eq!(
            says(&by_scan[&1]),
            "best 2, expected 1 · votes 2, expected 1"
        );
    }
}
