//! One recording on one map: everything read and prepared, ready to be asked
//! scan by scan.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use engine::localizer::Prior;
use geometry::Pose;
use map::OccupancyGrid;
use messages::UNKNOWN;
use recording::{Recording, RecordingError};

use super::heading::Headings;
use super::layout::{frame_of, sides_of};
use super::options::EngineOptions;
use super::scans::Scans;
use super::world::{Answer, World};
use super::{Options, TakenScan, cpu};
use crate::BackcastError;

/// A recording that is being gone through.
pub(crate) struct Session<'a> {
    pub(crate) scans: Scans<'a>,
    pub(crate) world: World,
    /// Milliseconds of computing that preparing the map has cost.
    pub(crate) prepare_cpu_ms: f64,
    pub(crate) map: Cow<'a, OccupancyGrid>,
    map_file: PathBuf,
    engine: EngineOptions,
    headings: Headings,
}

/// What came of one scan.
pub(crate) struct Reply<'a> {
    /// Milliseconds of computing from the scan to the verdict or the refusal;
    /// decoding is not in it.
    pub(crate) cpu_ms: f64,
    /// The places, or why the scan is refused.
    pub(crate) answer: Result<Answer<'a>, BackcastError>,
}

impl<'a> Session<'a> {
    /// Prepares the map that is given, else the one in the recording.
    ///
    /// # Errors
    /// Something that is needed is not there or cannot be used. Where something
    /// is missing in a damaged file, the damage is the error.
    pub(crate) fn open(
        recording: &'a Recording,
        options: &Options,
        given: Option<&'a OccupancyGrid>,
    ) -> Result<Self, BackcastError> {
        let damage = |error| match error {
            RecordingError::NoTopic { .. } => damage_of(recording).unwrap_or(error),
            other => other,
        };
        let scans = Scans::of(recording, options.every).map_err(damage)?;
        let headings = Headings::of(&options.heading, recording).map_err(damage)?;
        let map = match given {
            Some(map) => Cow::Borrowed(map),
            None => Cow::Owned(map_in(recording)?),
        };
        let map_file = map_file(options, recording.path());
        let prior = headings.source().prior();
        let prepare = || prepared(&map, &map_file, &options.engine, prior);
        let (world, prepare_cpu_ms) = cpu::timed(prepare)?;
        Ok(Session {
            scans,
            world: world?,
            prepare_cpu_ms,
            map,
            map_file,
            engine: options.engine.clone(),
            headings,
        })
    }

    /// Prepares the map anew, unknown within a radius, metres, of a point.
    ///
    /// # Errors
    /// Nothing is left that could be used.
    pub(crate) fn erase(&mut self, centre: Pose, radius_m: f64) -> Result<(), BackcastError> {
        let mut map = self.map.clone().into_owned();
        let (frame, (width, _)) = (frame_of(&map), sides_of(&map));
        for (i, cell) in map.cells.iter_mut().enumerate() {
            let (x, y) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            if frame.map_from_cells(x, y, 0.0).distance_to(centre) <= radius_m {
                *cell = UNKNOWN;
            }
        }
        let prior = self.headings.source().prior();
        self.world = prepared(&map, &self.map_file, &self.engine, prior)?;
        Ok(())
    }

    /// Finds the place of a scan.
    ///
    /// # Errors
    /// The clock fails. A scan that is refused is a reply.
    pub(crate) fn ask(&mut self, scan: &TakenScan) -> Result<Reply<'_>, BackcastError> {
        let heading = match self.headings.of_scan(scan) {
            Ok(heading) => heading,
            Err(refusal) => {
                return Ok(Reply {
                    cpu_ms: 0.0,
                    answer: Err(refusal.into()),
                });
            }
        };
        let borrowed = scan.borrowed();
        let (found, cpu_ms) = cpu::timed(|| self.world.locate(&borrowed, heading))?;
        let answer = found.map_err(BackcastError::Refused);
        Ok(Reply { cpu_ms, answer })
    }
}

fn prepared(
    map: &OccupancyGrid,
    file: &Path,
    options: &EngineOptions,
    prior: Prior,
) -> Result<World, BackcastError> {
    World::prepare(map, options, prior).map_err(|source| BackcastError::UnusableMap {
        file: file.into(),
        source,
    })
}

/// The damage of a recording, as an error.
pub(crate) fn damage_of(recording: &Recording) -> Option<RecordingError> {
    let damage = recording.damage()?.clone();
    Some(RecordingError::Damaged {
        path: recording.path().to_owned(),
        readable: recording.messages(),
        damage,
    })
}

/// The map that a recording holds.
///
/// # Errors
/// It holds none, or one that cannot be used.
pub(crate) fn map_in(recording: &Recording) -> Result<OccupancyGrid, BackcastError> {
    if let Some(map) = recording.map()? {
        return Ok(map);
    }
    Err(match damage_of(recording) {
        Some(damage) => damage.into(),
        None => BackcastError::NoMap {
            recording: recording.path().to_owned(),
        },
    })
}

fn map_file(options: &Options, bag: &Path) -> PathBuf {
    options.map.as_deref().unwrap_or(bag).to_owned()
}
