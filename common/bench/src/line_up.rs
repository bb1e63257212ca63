//! Who takes part in a table, prepared for one place.

use crate::baselines::{
    Baseline, FieldCorrelation, MonteCarlo, MonteCarloConfig, PatchCorrelation, PlainCorrelation,
    RangeTable, RayCasting,
};
use crate::timing::cpu_ms;
use crate::worlds::World;
use engine::search::SearchIndex;
use engine::space::Space;
use engine::sweep::FieldSweep;

use super::engine_methods as reverse;
use super::measure::{Answer, Locate, Pose, Task};
use super::method::Method;
use super::scope::{Place, Table};

/// Range tables are left out where they would take more, bytes.
const MAX_TABLE_BYTES: usize = 4 << 30;

/// A place, prepared for every method of a table.
pub(super) struct LineUp {
    table: Table,
    pub(super) world: World,
    pub(super) space: Space,
    ray_stepping: Option<Prepared<RayCasting>>,
    ray_casting: Option<Prepared<RayCasting>>,
    range_table: Option<Prepared<RangeTable>>,
    patch: Option<Prepared<PatchCorrelation>>,
    sweeps: Prepared<FieldSweep>,
    index: Option<Prepared<SearchIndex>>,
}

/// A method that takes part in a case.
pub(super) struct Contestant<'a> {
    pub(super) method: Method,
    pub(super) locate: Locate<'a>,
    pub(super) prepare_cpu_ms: f64,
    pub(super) map_bytes: usize,
}

/// Something that was prepared, and what that cost.
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
    /// Generates the place and prepares it.
    ///
    /// # Errors
    /// If there is no such place.
    pub(super) fn new(table: Table, place: Place, seed: u64) -> anyhow::Result<Self> {
        let side = place.size as usize;
        let world = World::generate(place.kind, (side, side), place.p_over_n / 100.0, seed)?;
        let space = world.space(place.headings)?;
        let with_baselines = table != Table::Search;
        let has_table = with_baselines && table_bytes(&world, &space) <= MAX_TABLE_BYTES;
        let all = 0..space.directions.count();
        Ok(LineUp {
            table,
            ray_stepping: with_baselines
                .then(|| Prepared::new(|| RayCasting::new(&world, &space).with_single_steps())),
            ray_casting: with_baselines.then(|| Prepared::new(|| RayCasting::new(&world, &space))),
            range_table: has_table.then(|| Prepared::new(|| RangeTable::new(&world, &space, all))),
            patch: with_baselines.then(|| Prepared::new(|| PatchCorrelation::new(&world, &space))),
            sweeps: Prepared::new(|| FieldSweep::new(&world.grid)),
            index: (table != Table::Table1)
                .then(|| Prepared::new(|| SearchIndex::new(&world.grid, &space))),
            world,
            space,
        })
    }

    /// Bytes that a range table would take, if it was left out for that.
    pub(super) fn left_out_table_bytes(&self) -> Option<usize> {
        let is_left_out = self.ray_casting.is_some() && self.range_table.is_none();
        is_left_out.then(|| table_bytes(&self.world, &self.space))
    }

    /// Who takes part, in the order of the table.
    pub(super) fn contestants(&mut self, sigma_cells: f64, patience_s: f64) -> Vec<Contestant<'_>> {
        let (world, space, table) = (&self.world, &self.space, self.table);
        let mut all = Vec::new();
        if let Some(it) = &mut self.ray_stepping {
            all.push(baseline(Method::RayStepping, it.cpu_ms, &mut it.value));
        }
        if let Some(it) = &mut self.ray_casting {
            all.push(baseline(Method::RayCasting, it.cpu_ms, &mut it.value));
        }
        if let Some(it) = &mut self.range_table {
            all.push(baseline(Method::RangeTable, it.cpu_ms, &mut it.value));
        }
        if let Some(it) = &mut self.patch {
            let plain = Prepared::new(|| PlainCorrelation::new(world, space));
            all.push(baseline(Method::PlainPatch, plain.cpu_ms, plain.value));
            all.push(baseline(Method::Patch, it.cpu_ms, &mut it.value));
            let field = Prepared::new(|| FieldCorrelation::new(world, space, sigma_cells));
            all.push(baseline(Method::Field, field.cpu_ms, field.value));
            let config = MonteCarloConfig::default();
            let particles = Prepared::new(|| MonteCarlo::new(world, space, sigma_cells, config));
            all.push(baseline(
                Method::MonteCarlo,
                particles.cpu_ms,
                particles.value,
            ));
            all.push(Contestant {
                method: Method::Scatter,
                locate: reverse::scatter(world),
                prepare_cpu_ms: 0.0,
                map_bytes: size_of_val(&world.boundary[..]) + world.grid.cells().len(),
            });
        }
        all.push(Contestant {
            method: match table {
                Table::Table1 => Method::Sweep,
                _ => Method::Exhaustive,
            },
            locate: reverse::sweep(world, &self.sweeps.value),
            prepare_cpu_ms: self.sweeps.cpu_ms,
            // Two masks of two bytes, along each axis.
            map_bytes: self.sweeps.value.bytes(),
        });
        if let Some(index) = &self.index {
            let mut add = |method, locate| {
                all.push(Contestant {
                    method,
                    locate,
                    prepare_cpu_ms: index.cpu_ms,
                    map_bytes: index.value.bytes(),
                });
            };
            add(Method::Search, reverse::search(world, &index.value));
            if table == Table::Search {
                add(
                    Method::TopSixteen,
                    reverse::top_sixteen(world, &self.sweeps.value, patience_s),
                );
                add(Method::Candidates, reverse::candidates(world, &index.value));
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
    let map_bytes = baseline.bytes();
    let locate = move |task: &Task<'_>, headings: &[usize]| {
        let found = baseline.locate(&task.readings, headings);
        Ok(Answer::Best(found.map(|found| Pose {
            x: found.x,
            y: found.y,
            heading: found.heading,
        })))
    };
    Contestant {
        method,
        locate: Box::new(locate),
        prepare_cpu_ms,
        map_bytes,
    }
}
