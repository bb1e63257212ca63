//! Compares several bands of heights of a point cloud by how well their scans fit the map.

use map::OccupancyGrid;
use offline::Session;
use recording::Recording;
use ros::{CloudOptions, Heights};

use super::finding::Finding;
use super::located;

/// Bands that are compared with the chosen one, metres over the floor: from the legs of furniture to
/// above the heads of people.
const BANDS: [[f64; 2]; 5] = [[0.05, 0.3], [0.2, 0.6], [0.5, 1.0], [1.0, 1.5], [1.8, 2.4]];

/// Number of scans of each band, spread over the recording.
const SCANS: u64 = 12;

/// Difference of mean scores from which a band is better: bands that see the same walls differ by
/// less.
const CLEARLY: f64 = 0.03;

/// Smallest number of readings of a scan that count, a twelfth of a turn: fewer fit anywhere.
const MIN_READINGS: usize = 120;

/// Returns a note on the chosen band and the best one, if a point cloud is the laser. Other checks
/// report a recording without a map, or one that cannot be read.
pub(super) fn compare(
    recording: &mut Recording,
    options: &CloudOptions,
    map: Option<&OccupancyGrid>,
) -> anyhow::Result<Option<Finding>> {
    if options.cloud_topic.is_none() {
        return Ok(None);
    }
    let others = BANDS.map(|[min_m, max_m]| Heights { min_m, max_m });
    let mut fits = Vec::new();
    let others = others.into_iter().filter(|other| *other != options.heights);
    for heights in std::iter::once(options.heights).chain(others) {
        recording.take_cloud(&CloudOptions {
            heights,
            ..options.clone()
        })?;
        fits.push((heights, fit(recording, map)?));
    }
    recording.take_cloud(options)?;
    let best = fits.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let (Some((chosen, fit)), Some((better, most))) = (fits.first(), best) else {
        return Ok(None);
    };
    let words = match most - fit < CLEARLY {
        true => format!("no other of {} bands fits clearly better", fits.len()),
        false => format!(
            "of {} bands, --heights {better} fits best, by {most:.2}",
            fits.len()
        ),
    };
    Ok(Some(Finding::note(format!(
        "readings of the heights {chosen} fit the map by {fit:.2}; {words}"
    ))))
}

/// Mean score of some scans at their best places; 0 for a scan with too few readings.
fn fit(recording: &Recording, map: Option<&OccupancyGrid>) -> anyhow::Result<f64> {
    let mut session = Session::open(recording, &located::options(), map)?;
    let every = session.scans.total().div_ceil(SCANS).max(1) as usize;
    let (mut scores, mut count) = (0.0, 0);
    for i in 0.. {
        let Some(scan) = session.scans.next() else {
            break;
        };
        if i % every != every / 2 {
            continue;
        }
        count += 1;
        let Ok(scan) = scan else {
            continue;
        };
        let ranges = scan.message.ranges.iter();
        if ranges.filter(|range| range.is_finite()).count() < MIN_READINGS {
            continue;
        }
        if let Ok(answer) = session.ask(&scan)?.answer {
            scores += answer.places.places.first().map_or(0.0, |best| best.score);
        }
    }
    Ok(scores / f64::from(count.max(1)))
}
