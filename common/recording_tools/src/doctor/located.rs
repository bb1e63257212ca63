//! Scans of a recording, located on its map one by one.

use clap::Parser;
use geometry::Pose;
use map::OccupancyGrid;
use messages::Verdict;
use offline::{Options, Session, TakenScan};
use recording::Recording;

/// Largest number of scans that are located: a minute of a laser of 8 Hz, seconds of computing.
const MAX_SCANS: usize = 500;

/// Number of scans that are compared with the map at several scales, spread over the others.
const SCALED_SCANS: usize = 12;

/// Factors by which the ranges of a scan are scaled.
pub(super) const SCALES: [f32; 11] = [
    0.9, 0.92, 0.94, 0.96, 0.98, 1.0, 1.02, 1.04, 1.06, 1.08, 1.1,
];

/// Index of the scale 1 in [`SCALES`].
pub(super) const AS_MEASURED: usize = 5;

/// Scans are not deskewed, because the motion within them is not known yet.
#[derive(Debug, Parser)]
struct Line {
    #[command(flatten)]
    options: Options,
}

/// Default options of the tools, without deskewing.
pub(super) fn options() -> Options {
    Line::parse_from(["doctor", "--deskew", "false"]).options
}

/// Scans of a recording that have a pose on its map.
pub(super) struct Located {
    pub(super) scans: Vec<LocatedScan>,
    /// Scores of the best poses of some scans at each of [`SCALES`].
    pub(super) by_scale: Vec<[f64; SCALES.len()]>,
    /// Map of the last scan.
    pub(super) map: OccupancyGrid,
}

pub(super) struct LocatedScan {
    pub(super) scan: TakenScan,
    pub(super) map_from_laser: Pose,
    pub(super) is_unique: bool,
    score: f64,
}

impl Located {
    /// Locates the scans. Other checks report a recording without a map, or one that cannot be read.
    pub(super) fn of(recording: &Recording, map: Option<&OccupancyGrid>) -> anyhow::Result<Self> {
        let mut session = Session::open(recording, &options(), map)?;
        let total = MAX_SCANS.min(session.scans.total() as usize);
        let every = total.div_ceil(SCALED_SCANS).max(1);
        let (mut scans, mut by_scale) = (Vec::new(), Vec::new());
        for i in 0..MAX_SCANS {
            let Some(scan) = session.scans.next() else {
                break;
            };
            let Ok(scan) = scan else {
                continue;
            };
            let Some(found) = locate(&mut session, scan)? else {
                continue;
            };
            if i % every == every / 2 {
                by_scale.push(scores(&mut session, &found)?);
            }
            scans.push(found);
        }
        Ok(Located {
            scans,
            by_scale,
            map: session.map()?.clone(),
        })
    }
}

fn locate(session: &mut Session<'_>, scan: TakenScan) -> anyhow::Result<Option<LocatedScan>> {
    let Ok(answer) = session.ask(&scan)?.answer else {
        return Ok(None);
    };
    let is_unique = answer.places.verdict == Verdict::Unique;
    Ok(answer.places.places.first().map(|best| LocatedScan {
        map_from_laser: best.map_from_laser,
        is_unique,
        score: best.score,
        scan,
    }))
}

fn scores(session: &mut Session<'_>, found: &LocatedScan) -> anyhow::Result<[f64; SCALES.len()]> {
    let mut scores = [found.score; SCALES.len()];
    let changed = scores.iter_mut().zip(SCALES);
    for (score, scale) in changed.filter(|(_, scale)| *scale != 1.0) {
        let mut scaled = found.scan.clone();
        scaled.message.range_max *= scale;
        scaled
            .message
            .ranges
            .iter_mut()
            .for_each(|range| *range *= scale);
        *score = locate(session, scaled)?.map_or(0.0, |found| found.score);
    }
    Ok(scores)
}
