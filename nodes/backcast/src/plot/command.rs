//! What `backcast plot` does: reads, asks, has a scene drawn, and writes it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::ValueEnum;
use drawing::Scene;
use engine::grid::Grid;
use engine::localizer::Prior;
use map::OccupancyGrid;
use messages::Verdict;
use recording::{GroundTruth, Recording, RecordingError};

use super::errors::Judged;
use super::scan::Size;
use super::sheet::Panel;
use super::subject::{Ground, Subject};
use super::{errors, field, outline, scan, sheet, surface};
use crate::offline::{Field, Options, Progress, Session, TakenScan, World, damage_of, map_in};
use crate::{BackcastError, stdout};

/// What stands below the options.
pub(crate) const NOTES: &str = "\
Colours of beams: green ends at an obstacle, orange before one, red behind one, violet behind
unknown space. Places that fit about as well are fainter, and shown from near below the map.

Exit codes: 0 drawn, 1 failed, 2 wrong use";

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Kind {
    /// The map with its boundary cells
    Map,
    /// A scan at each of its places, and what became of its beams
    Scan,
    /// The votes of each position at the best heading
    Field,
    /// The same as a surface, from above and from behind
    Surface,
    /// The errors of all scans against /ground_truth, by their verdicts
    Errors,
    /// Some scans at their places, side by side
    Sheet,
}

/// What `backcast plot` takes.
#[derive(Debug, clap::Args)]
pub(crate) struct Config {
    /// What the picture shows
    #[arg(value_enum, default_value_t = Kind::Scan, value_name = "KIND")]
    kind: Kind,

    /// The recording: an MCAP file with ROS 2 messages
    #[arg(long, value_name = "FILE")]
    bag: Option<PathBuf>,

    /// The picture: a file whose name ends with .png or .svg
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// The scan: the N-th of those taken, as `locate` prints it in its N-th
    /// line [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    scan: Option<u64>,

    /// Panels of a sheet, 1..=64: so many scans, evenly spread [default: 12]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u8).range(1..=64))]
    panels: Option<u8>,

    /// Leave out /ground_truth, which may be of another map than --map
    #[arg(long)]
    no_truth: bool,

    /// Width of the picture, pixels, 200..=8000; its height follows
    #[arg(long, value_name = "PIXELS", default_value_t = 1200, value_parser = clap::value_parser!(u32).range(200..=8000))]
    width: u32,

    /// Show the whole map, not only the places and what the scan reaches
    #[arg(long)]
    whole: bool,

    #[command(flatten)]
    options: Options,
}

/// In what a picture is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Png,
    Svg,
}

/// Draws one picture and says how large it is.
///
/// # Errors
/// Options contradict each other, map or recording cannot be used, the scan is
/// refused, or the picture cannot be written.
pub(crate) fn run(config: &Config) -> Result<ExitCode, BackcastError> {
    let format = config.check()?;
    let given = config.options.load_map()?;
    let scene = match &config.bag {
        None => draw_map(config, given, None)?,
        Some(bag) => {
            let recording = Recording::open(bag)?;
            match config.kind {
                Kind::Map => draw_map(config, given, Some(&recording))?,
                _ => Plot::open(config, &recording, given)?.draw()?,
            }
        }
    };
    let bytes = match format {
        Format::Png => drawing::to_png(&scene)?,
        Format::Svg => drawing::to_svg(&scene)?.into_bytes(),
    };
    fs::write(&config.out, bytes).map_err(|source| BackcastError::Picture {
        file: config.out.clone(),
        source,
    })?;
    let (width, height) = (scene.width(), scene.height());
    let file = config.out.display();
    stdout::print(&format!("{file}: {width} x {height} pixels\n"))?;
    Ok(ExitCode::SUCCESS)
}

impl Config {
    /// Checks what no option can check alone; opens nothing.
    fn check(&self) -> Result<Format, BackcastError> {
        self.options.check()?;
        let usage = |text: String| Err(BackcastError::Usage(text));
        if self.bag.is_none() && (self.kind != Kind::Map || self.options.map.is_none()) {
            return usage(
                "--bag is missing: only the picture `map` does without, and then needs --map"
                    .into(),
            );
        }
        let is_of_scan = matches!(self.kind, Kind::Scan | Kind::Field | Kind::Surface);
        if self.scan.is_some() && !is_of_scan {
            return usage("--scan is for the pictures `scan`, `field` and `surface`".into());
        }
        if self.panels.is_some() && self.kind != Kind::Sheet {
            return usage("--panels is for the picture `sheet`".into());
        }
        if self.no_truth && matches!(self.kind, Kind::Map | Kind::Errors) {
            return usage("--no-truth is for the pictures of scans".into());
        }
        if self.whole && matches!(self.kind, Kind::Map | Kind::Errors) {
            return usage("--whole is for the pictures of scans".into());
        }
        let extension = self.out.extension().and_then(|name| name.to_str());
        match extension.map(str::to_ascii_lowercase).as_deref() {
            Some("png") => Ok(Format::Png),
            Some("svg") => Ok(Format::Svg),
            _ => usage(format!(
                "--out {}: the name must end with .png or .svg",
                self.out.display()
            )),
        }
    }

    fn size(&self) -> Size {
        Size {
            width: self.width,
            whole: self.whole,
        }
    }

    fn ground<'a>(&self, map: &'a OccupancyGrid) -> Ground<'a> {
        Ground {
            map,
            rules: self.options.engine.cells,
        }
    }
}

/// The map that is given, else the one in the recording.
fn draw_map(
    config: &Config,
    given: Option<OccupancyGrid>,
    recording: Option<&Recording>,
) -> Result<Scene, BackcastError> {
    let (map, file) = match (given, recording, &config.options.map) {
        (None, Some(recording), _) => (map_in(recording)?, recording.path()),
        (Some(map), _, Some(file)) => (map, file.as_path()),
        // `Config::check` asks for the one or the other.
        _ => return Err(BackcastError::Usage("--map or --bag is missing".into())),
    };
    let (width, height) = (map.width as usize, map.height as usize);
    let rules = config.options.engine.cells;
    let grid = Grid::new(width, height, &map.cells, rules);
    let grid = grid.map_err(|source| BackcastError::UnusableMap {
        file: file.to_owned(),
        source,
    })?;
    let name = file.display().to_string();
    outline::draw(&config.ground(&map), &grid, &name, config.size())
}

/// A recording and a map, ready to be drawn.
struct Plot<'a> {
    config: &'a Config,
    bag: &'a Path,
    map: OccupancyGrid,
    recording: &'a Recording,
    session: Session<'a>,
    truths: BTreeMap<i64, GroundTruth>,
}

impl<'a> Plot<'a> {
    fn open(
        config: &'a Config,
        recording: &'a Recording,
        given: Option<OccupancyGrid>,
    ) -> Result<Self, BackcastError> {
        let map = match given {
            Some(map) => map,
            None => map_in(recording)?,
        };
        let truths = match config.no_truth {
            true => BTreeMap::new(),
            false => recording.ground_truths()?,
        };
        Ok(Plot {
            config,
            bag: recording.path(),
            session: Session::open(recording, &config.options, Some(&map))?,
            map,
            recording,
            truths,
        })
    }

    fn draw(&mut self) -> Result<Scene, BackcastError> {
        match self.config.kind {
            Kind::Errors => self.draw_errors(),
            Kind::Sheet => self.draw_sheet(),
            _ => self.draw_scan(),
        }
    }

    fn name(&self) -> String {
        self.bag.display().to_string()
    }

    fn draw_scan(&mut self) -> Result<Scene, BackcastError> {
        let number = self.config.scan.unwrap_or(1);
        let scan = self.nth_scan(number)?;
        let subject = self.subject(number, &scan)?;
        let (ground, name) = (self.config.ground(&self.map), self.name());
        let size = self.config.size();
        if self.config.kind == Kind::Scan {
            return scan::draw(&ground, &subject, &name, size);
        }
        let field = self.field(&scan, &subject)?;
        match self.config.kind {
            Kind::Surface => surface::draw(&ground, (&subject, &field), &name, size),
            _ => field::draw(&ground, (&subject, &field), &name, size),
        }
    }

    /// The scan with a number from 1.
    fn nth_scan(&mut self, number: u64) -> Result<TakenScan, BackcastError> {
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
        Err(BackcastError::NoSuchScan {
            file: self.bag.to_owned(),
            wanted: number,
            found: seen,
        })
    }

    fn subject(&self, number: u64, scan: &TakenScan) -> Result<Subject, BackcastError> {
        let answer = self.session.ask(scan)?.answer?;
        let truth = self.truths.get(&scan.stamp_ns).map(|truth| truth.pose);
        Subject::new((number, scan), answer.places, truth, &self.session.world)
            .map_err(BackcastError::Refused)
    }

    /// The votes at the heading of the best place.
    fn field(&self, scan: &TakenScan, subject: &Subject) -> Result<Field, BackcastError> {
        let Some(best) = subject.shown.first() else {
            return Err(BackcastError::NoPlace {
                file: self.bag.to_owned(),
                number: subject.number,
                says: subject.places.sentence(),
            });
        };
        let engine = &self.config.options.engine;
        let world = World::prepare(&self.map, engine, Prior::Heading);
        let heading = best.place.map_from_laser.yaw;
        world
            .and_then(|world| world.field_at(&scan.borrowed(), heading))
            .map_err(BackcastError::Refused)
    }

    fn draw_errors(&mut self) -> Result<Scene, BackcastError> {
        if let Some(damage) = damage_of(self.recording) {
            return Err(damage.into());
        }
        if self.truths.is_empty() {
            let file = self.bag.to_owned();
            return Err(BackcastError::NoTruths { file });
        }
        let progress = Progress::new("locating", self.session.scans.total());
        let (mut judged, mut scans) = (Vec::new(), 0);
        while let Some(scan) = self.session.scans.next() {
            let scan = scan?;
            scans += 1;
            if let Some(truth) = self.truths.get(&scan.stamp_ns) {
                judged.push(self.judge(&scan, truth)?);
            }
            progress.step();
        }
        if judged.is_empty() {
            return Err(BackcastError::NoTruthTaken {
                file: self.bag.to_owned(),
                scans,
                truths: self.truths.len(),
            });
        }
        errors::draw(&judged, &self.name(), self.config.width)
    }

    fn judge(&self, scan: &TakenScan, truth: &GroundTruth) -> Result<Judged, BackcastError> {
        let places = self.session.ask(scan)?.answer.ok();
        let places = places.map(|answer| answer.places);
        let best = places.as_ref().and_then(|places| places.places.first());
        let off = best.map(|best| {
            let best = best.map_from_laser;
            (
                best.distance_to(truth.pose),
                best.angle_to(truth.pose).to_degrees(),
            )
        });
        Ok(Judged {
            stamp_ns: scan.stamp_ns,
            verdict: places.map_or(Verdict::NoScan, |places| places.verdict),
            off,
        })
    }

    fn draw_sheet(&mut self) -> Result<Scene, BackcastError> {
        let total = self.session.scans.total();
        let wanted = u64::from(self.config.panels.unwrap_or(12)).min(total);
        let progress = Progress::new("locating", wanted);
        let mut panels = Vec::new();
        let mut number = 0;
        while let Some(scan) = self.session.scans.next() {
            number += 1;
            if !is_in_sheet(number, total, wanted) {
                continue;
            }
            let scan = scan?;
            panels.push(match self.subject(number, &scan) {
                Ok(subject) => Panel::Scan(Box::new(subject)),
                Err(refusal @ (BackcastError::Refused(_) | BackcastError::Heading(_))) => {
                    Panel::Refused(number, refusal.to_string())
                }
                Err(error) => return Err(error),
            });
            progress.step();
        }
        let ground = self.config.ground(&self.map);
        sheet::draw(&ground, &panels, &self.name(), self.config.size())
    }
}

/// Whether the scan of a number from 1 is one of `wanted` evenly spread ones,
/// of which the first scan is the first.
fn is_in_sheet(number: u64, total: u64, wanted: u64) -> bool {
    let before = |number: u64| (number * wanted).div_ceil(total.max(1));
    before(number) > before(number.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_of_a_sheet_are_evenly_spread() {
        let taken = |total, wanted| -> Vec<u64> {
            let all = 1..=total;
            all.filter(|&number| is_in_sheet(number, total, wanted))
                .collect()
        };
        assert_eq!(taken(9, 3), [1, 4, 7]);
        assert_eq!(taken(10, 4), [1, 3, 6, 8]);
        assert_eq!(taken(3, 3), [1, 2, 3]);
        assert_eq!(taken(37, 12).len(), 12);
    }
}
