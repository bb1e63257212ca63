//! Options of `backcast plot`, and which of them belong to which picture.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use command_line::wrong_use;
use map::OccupancyGrid;
use offline::Options;

use super::ground::Ground;
use super::scan::Size;

pub const NOTES: &str = "\
Ends of beams: a green dot is at an obstacle, an orange triangle before one, a red cross behind
one, a violet diamond behind unknown space. Places that fit about as well are fainter, and shown
from near below the map or beside it. Text is 7 points or more on two columns of a journal (180
mm); for one column, --width 600 has 6 points.

Exit codes: 0 drawn, 1 failed, 2 wrong use";

/// What a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Kind {
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
    /// All scans at their places, one after the other: an animated PNG
    Drive,
}

/// Options of `backcast plot`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// What the picture shows
    #[arg(value_enum, default_value_t = Kind::Scan, value_name = "KIND")]
    pub(super) kind: Kind,

    /// The recording: an MCAP file, or a bag of rosbag2 (its folder, or .db3);
    /// several files are read as one
    #[arg(long, value_name = "FILE")]
    pub(super) bag: Vec<PathBuf>,

    /// The picture: a file whose name ends with .png or .svg
    #[arg(long, value_name = "FILE")]
    pub(super) out: PathBuf,

    /// Overwrite the file
    #[arg(long)]
    pub(super) force: bool,

    /// The scan: the N-th of those taken, as `locate` prints it in its N-th
    /// line [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) scan: Option<u64>,

    /// Leave out /ground_truth, which may be of another map than --map
    #[arg(long)]
    pub(super) no_truth: bool,

    /// Width of the picture, pixels, 200..=8000; its height follows
    #[arg(long, value_name = "PIXELS", default_value_t = 1200, value_parser = clap::value_parser!(u32).range(200..=8000))]
    pub(super) width: u32,

    /// Show the whole map, not only the places and what the scan reaches
    #[arg(long)]
    pub(super) whole: bool,

    #[command(flatten)]
    pub(super) options: Options,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Png,
    Svg,
}

impl Config {
    /// Whether the file is the image of --map.
    fn is_map(&self, file: &Path) -> bool {
        let yaml = self.options.map.first();
        let image = yaml.and_then(|yaml| map::image_of(yaml).ok());
        let whole = |path: &Path| path.canonicalize().ok();
        image.is_some_and(|image| whole(&image).is_some() && whole(&image) == whole(file))
    }

    /// Checks what no option can check alone; opens nothing.
    pub(super) fn check(&self) -> anyhow::Result<Format> {
        self.options.check()?;
        let usage = |text: String| Err(wrong_use(text));
        if self.bag.is_empty() && (self.kind != Kind::Map || self.options.map.is_empty()) {
            return usage(
                "--bag is missing: only the picture `map` does without, and then needs --map"
                    .into(),
            );
        }
        let is_of_scan = matches!(self.kind, Kind::Scan | Kind::Field | Kind::Surface);
        if self.scan.is_some() && !is_of_scan {
            return usage("--scan is for the pictures `scan`, `field` and `surface`".into());
        }
        if self.no_truth && matches!(self.kind, Kind::Map | Kind::Errors) {
            return usage("--no-truth is for the pictures of scans".into());
        }
        if self.whole && matches!(self.kind, Kind::Map | Kind::Errors) {
            return usage("--whole is for the pictures of scans".into());
        }
        if self.is_map(&self.out) {
            return usage(format!(
                "--out {} is the map itself; a picture needs a name of its own",
                self.out.display()
            ));
        }
        let format = self.format()?;
        if self.kind == Kind::Drive && format == Format::Svg {
            return usage(format!(
                "--out {}: the picture `drive` moves, and the name must end with .png",
                self.out.display()
            ));
        }
        Ok(format)
    }

    fn format(&self) -> anyhow::Result<Format> {
        let extension = self.out.extension().and_then(|name| name.to_str());
        match extension.map(str::to_ascii_lowercase).as_deref() {
            Some("png") => Ok(Format::Png),
            Some("svg") => Ok(Format::Svg),
            _ => Err(wrong_use(format!(
                "--out {}: the name must end with .png or .svg",
                self.out.display()
            ))),
        }
    }

    pub(super) fn size(&self) -> Size {
        Size {
            width: self.width,
            whole: self.whole,
        }
    }

    pub(super) fn ground<'a>(&self, map: &'a OccupancyGrid) -> Ground<'a> {
        Ground {
            map,
            rules: self.options.engine.cells,
        }
    }
}
