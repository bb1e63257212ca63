//! Times the exact search over all headings on one generated world:
//!
//! ```text
//! cargo run --release -p bench --example search_time -- rooms 1200 5 2 trapezoid
//! ```

use bench::scans::{ScanConfig, simulate};
use bench::timing::{cpu_ms, median};
use bench::worlds::{Kind, World};
use clap::Parser;
use engine::instruction_set::InstructionSet;
use engine::program::ScanProgram;
use engine::search::{SearchIndex, Workspace};
use engine::taper::TaperShape;
use engine::votes::{CollectConfig, VoteSet};

/// Times the exact search over all headings.
#[derive(Debug, Parser)]
struct Options {
    kind: Kind,
    /// Cells per side
    side: usize,
    /// Boundary cells per free cell, per cent
    p_over_n: f64,
    /// Standard deviation of a reading, per cent of its range
    noise: f64,
    taper: TaperShape,
    #[arg(long, default_value_t = 180)]
    beams: usize,
    #[arg(long, default_value_t = 360)]
    headings: u32,
    #[arg(long, default_value_t = 20)]
    scans: usize,
    /// Share of the best pose's votes down to which poses are collected
    #[arg(long, default_value_t = 1.0)]
    floor_share: f64,
    /// Number of distinct poses to find
    #[arg(long, default_value_t = 0)]
    candidates: u32,
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// Index of the instruction set, from the baseline CPU (0) to the best of this processor
    /// [default: the best]
    #[arg(long)]
    instruction_set: Option<usize>,
    /// Print a line for each scan
    #[arg(long)]
    each: bool,
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let size = (options.side, options.side);
    let world = World::generate(options.kind, size, options.p_over_n / 100.0, options.seed)?;
    let space = world.space(options.headings)?;
    let simulated = ScanConfig::new(options.beams, options.noise);
    let scans = simulate(&world, &space, &simulated, options.scans, options.seed)?;
    let votes = simulated.votes(options.taper);
    let collect = CollectConfig {
        floor_share: options.floor_share,
        candidates: options.candidates,
        ..CollectConfig::default()
    };
    let (index, prepare_ms) = cpu_ms(|| SearchIndex::new(&world.grid, &space));
    println!(
        "p/n {:.2} %, prepared in {prepare_ms:.0} ms, {:.1} MB",
        100.0 * world.p_over_n(),
        index.bytes() as f64 / 1e6
    );
    let available: Vec<_> = InstructionSet::available().collect();
    let wanted = options.instruction_set.unwrap_or(available.len() - 1);
    let instruction_set = available[wanted.min(available.len() - 1)];
    let (mut workspace, mut found) = (Workspace::default(), VoteSet::default());
    let mut costs = Vec::new();
    let (mut share, mut poses, mut hits) = (0.0, 0, 0);
    for scan in &scans {
        let program = ScanProgram::new(&scan.scan(), 0.0, &space, &votes)?;
        let how = (instruction_set, options.threads);
        let run = || {
            let scan = (&program, &space);
            let collect = (collect, &mut found);
            index.search_in(&mut workspace, how, &world.grid, scan, collect, &|| false);
        };
        let ((), cost) = cpu_ms(run);
        let best_share = f64::from(found.best) / f64::from(program.highest_possible());
        let hit = found.votes.first().is_some_and(|vote| {
            let (dx, dy) = (
                vote.x.abs_diff(scan.x as u16),
                vote.y.abs_diff(scan.y as u16),
            );
            dx.max(dy) <= 10
        });
        if options.each {
            println!(
                "{cost:9.2} ms  best {:5.1} %  down to {:5.1} %  poses {:8}  counted {:12}  {}",
                100.0 * best_share,
                100.0 * f64::from(found.certified_floor) / f64::from(program.highest_possible()),
                found.votes.len(),
                found.poses_evaluated,
                if hit { "found" } else { "elsewhere" }
            );
        }
        share += best_share;
        poses += found.poses_evaluated;
        hits += usize::from(hit);
        costs.push(cost);
    }
    let count = costs.len();
    let mean = costs.iter().sum::<f64>() / count as f64;
    let most = costs.iter().copied().fold(0.0, f64::max);
    println!(
        "median {:.2} ms, mean {mean:.2}, max {most:.2}; best/possible {:.1} %, poses a scan {}, found {hits} of {count}",
        median(costs),
        100.0 * share / count as f64,
        poses / count as u64,
    );
    Ok(())
}
