//! Benchmarks of each kernel, on a building of 400 × 400 cells with p/n 10 %, 180 beams and noise 5
//! %:
//!
//! ```text
//! cargo bench -p bench
//! cargo bench -p bench -- field
//! ```

use std::hint::black_box;

use bench::baselines::{
    Baseline, FieldCorrelation, MonteCarlo, MonteCarloConfig, PatchCorrelation, RangeTable,
    RayCasting, Readings,
};
use bench::scans::{ScanConfig, SimulatedScan, simulate};
use bench::scatter::Scatter;
use bench::worlds::{Kind, World};
use criterion::Criterion;
use engine::accumulator::{Accumulator, Query};
use engine::boundary;
use engine::program::{ScanProgram, VoteConfig};
use engine::search::SearchIndex;
use engine::space::Space;
use engine::sweep::FieldSweep;
use engine::taper::TaperShape;
use engine::votes::CollectConfig;

/// One scan of one world, prepared for every method.
struct Case {
    world: World,
    space: Space,
    scan: SimulatedScan,
    votes: VoteConfig,
    program: ScanProgram,
    readings: Readings,
}

impl Case {
    fn new() -> anyhow::Result<Self> {
        let config = ScanConfig {
            beams: 180,
            noise_percent: 5.0,
        };
        let world = World::generate(Kind::Rooms, (400, 400), 0.10, 1)?;
        let space = world.space(360)?;
        let scan = simulate(&world, &space, &config, 1, 1)?.swap_remove(0);
        let votes = config.votes(TaperShape::Trapezoid);
        Ok(Case {
            program: ScanProgram::new(&scan.scan(), 0.0, &space, &votes)?,
            readings: Readings::new(&scan.scan(), &space, &votes)?,
            world,
            space,
            scan,
            votes,
        })
    }
}

fn main() -> anyhow::Result<()> {
    let case = Case::new()?;
    let mut criterion = Criterion::default().configure_from_args();
    prepare(&mut criterion, &case);
    fields(&mut criterion, &case);
    searches(&mut criterion, &case);
    baselines(&mut criterion, &case);
    criterion.final_summary();
    Ok(())
}

/// Work per map, and per scan.
fn prepare(criterion: &mut Criterion, case: &Case) {
    let Case { world, space, .. } = case;
    let mut group = criterion.benchmark_group("prepare");
    group.sample_size(10);
    group.bench_function("boundary", |b| b.iter(|| boundary::extract(&world.grid)));
    group.bench_function("sweep", |b| b.iter(|| FieldSweep::new(&world.grid)));
    group.bench_function("search", |b| {
        b.iter(|| SearchIndex::new(&world.grid, space));
    });
    group.bench_function("program", |b| {
        b.iter(|| ScanProgram::new(&case.scan.scan(), 0.0, space, &case.votes));
    });
    group.finish();
}

/// Intensities of all cells at one heading.
fn fields(criterion: &mut Criterion, case: &Case) {
    let Case {
        world,
        space,
        program,
        ..
    } = case;
    let query = Query {
        program,
        space,
        heading: case.scan.heading,
    };
    let sweeps = FieldSweep::new(&world.grid);
    let mut group = criterion.benchmark_group("field");
    group.sample_size(20);
    group.bench_function("sweep", |b| {
        let (mut sweep, mut field) = (sweeps.accumulator(), Vec::new());
        b.iter(|| sweep.fill(query, &mut field, &|| false));
    });
    group.bench_function("scatter", |b| {
        let (mut scatter, mut field) = (Scatter::new(&world.grid, &world.boundary), Vec::new());
        b.iter(|| scatter.fill(query, &mut field, &|| false));
    });
    group.finish();
}

/// Search for the best poses over all headings.
fn searches(criterion: &mut Criterion, case: &Case) {
    let Case {
        world,
        space,
        program,
        ..
    } = case;
    let index = SearchIndex::new(&world.grid, space);
    let mut group = criterion.benchmark_group("search");
    group.sample_size(20);
    for (name, floor_share) in [("argmax", 1.0), ("candidates", 0.85)] {
        let collect = CollectConfig {
            floor_share,
            candidates: 0,
            ..CollectConfig::default()
        };
        group.bench_function(name, |b| {
            b.iter(|| index.search(&world.grid, program, space, collect, &|| false));
        });
    }
    group.finish();
}

/// Baselines at a known heading.
fn baselines(criterion: &mut Criterion, case: &Case) {
    let Case {
        world,
        space,
        readings,
        scan,
        ..
    } = case;
    let sigma_cells = readings.median_sigma_cells();
    let config = MonteCarloConfig::default();
    let all = 0..space.directions.count();
    let mut group = criterion.benchmark_group("baseline");
    group.sample_size(10);
    let mut bench = |name, mut baseline: Box<dyn Baseline>| {
        let headings = [scan.heading];
        group.bench_function(name, |b| {
            b.iter(|| baseline.locate(black_box(readings), &headings));
        });
    };
    bench("ray casting", Box::new(RayCasting::new(world, space)));
    bench("range table", Box::new(RangeTable::new(world, space, all)));
    bench("patch", Box::new(PatchCorrelation::new(world, space)));
    bench(
        "likelihood field",
        Box::new(FieldCorrelation::new(world, space, sigma_cells)),
    );
    bench(
        "Monte Carlo",
        Box::new(MonteCarlo::new(world, space, sigma_cells, config)),
    );
    group.finish();
}
