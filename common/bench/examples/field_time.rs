//! Times the field of one heading, with each instruction set, and by the paper's method as written:
//!
//! ```text
//! cargo run --release -p bench --example field_time -- rooms 1200 10 10 --beams 180
//! ```

use bench::scans::{ScanConfig, simulate};
use bench::scatter::Scatter;
use bench::timing::{cpu_ms, median};
use bench::worlds::{Kind, World};
use clap::Parser;
use engine::accumulator::{Accumulator, Query};
use engine::instruction_set::InstructionSet;
use engine::program::ScanProgram;
use engine::sweep::FieldSweep;
use engine::taper::TaperShape;

/// Times the field of one heading.
#[derive(Debug, Parser)]
struct Options {
    kind: Kind,
    /// Cells per side
    side: usize,
    /// Boundary cells per free cell, per cent
    p_over_n: f64,
    /// Standard deviation of a reading, per cent of its range
    noise: f64,
    #[arg(long, default_value_t = 180)]
    beams: usize,
    #[arg(long, default_value_t = 21)]
    runs: usize,
}

fn main() -> anyhow::Result<()> {
    let options = Options::parse();
    let size = (options.side, options.side);
    let world = World::generate(options.kind, size, options.p_over_n / 100.0, 1)?;
    let space = world.space(360)?;
    let simulated = ScanConfig::new(options.beams, options.noise);
    let scan = &simulate(&world, &space, &simulated, 1, 1)?[0];
    let votes = simulated.votes(TaperShape::Trapezoid);
    let program = ScanProgram::new(&scan.scan(), 0.0, &space, &votes)?;
    let query = Query {
        program: &program,
        space: &space,
        heading: scan.heading,
    };
    let sweeps = FieldSweep::new(&world.grid);
    for instruction_set in InstructionSet::available() {
        let mut accumulator = sweeps.accumulator_with(instruction_set);
        let cost = time(&mut accumulator, query, options.runs);
        println!("sweep, {instruction_set}: {cost:.2} ms");
    }
    let cost = time(&mut Scatter::new(&world.grid, &world.boundary), query, 3);
    println!("scatter: {cost:.2} ms");
    Ok(())
}

/// Median CPU time of an accumulator, in milliseconds.
fn time(accumulator: &mut impl Accumulator, query: Query<'_>, runs: usize) -> f64 {
    let mut field = Vec::new();
    let costs = (0..=runs).map(|_| cpu_ms(|| accumulator.fill(query, &mut field, &|| false)).1);
    // The first run allocates the buffers, so it is excluded.
    median(costs.skip(1).collect())
}
