//! Compares regions of constant depth with the σ_θ of Eq. 1 and with neither, on a simulated drive
//! of a ring of sonars; the heading is unknown:
//! ```text
//! cargo run --release -p accumulator --example sonar_regions -- --sonar \
//!     --map recordings/sonar_ring/map.yaml --path "0.8,4.8 2.2,4.8 2.2,2.7 5.4,2.7"
//! ```

use std::error::Error;
use std::path::PathBuf;

use accumulator::sonar::regions::{self, Echo, RegionConfig};
use bench::distinct;
use clap::Parser;
use engine::EngineError;
use engine::Map;
use engine::program::VoteConfig;
use engine::scan::Scan;
use engine::vote_search::{Preparation, Prior, VoteSearch, VoteSearchConfig, Workspace};
use geometry::Pose;
use map::OccupancyGrid;
use simulation::{Bearings, Drive, DriveConfig, Path};

/// Error in metres and radians up to which a pose is right.
const RIGHT: (f64, f64) = (0.5, 10.0 * std::f64::consts::PI / 180.0);

/// Number of best places that count for the second share.
const PLACES: usize = 5;

/// Compares interpretations of the echoes of a ring of sonars.
#[derive(Debug, Parser)]
struct Options {
    /// The map, a YAML file
    #[arg(long)]
    map: PathBuf,
    /// Corners of the drive: "X,Y X,Y …"
    #[arg(long)]
    path: Path,
    /// Window lengths by odometry, in metres; the scans of a window are joined
    #[arg(long, value_delimiter = ',', default_value = "0,1,2,3")]
    ways: Vec<f64>,
    /// Standard deviation of a reading for the votes, metres
    #[arg(long, default_value_t = 0.1)]
    sigma: f64,
    #[command(flatten)]
    drive: DriveConfig,
}

/// Makes the ranges of a scan from echoes of cones of this half width, radians.
type Reading = fn(&[Echo], f64) -> Vec<f32>;

const READINGS: [(&str, Reading); 3] = [
    ("axes", on_axes),
    ("cones", regions::spread),
    ("regions", at_regions),
];

/// Each echo on the axis of its transducer: the paper without σ_θ.
fn on_axes(echoes: &[Echo], _: f64) -> Vec<f32> {
    regions::spread(echoes, 0.0)
}

fn at_regions(echoes: &[Echo], half_width: f64) -> Vec<f32> {
    let config = RegionConfig {
        half_width,
        ..RegionConfig::default()
    };
    regions::at_regions(echoes, &regions::regions(echoes, &config))
}

struct Taken {
    /// Distance travelled by odometry, in metres.
    way_m: f64,
    odom_from_laser: Pose,
    map_from_laser: Pose,
    ranges: Vec<f32>,
}

struct Ring {
    bearings: Bearings,
    range_max_m: f32,
    half_width: f64,
}

impl Ring {
    fn echoes(&self, window: &[Taken]) -> Result<Vec<Echo>, EngineError> {
        let mut echoes = Vec::new();
        let Some(last) = window.last() else {
            return Ok(echoes);
        };
        for taken in window {
            let scan = Scan {
                angle_min: self.bearings.get(0),
                angle_increment: f64::from(self.bearings.angle_increment),
                range_min_m: 0.0,
                range_max_m: self.range_max_m,
                ranges: &taken.ranges,
            };
            let last_from_taken = last.odom_from_laser.inverse().then(taken.odom_from_laser);
            echoes.extend(Echo::of(&scan, last_from_taken)?);
        }
        Ok(echoes)
    }
}

#[derive(Debug, Default)]
struct Tally {
    scans: usize,
    echoes: usize,
    beams: u32,
    right: usize,
    among: usize,
}

impl Tally {
    fn print(&self, way_m: f64, reading: &str) {
        let scans = self.scans.max(1) as f64;
        let percent = |count: usize| 100.0 * count as f64 / scans;
        println!(
            "{way_m:>5.1}  {:>6.1}  {reading:<8}  {:>5.1}  {:>7.0}  {:>9.0}  {:>5}",
            self.echoes as f64 / scans,
            f64::from(self.beams) / scans,
            percent(self.right),
            percent(self.among),
            self.scans,
        );
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    if !options.drive.sonar.sonar {
        return Err("regions are those of a ring of sonars: --sonar is needed".into());
    }
    let map = map::load(&options.map)?;
    let drive = Drive::new(&map, &options.path, &options.drive)?;
    let ring = Ring {
        bearings: drive.bearings(),
        range_max_m: options.drive.range_max_m() as f32,
        half_width: options.drive.sonar.beam_width.to_radians() / 2.0,
    };
    let drive = taken(drive, options.drive.mount.base_from_laser);
    let vote_search = vote_search(&map, options.sigma)?;
    println!("way_m  echoes  read_as   beams  right_%  in_five_%  scans");
    for &way_m in &options.ways {
        for (name, reading) in READINGS {
            tally(&vote_search, &ring, (&drive, way_m), reading)?.print(way_m, name);
        }
    }
    Ok(())
}

fn taken(drive: Drive, base_from_laser: Pose) -> Vec<Taken> {
    let mut way_m = 0.0;
    let mut before: Option<Pose> = None;
    let scans = drive.map(|snapshot| {
        let after = snapshot.wheels.odom_from_base;
        way_m += before.map_or(0.0, |before| before.distance_to(after));
        before = Some(after);
        Taken {
            way_m,
            odom_from_laser: after.then(base_from_laser),
            map_from_laser: snapshot.map_from_laser,
            ranges: snapshot.ranges,
        }
    });
    scans.collect()
}

/// Prepares a localizer with the paper's votes: all beams have the same weight.
fn vote_search(map: &OccupancyGrid, sigma_m: f64) -> Result<VoteSearch, EngineError> {
    let mut votes = VoteConfig {
        sigma_m,
        ..VoteConfig::default()
    };
    votes.beams.max_beams = regions::BEARINGS as u32;
    votes.beams.beam_arc_m = 0.0;
    let config = VoteSearchConfig {
        votes,
        ..VoteSearchConfig::default()
    };
    let sides = (map.width as usize, map.height as usize);
    let map = Map::new(map.resolution_m, map.map_from_grid, sides, &map.cells);
    Preparation::of_map(map, config, Prior::None)?.finish()
}

/// Searches at each scan that ends a full window of `way_m` metres.
fn tally(
    vote_search: &VoteSearch,
    ring: &Ring,
    (drive, way_m): (&[Taken], f64),
    reading: Reading,
) -> Result<Tally, EngineError> {
    let (mut tally, mut workspace) = (Tally::default(), Workspace::default());
    for (i, last) in drive.iter().enumerate() {
        // Skips scans before the first full window.
        if last.way_m < way_m {
            continue;
        }
        let first = drive[..i].partition_point(|taken| taken.way_m < last.way_m - way_m);
        let first = if way_m > 0.0 { first } else { i };
        let echoes = ring.echoes(&drive[first..=i])?;
        let ranges = reading(&echoes, ring.half_width);
        let scan = regions::scan_of(&ranges);
        let outcome = vote_search.search_in(&mut workspace, &scan, None, &|| false)?;
        let outcome = outcome.expect("a search that nothing stops ends with an outcome");
        let places = distinct(outcome, vote_search.frame(), PLACES).into_iter();
        let is_right: Vec<bool> = places
            .map(|pose| pose.is_within(last.map_from_laser, RIGHT.0, RIGHT.1))
            .collect();
        tally.scans += 1;
        tally.echoes += echoes.len();
        tally.beams += outcome.beams_used;
        tally.right += usize::from(is_right.first() == Some(&true));
        tally.among += usize::from(is_right.contains(&true));
    }
    Ok(tally)
}
