//! A session searches the scans of one recording on its map.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::Context;
use engine::fit::Ends;
use engine::joined::ByOdometry;
use engine::peaks::Target;
use geometry::Pose;
use index_cache::{CachePlace, IndexCache, Kept, Unsaved};
use map::OccupancyGrid;
use messages::{Odometry, UNKNOWN};
use recording::{Recording, RecordingError};
use transport::with_causes;

use super::heading::Headings;
use super::maps::{Maps, frame_of, sides_of};
use super::motion::Motion;
use super::options::{EngineOptions, NamedMap};
use super::scans::Scans;
use super::world::{Answer, World, unusable};
use super::{NoUsableMap, Options, TakenScan, cpu};

pub struct Session<'a> {
    pub scans: Scans<'a>,
    /// CPU time of preparing maps, in milliseconds.
    pub prepare_cpu_ms: f64,
    maps: Maps<'a>,
    /// Map of the last scan that was searched.
    prepared: Option<Prepared<'a>>,
    /// Reason why the newest map cannot be used.
    refusal: String,
    notes: Vec<String>,
    said: BTreeSet<String>,
    map_file: PathBuf,
    engine: EngineOptions,
    cache: Option<IndexCache>,
    headings: Headings,
    motion: Motion<'a>,
}

struct Prepared<'a> {
    map: Cow<'a, OccupancyGrid>,
    /// Id of the original map, before any cells were erased.
    map_id: u64,
    world: World,
}

/// Tracker input of one scan.
pub struct View {
    /// End points of the beams, in the laser's frame.
    pub ends: Ends,
    /// Pose of the target frame by odometry.
    pub by_odometry: Option<ByOdometry>,
    pub target: Target,
}

pub struct Reply<'a> {
    /// The map's id, as in the graph's messages; 0 without a map.
    pub map_id: u64,
    /// CPU time from the scan to the verdict or rejection, in milliseconds, without decoding.
    pub cpu_ms: f64,
    /// The places, or the reason for the rejection.
    pub answer: anyhow::Result<Answer<'a>>,
}

impl<'a> Session<'a> {
    /// Opens a session on the given map, else on the maps of the recording.
    /// Fails if data is missing, or the given map cannot be used. If data is missing in a damaged
    /// file, the damage is the error.
    pub fn open(
        recording: &'a Recording,
        options: &Options,
        given: Option<&'a OccupancyGrid>,
    ) -> anyhow::Result<Self> {
        let mut session = Session::unprepared(recording, options)?;
        if let Some(map) = given {
            // An unusable given map is an error at once, since no scan could be searched.
            let prepared = session.prepare(Cow::Borrowed(map))?;
            prepared.with_context(|| unusable(&session.map_file.to_string_lossy()))?;
            return Ok(session);
        }
        session.maps = Maps::recorded(recording, options.engine.cells)?;
        Ok(session)
    }

    fn unprepared(recording: &'a Recording, options: &Options) -> anyhow::Result<Self> {
        let damage = |error| match error {
            RecordingError::NoTopic { .. } => recording.damage_error().unwrap_or(error),
            other => other,
        };
        let topics = options.topics.scans(recording).map_err(damage)?;
        let headings =
            Headings::of(&options.heading, &options.motion, recording).map_err(damage)?;
        let map_file = options.map.first().map(PathBuf::as_path);
        Ok(Session {
            motion: Motion::of(recording, &topics, &options.motion),
            scans: Scans::of(recording, topics, options.every),
            prepare_cpu_ms: 0.0,
            maps: Maps::none(),
            prepared: None,
            refusal: String::new(),
            notes: headings.notes.clone(),
            said: BTreeSet::new(),
            map_file: map_file.unwrap_or(recording.path()).to_owned(),
            engine: options.engine.clone(),
            cache: options.index_cache.open(CachePlace::Off)?,
            headings,
        })
    }

    /// Opens a session that searches several maps together for each scan.
    pub fn open_on(
        recording: &'a Recording,
        options: &Options,
        maps: &[NamedMap],
    ) -> anyhow::Result<Self> {
        let Some(first) = maps.first() else {
            return Session::open(recording, options, None);
        };
        let mut session = Session::unprepared(recording, options)?;
        let prior = session.headings.source.prior();
        let cache = session.cache.as_ref();
        let prepare = || World::of_set(maps, &options.engine, prior, cache);
        let (prepared, cpu_ms) = cpu::timed(prepare)?;
        session.prepare_cpu_ms += cpu_ms;
        let (world, kept) = prepared?;
        kept.into_iter().for_each(|kept| session.keep(kept));
        session.prepared = Some(Prepared {
            map: Cow::Owned(first.grid.clone()),
            map_id: first.grid.id(),
            world,
        });
        Ok(session)
    }

    /// Map of the last scan that was searched.
    pub fn map(&self) -> anyhow::Result<&OccupancyGrid> {
        Ok(&self.prepared()?.map)
    }

    pub fn world(&self) -> anyhow::Result<&World> {
        Ok(&self.prepared()?.world)
    }

    /// Returns the notes since the last call, each text once per session.
    pub fn take_notes(&mut self) -> Vec<String> {
        self.notes.extend(self.scans.take_notes());
        self.notes.extend(self.motion.take_notes());
        let mut notes = std::mem::take(&mut self.notes);
        notes.retain(|note| self.said.insert(note.clone()));
        notes
    }

    fn prepared(&self) -> anyhow::Result<&Prepared<'a>> {
        let none = || no_usable_map(&self.map_file, &self.refusal);
        self.prepared.as_ref().ok_or_else(none)
    }

    /// Prepares the map for a scan. A map that cannot be used is ignored, as in the graph.
    fn turn_to(&mut self, scan: &TakenScan) -> anyhow::Result<()> {
        let mut newest = None;
        while let Some(map) = self.maps.next_for(scan.log_time_ns) {
            match map {
                Ok(map) => newest = Some(map),
                Err(refusal) => self.refuse(refusal),
            }
        }
        if let Some(map) = newest
            && let Err(error) = self.prepare(Cow::Owned(map))?
        {
            self.refuse(with_causes(&error));
        }
        Ok(())
    }

    fn refuse(&mut self, refusal: String) {
        let file = self.map_file.display();
        self.notes
            .push(format!("{file}: a map is ignored: {refusal}"));
        self.refusal = refusal;
    }

    fn prepare(
        &mut self,
        map: Cow<'a, OccupancyGrid>,
    ) -> anyhow::Result<Result<(), engine::EngineError>> {
        let map_id = map.id();
        if self.prepared.as_ref().is_some_and(|p| p.map_id == map_id) {
            return Ok(Ok(()));
        }
        let prior = self.headings.source.prior();
        let cache = self.cache.as_ref();
        let prepare = || World::prepare_with(&map, &self.engine, prior, cache);
        let (prepared, cpu_ms) = cpu::timed(prepare)?;
        self.prepare_cpu_ms += cpu_ms;
        Ok(prepared.map(|(world, kept)| {
            self.keep(kept);
            self.prepared = Some(Prepared { map, map_id, world });
        }))
    }

    /// Notes problems with a cached index, and saves a new index.
    fn keep(&mut self, kept: Kept) {
        let saved = kept.unsaved.map(Unsaved::save);
        let problems = kept.problem.into_iter().chain(saved.and_then(Result::err));
        let notes = problems.map(|problem| format!("cached index: {}", with_causes(&problem)));
        self.notes.extend(notes);
    }

    /// Prepares the map of a scan again with all cells within `radius_m` of `centre` unknown.
    pub fn erase(&mut self, scan: &TakenScan, centre: Pose, radius_m: f64) -> anyhow::Result<()> {
        self.turn_to(scan)?;
        let prior = self.headings.source.prior();
        let Some(prepared) = &mut self.prepared else {
            return Ok(());
        };
        let mut map = prepared.map.clone().into_owned();
        let (frame, (width, _)) = (frame_of(&map), sides_of(&map));
        for (i, cell) in map.cells.iter_mut().enumerate() {
            let (x, y) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            if frame.map_from_cells(x, y, 0.0).distance_to(centre) <= radius_m {
                *cell = UNKNOWN;
            }
        }
        let world = World::prepare(&map, &self.engine, prior);
        prepared.world = world.with_context(|| unusable(&self.map_file.to_string_lossy()))?;
        Ok(())
    }

    /// Reads the odometry even if no option needs it.
    pub fn read_odometry(&mut self) -> anyhow::Result<()> {
        Ok(self.motion.read_odometry()?)
    }

    /// Drops all scans, and uses this odometry, for another search of the drive.
    pub fn begin_again(&mut self, odometry: &[Odometry]) {
        self.motion.begin_again(odometry);
    }

    /// Pose of the target frame by odometry at a scan, without searching the scan.
    pub fn by_odometry(&mut self, scan: &TakenScan) -> anyhow::Result<Option<ByOdometry>> {
        self.motion.take(scan)?;
        Ok(self.motion.joiner.by_odometry())
    }

    /// Tracker input of the last scan that was searched.
    pub fn view(&self, scan: &TakenScan) -> anyhow::Result<View> {
        let seen = self.motion.joiner.seen();
        let ends = self.world()?.ends(seen.observation());
        Ok(View {
            ends: ends?,
            by_odometry: self.motion.joiner.by_odometry(),
            target: Target::of(scan.base_from_laser, self.motion.joiner.targets_base()),
        })
    }

    /// Searches the place of a scan.
    /// Fails if the CPU clock cannot be read. A rejected scan is a reply.
    pub fn ask(&mut self, scan: &TakenScan) -> anyhow::Result<Reply<'_>> {
        self.turn_to(scan)?;
        let refused = |map_id, refusal| Reply {
            map_id,
            cpu_ms: 0.0,
            answer: Err(refusal),
        };
        let Some(prepared) = &mut self.prepared else {
            return Ok(refused(0, no_usable_map(&self.map_file, &self.refusal)));
        };
        let mut map_id = prepared.world.map_id;
        let heading = match self.headings.of_scan(scan) {
            Ok(heading) => heading,
            Err(refusal) => return Ok(refused(map_id, refusal.into())),
        };
        let motion = &mut self.motion;
        if let Err(refusal) = motion.take(scan) {
            return Ok(refused(map_id, refusal));
        }
        let target = Target::of(scan.base_from_laser, motion.joiner.targets_base());
        let (found, cpu_ms) = cpu::timed(|| {
            motion.bring()?;
            let heading = heading.map(|heading| motion.joiner.target_heading(heading));
            let seen = motion.joiner.seen();
            prepared.world.locate(seen.observation(), heading, target)
        })?;
        if let Ok(Answer { map, .. }) = &found {
            map_id = map.id;
        }
        Ok(Reply {
            map_id,
            cpu_ms,
            answer: found.map_err(Into::into),
        })
    }
}

fn no_usable_map(file: &Path, reason: &str) -> anyhow::Error {
    let (file, reason) = (file.to_owned(), reason.to_owned());
    NoUsableMap { file, reason }.into()
}
