//! The command `backcast plot`: reads, asks, has a scene drawn, and writes it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

use crate::drawing::Scene;
use anyhow::{Context, anyhow, bail};
use command_line::{output, say, stdout, wrong_use};
use engine::EngineError;
use engine::grid::Grid;
use engine::heading::HeadingError;
use engine::peaks::Places;
use engine::vote_search::Prior;
use geometry::Pose;
use map::OccupancyGrid;
use messages::Verdict;
use offline::{
    Field, NoUsableMap, Progress, Session, TakenScan, World, map_in, no_truth_taken, no_truths,
};
use recording::{GroundTruth, Recording, RecordingError};

use super::config::{Config, Format, Kind};
use super::errors::Judged;
use super::field::Votes;
use super::subject::Subject;
use super::{animation, errors, field, outline, scan, surface};

pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let format = config.check()?;
    // Before anything is read, so that a failure costs no work.
    output::prepare(&config.out, config.force)?;
    let given = config.options.load_map(&config.bag)?;
    if config.kind == Kind::Drive {
        return run_drive(config, given.as_ref());
    }
    let scene = match &config.bag[..] {
        [] => draw_map(config, given, None)?,
        bag => {
            let recording = config.options.open(bag)?;
            match config.kind {
                Kind::Map => draw_map(config, given, Some(&recording))?,
                _ => Plot::open(config, &recording, given.as_ref())?.draw()?,
            }
        }
    };
    let bytes = match format {
        Format::Png => crate::drawing::to_png(&scene)?,
        Format::Svg => crate::drawing::to_svg(&scene).into_bytes(),
    };
    write(&config.out, &bytes)?;
    let (width, height) = (scene.width(), scene.height());
    let file = config.out.display();
    stdout::print(&format!("{file}: {width} x {height} pixels\n"))?;
    Ok(ExitCode::SUCCESS)
}

fn run_drive(config: &Config, given: Option<&OccupancyGrid>) -> anyhow::Result<ExitCode> {
    let recording = config.options.open(&config.bag)?;
    let mut plot = Plot::open(config, &recording, given)?;
    let subjects = plot.subjects()?;
    let (ground, name) = (config.ground(plot.session.map()?), plot.name());
    let frames = animation::frames(&ground, &subjects, &name, config.size());
    let bytes = crate::drawing::to_animated_png(frames)?;
    write(&config.out, &bytes)?;
    let (file, scans, kilobytes) = (config.out.display(), subjects.len(), bytes.len() / 1000);
    stdout::print(&format!("{file}: {scans} scans, {kilobytes} kB\n"))?;
    Ok(ExitCode::SUCCESS)
}

pub fn save_png(scene: &Scene, file: &Path) -> anyhow::Result<()> {
    write(file, &crate::drawing::to_png(scene)?)
}

fn write(file: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    fs::write(file, bytes).with_context(|| format!("cannot write {}", file.display()))
}

/// The map that is given, else the one in the recording.
fn draw_map(
    config: &Config,
    given: Option<OccupancyGrid>,
    recording: Option<&Recording>,
) -> anyhow::Result<Scene> {
    let (map, file) = match (given, recording, config.options.map.first()) {
        (None, Some(recording), _) => (map_in(recording)?, recording.path()),
        (Some(map), _, Some(file)) => (map, file.as_path()),
        // `Config::check` asks for the one or the other.
        _ => return Err(wrong_use("--map or --bag is missing")),
    };
    let (width, height) = (map.width as usize, map.height as usize);
    let rules = config.options.engine.cells;
    let name = file.display().to_string();
    let grid = Grid::new(width, height, &map.cells, rules);
    let grid = grid.with_context(|| format!("{name} cannot be searched"))?;
    outline::draw(&config.ground(&map), &grid, &name, config.size())
}

struct Plot<'a> {
    config: &'a Config,
    recording: &'a Recording,
    session: Session<'a>,
    truths: BTreeMap<i64, GroundTruth>,
}

impl<'a> Plot<'a> {
    fn open(
        config: &'a Config,
        recording: &'a Recording,
        given: Option<&'a OccupancyGrid>,
    ) -> anyhow::Result<Self> {
        let truths = match config.no_truth {
            true => BTreeMap::new(),
            false => recording.ground_truths()?,
        };
        Ok(Plot {
            config,
            session: Session::open(recording, &config.options, given)?,
            recording,
            truths,
        })
    }

    fn draw(&mut self) -> anyhow::Result<Scene> {
        match self.config.kind {
            Kind::Errors => self.draw_errors(),
            _ => self.draw_scan(),
        }
    }

    fn name(&self) -> String {
        self.recording.path().display().to_string()
    }

    fn draw_scan(&mut self) -> anyhow::Result<Scene> {
        let number = self.config.scan.unwrap_or(1);
        let scan = self.nth_scan(number)?;
        let subject = self.subject(number, &scan)?;
        let (ground, name) = (self.config.ground(self.session.map()?), self.name());
        let size = self.config.size();
        if self.config.kind == Kind::Scan {
            return scan::draw(&ground, &subject, &name, size);
        }
        let field = self.field(&scan, &subject)?;
        let votes = Votes::of(ground, (&subject, &field), &name, size);
        match self.config.kind {
            Kind::Surface => surface::draw(&votes),
            _ => field::draw(&votes),
        }
    }

    fn nth_scan(&mut self, number: u64) -> anyhow::Result<TakenScan> {
        let mut seen = 0;
        for scan in self.session.scans.by_ref() {
            seen += 1;
            match scan {
                Ok(scan) if seen == number => return Ok(scan),
                // One that does not decode is in nobody's way but its own.
                Ok(_) => {}
                Err(RecordingError::Message { .. }) if seen < number => {}
                Err(error) => return Err(error.into()),
            }
        }
        let file = self.recording.path().display();
        bail!("{file}: there is no scan {number}; the scans taken are 1 to {seen}")
    }

    fn subject(&mut self, number: u64, scan: &TakenScan) -> anyhow::Result<Subject> {
        let answer = self.session.ask(scan)?.answer;
        let places = answer.map(|answer| answer.places.clone());
        for note in self.session.take_notes() {
            say(&note);
        }
        let truth = self.truths.get(&scan.stamp_ns).map(|truth| truth.pose);
        let world = self.session.world()?;
        Ok(Subject::new((number, scan), places?, truth, world)?)
    }

    fn field(&self, scan: &TakenScan, subject: &Subject) -> anyhow::Result<Field> {
        let Some(best) = subject.shown.first() else {
            return Err(no_place(
                self.recording.path(),
                subject.number,
                &subject.places,
            ));
        };
        let engine = &self.config.options.engine;
        let world = World::prepare(self.session.map()?, engine, Prior::Heading);
        let heading = best.place.map_from_laser.yaw;
        Ok(world.and_then(|world| world.field_at(&scan.borrowed(), heading))?)
    }

    fn draw_errors(&mut self) -> anyhow::Result<Scene> {
        if let Some(damage) = self.recording.damage_error() {
            return Err(damage.into());
        }
        if self.truths.is_empty() {
            return Err(no_truths(self.recording.path()));
        }
        let progress = Progress::new("locating", self.session.scans.total());
        let (mut judged, mut scans) = (Vec::new(), 0);
        while let Some(scan) = self.session.scans.next() {
            let scan = scan?;
            scans += 1;
            if let Some(truth) = self.truths.get(&scan.stamp_ns).map(|truth| truth.pose) {
                judged.push(self.judge(&scan, truth)?);
            }
            progress.step();
        }
        if judged.is_empty() {
            return Err(no_truth_taken(
                self.recording.path(),
                scans,
                self.truths.len(),
            ));
        }
        errors::draw(&judged, &self.name(), self.config.width)
    }

    fn judge(&mut self, scan: &TakenScan, truth: Pose) -> anyhow::Result<Judged> {
        let places = self.session.ask(scan)?.answer.ok();
        let places = places.map(|answer| answer.places);
        let best = places.and_then(|places| places.places.first());
        let off = best.map(|best| {
            let best = best.map_from_laser;
            (best.distance_to(truth), best.angle_to(truth).to_degrees())
        });
        Ok(Judged {
            stamp_ns: scan.stamp_ns,
            verdict: places.map_or(Verdict::NoScan, |places| places.verdict),
            off,
        })
    }

    fn subjects(&mut self) -> anyhow::Result<Vec<Subject>> {
        let progress = Progress::new("locating", self.session.scans.total());
        let (mut subjects, mut number) = (Vec::new(), 0);
        while let Some(scan) = self.session.scans.next() {
            number += 1;
            match self.subject(number, &scan?) {
                Ok(subject) => subjects.push(subject),
                Err(error) if is_refusal(&error) => say(&format!("scan {number}: {error}")),
                Err(error) => return Err(error),
            }
            progress.step();
        }
        Ok(subjects)
    }
}

/// Whether it is of one scan alone, so that the others can be drawn.
fn is_refusal(error: &anyhow::Error) -> bool {
    error.is::<EngineError>() || error.is::<HeadingError>() || error.is::<NoUsableMap>()
}

/// Error for a scan without a best place to draw anything at.
pub fn no_place(file: &Path, number: u64, places: &Places) -> anyhow::Error {
    let (file, says) = (file.display(), places.sentence());
    anyhow!("{file}: scan {number} has no place on this map: {says}")
}
