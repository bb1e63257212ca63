//! Who takes part in a table, prepared for one place.

use crate::baselines::{
    Baseline, FieldCorrelation, MonteCarlo, PatchCorrelation, PlainCorrelation, RangeTable,
    RayCasting,
};
use crate::scatter::Scatter;
use crate::timing::cpu_ms;
use crate::worlds::World;
use engine::search::SearchIndex;
use engine::space::Space;
use engine::sweep::FieldSweep;
use engine::votes::CollectConfig;

use super::engine_methods as reverse;
use super::measure::{Answer, Locate, Task};
use super::method::Method;
use super::scope::{Place, Table};

/// Range tables are left out where they would take more, bytes.
const MAX_TABLE_BYTES: usize = 4 << 30;

pub(super) struct LineUp {
    pub(super) table: Table,
    pub(super) place: Place,
    pub(super) world: World,
    pub(super) space: Space,
    /// Those that do not depend on the readings; none in the table of searches.
    baselines: Vec<(Method, Prepared<Box<dyn Baseline>>)>,
    sweeps: Prepared<FieldSweep>,
    index: Option<Prepared<SearchIndex>>,
}

pub(super) struct Contestant<'a> {
    pub(super) method: Method,
    pub(super) locate: Locate<'a>,
    pub(super) prepare_cpu_ms: f64,
    pub(super) map_bytes: usize,
}

struct Prepared<T> {
    value: T,
    cpu_ms: f64,
}

impl<T> Prepared<T> {
    fn new(make: impl FnOnce() -> T) -> Self {
        let (value, cpu_ms) = cpu_ms(make);
        Prepared { value, cpu_ms }
    }
}

impl LineUp {
    pub(super) fn new(table: Table, place: Place, seed: u64) -> anyhow::Result<Self> {
        let side = place.size as usize;
        let world = World::generate(place.kind, (side, side), place.p_over_n / 100.0, seed)?;
        let space = world.space(place.headings)?;
        let mut baselines = Vec::new();
        if table != Table::Search {
            let mut add = |method, make: &dyn Fn() -> Box<dyn Baseline>| {
                baselines.push((method, Prepared::new(make)));
            };
            add(Method::RayStepping, &|| {
                Box::new(RayCasting::new(&world, &space).with_single_steps())
            });
            add(Method::RayCasting, &|| {
                Box::new(RayCasting::new(&world, &space))
            });
            if table_bytes(&world, &space) <= MAX_TABLE_BYTES {
                add(Method::RangeTable, &|| {
                    Box::new(RangeTable::new(&world, &space))
                });
            }
            add(Method::PlainPatch, &|| {
                Box::new(PlainCorrelation::new(&world, &space))
            });
            add(Method::Patch, &|| {
                Box::new(PatchCorrelation::new(&world, &space))
            });
        }
        Ok(LineUp {
            table,
            place,
            baselines,
            sweeps: Prepared::new(|| FieldSweep::new(&world.grid)),
            index: (table != Table::Table1)
                .then(|| Prepared::new(|| SearchIndex::new(&world.grid, &space))),
            world,
            space,
        })
    }

    /// Bytes that a range table would take, if it was left out for that.
    pub(super) fn left_out_table_bytes(&self) -> Option<usize> {
        let bytes = table_bytes(&self.world, &self.space);
        (self.table != Table::Search && bytes > MAX_TABLE_BYTES).then_some(bytes)
    }

    pub(super) fn contestants(&mut self, sigma_cells: f64, patience_s: f64) -> Vec<Contestant<'_>> {
        let (world, space, table) = (&self.world, &self.space, self.table);
        let prepared = self.baselines.iter_mut();
        let mut all: Vec<_> = prepared
            .map(|(method, it)| baseline(*method, it.cpu_ms, &mut *it.value))
            .collect();
        if table != Table::Search {
            let field = Prepared::new(|| FieldCorrelation::new(world, space, sigma_cells));
            all.push(baseline(Method::Field, field.cpu_ms, field.value));
            let particles = Prepared::new(|| MonteCarlo::new(world, space, sigma_cells));
            let cpu_ms = particles.cpu_ms;
            all.push(baseline(Method::MonteCarlo, cpu_ms, particles.value));
        }
        let mut add = |method, locate, prepare_cpu_ms, map_bytes| {
            all.push(Contestant {
                method,
                locate,
                prepare_cpu_ms,
                map_bytes,
            });
        };
        if table != Table::Search {
            let bytes = size_of_val(&world.boundary[..]) + world.grid.cells().len();
            let scatter = Scatter::new(&world.grid, &world.boundary);
            add(Method::Scatter, reverse::fields(world, scatter), 0.0, bytes);
        }
        let method = match table {
            Table::Table1 => Method::Sweep,
            _ => Method::Exhaustive,
        };
        let sweeps = &self.sweeps.value;
        let locate = reverse::fields(world, sweeps.accumulator());
        add(method, locate, self.sweeps.cpu_ms, sweeps.bytes());
        if let Some(prepared) = &self.index {
            let (index, cpu_ms) = (&prepared.value, &prepared.cpu_ms);
            let mut add = |method, locate| add(method, locate, *cpu_ms, index.bytes());
            let search = |collect| reverse::search(world, index, collect);
            add(Method::Search, search(reverse::ARGMAX));
            if table == Table::Search {
                let sixteen = reverse::top_sixteen(world, sweeps, patience_s);
                add(Method::TopSixteen, sixteen);
                // As the graph has them by default.
                add(Method::Candidates, search(CollectConfig::default()));
            }
        }
        all
    }
}

fn table_bytes(world: &World, space: &Space) -> usize {
    2 * world.grid.cells().len() * space.directions.count()
}

fn baseline<'a>(
    method: Method,
    prepare_cpu_ms: f64,
    mut baseline: impl Baseline + 'a,
) -> Contestant<'a> {
    Contestant {
        method,
        prepare_cpu_ms,
        map_bytes: baseline.bytes(),
        locate: Box::new(move |task: &Task<'_>, headings: &[usize]| {
            Ok(Answer::Best(baseline.locate(&task.readings, headings)))
        }),
    }
}
