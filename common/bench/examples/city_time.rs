//! Times the preparation of a generated city, loading it from the cache, and searching in it:
//!
//! ```text
//! cargo run --release -p bench --example city_time -- 5000 4000 --index-cache /tmp/city
//! ```
//!
//! Without `--index-cache` no file is written or read.

use std::error::Error;
use std::fs::read_to_string;
use std::time::Instant;

use bench::scans::{ScanConfig, simulate};
use bench::timing::{cpu_ms, median};
use bench::worlds::{World, city};
use clap::Parser;
use engine::Map;
use engine::grid::{CellRules, Grid, GridFrame};
use engine::vote_search::{Preparation, Prior, VoteSearchConfig, Workspace};
use geometry::Pose;
use index_cache::{CachePlace, IndexCacheConfig, Prepared};

/// Times the exact search in a city.
#[derive(Debug, Parser)]
struct Options {
    /// Cells along x, of 5 cm
    width: usize,
    /// Cells along y
    height: usize,
    #[arg(long, default_value_t = 20)]
    scans: usize,
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Maximum range, metres; longer readings count as no return
    #[arg(long, default_value_t = 30.0)]
    reach: f32,
    #[command(flatten)]
    vote_search: VoteSearchConfig,
    #[command(flatten)]
    cache: IndexCacheConfig,
}

const FRAME: GridFrame = GridFrame::new(bench::RESOLUTION_M, Pose::IDENTITY);

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let sides = (options.width, options.height);
    let cells = city(sides, options.seed);
    let cache = options.cache.open(CachePlace::Off)?;
    let prepare = || -> Result<Prepared, Box<dyn Error>> {
        let (start, config) = (Instant::now(), options.vote_search.clone());
        let (prepared, cost) = cpu_ms(|| {
            let map = Map {
                frame: FRAME,
                sides,
                occupancy: &cells,
                rules: CellRules::default(),
            };
            let preparation = Preparation::of_map(map, config, Prior::None)?;
            let cells_ms = start.elapsed().as_secs_f64() * 1e3;
            Prepared::new(cache.as_ref(), preparation).map(|prepared| (prepared, cells_ms))
        });
        let (prepared, cells_ms) = prepared?;
        println!(
            "{} in {:.1} ms, {cost:.1} ms of computing, {cells_ms:.1} ms for the cells",
            if prepared.kept.is_read {
                "read"
            } else {
                "prepared"
            },
            start.elapsed().as_secs_f64() * 1e3,
        );
        Ok(prepared)
    };
    let Prepared { vote_search, kept } = prepare()?;
    println!(
        "{:.1} million cells, {:.1} searchable, index {:.0} MB, peak memory {}",
        cells.len() as f64 / 1e6,
        vote_search.searchable_cells() as f64 / 1e6,
        vote_search.index_bytes() as f64 / 1e6,
        peak_memory()
    );
    if let Some(unsaved) = kept.unsaved {
        let start = Instant::now();
        unsaved.save()?;
        println!("written in {:.1} ms", start.elapsed().as_secs_f64() * 1e3);
    }
    if cache.is_some() {
        (0..5).try_for_each(|_| prepare().map(|_| ()))?;
    }
    let grid = Grid::new(sides.0, sides.1, &cells, CellRules::default())?;
    let world = World {
        grid,
        boundary: Vec::new(),
    };
    let simulated = ScanConfig::new(180, 1.0);
    // Many scans are taken in unknown space; robots are in known space.
    let (space, count) = (vote_search.space(), 20 * options.scans);
    let tried = simulate(&world, space, &simulated, count, options.seed)?;
    let known = tried
        .into_iter()
        .filter(|scan| cells[scan.y * sides.0 + scan.x] == 0);
    let (mut workspace, mut costs, mut hits) = (Workspace::default(), Vec::new(), 0);
    for mut scan in known.take(options.scans) {
        scan.ranges
            .iter_mut()
            .filter(|range| **range > options.reach)
            .for_each(|range| *range = f32::INFINITY);
        let (outcome, cost) = cpu_ms(|| {
            let found = vote_search.search_in(&mut workspace, &scan.scan(), None, &|| false);
            found.map(|outcome| outcome.and_then(|outcome| outcome.found.votes.first().copied()))
        });
        costs.push(cost);
        let is_near = |(a, b): (u16, usize)| usize::from(a).abs_diff(b) <= 10;
        let best = outcome?;
        hits += usize::from(
            best.is_some_and(|best| is_near((best.x, scan.x)) && is_near((best.y, scan.y))),
        );
    }
    let most = costs.iter().copied().fold(0.0, f64::max);
    println!(
        "{} scans, {hits} found, median {:.1} ms of computing, at most {most:.1}; peak memory {}",
        costs.len(),
        median(costs.clone()),
        peak_memory()
    );
    Ok(())
}

fn peak_memory() -> String {
    let status = read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.unwrap_or("unknown").trim().to_owned()
}
