//! One case: every method that takes part is measured on the same scans.

use crate::baselines::Readings;
use crate::scans::{ScanConfig, SimulatedScan, simulate};
use crate::timing::median;
use engine::instruction_set::InstructionSet;
use engine::program::ScanProgram;
use engine::space::Space;

use super::line_up::{Contestant, LineUp};
use super::measure::{Task, measure};
use super::method::{Method, Sizes};
use super::row::Row;
use super::scope::{Sight, Table, name_of};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Effort {
    /// Most scans of a case.
    pub(super) scans: usize,
    /// Time for a method in a case, after which no other scan is begun.
    pub(super) budget_ms: f64,
    /// After so long a single search is given up.
    pub(super) patience_s: f64,
    pub(super) seed: u64,
}

/// How many rows each case of a table has.
pub(super) fn rows(table: Table) -> usize {
    match table {
        Table::Table1 => 9,
        Table::Table2 => 10,
        Table::Search => 4,
    }
}

impl LineUp {
    /// Measures every method on the same scans; `step` is called for each.
    pub(super) fn run(
        &mut self,
        sight: &Sight,
        effort: Effort,
        mut step: impl FnMut(),
    ) -> anyhow::Result<Vec<Row>> {
        let config = ScanConfig::new(sight.beams as usize, sight.noise_percent);
        let (world, space) = (&self.world, self.space.clone());
        let scans = simulate(world, &space, &config, effort.scans, effort.seed)?;
        let tasks = tasks(self.table, &scans, &space, sight, &config)?;
        let template = self.template(sight, &tasks)?;
        let sizes = Sizes {
            n: world.grid.free_cells() as f64,
            p: world.boundary.len() as f64,
            m: f64::from(sight.beams),
            k: template.k,
            headings: template.headings as f64,
        };
        let sigmas = tasks.iter().map(|task| task.readings.median_sigma_cells());
        let sigma_cells = median(sigmas.collect());
        let mut rows = Vec::new();
        for mut contestant in self.contestants(sigma_cells, effort.patience_s) {
            let Contestant { method, .. } = contestant;
            let limits = (effort.budget_ms, method.least_headings());
            let counts = method.counts(&sizes);
            let row = Row {
                operations: counts.map(|counts| counts.0),
                additions: counts.map(|counts| counts.1),
                prepare_cpu_ms: contestant.prepare_cpu_ms,
                map_bytes: contestant.map_bytes,
                ..template.of(method)
            };
            let measured = measure(&mut contestant.locate, &tasks, limits, row.clone())?;
            rows.push(measured.unwrap_or_else(|| {
                let seconds = effort.patience_s;
                row.without(format!("not done within {seconds} s and a million poses"))
            }));
            step();
        }
        if let Some(skipped) = self.left_out_table(&template) {
            rows.insert(2, skipped);
            step();
        }
        compare(&mut rows);
        Ok(rows)
    }

    /// What all rows of a case share.
    fn template(&self, sight: &Sight, tasks: &[Task<'_>]) -> anyhow::Result<Row> {
        Ok(Row {
            table: name_of(&self.table),
            kind: name_of(&self.place.kind),
            size: self.place.size,
            beams: sight.beams,
            headings: tasks.first().map_or(0, |task| task.headings.len()),
            p_over_n: self.world.p_over_n(),
            noise_percent: sight.noise_percent,
            taper: name_of(&sight.taper),
            k: taper_cells(tasks)?,
            instruction_set: InstructionSet::best().to_string(),
            ..Row::default()
        })
    }

    /// A row in place of a range table that would take too much memory.
    fn left_out_table(&self, template: &Row) -> Option<Row> {
        let bytes = self.left_out_table_bytes()?;
        let row = Row {
            map_bytes: bytes,
            ..template.of(Method::RangeTable)
        };
        Some(row.without(format!("its table would take {:.1} GB", bytes as f64 / 1e9)))
    }
}

fn tasks<'a>(
    table: Table,
    scans: &'a [SimulatedScan],
    space: &'a Space,
    sight: &Sight,
    config: &ScanConfig,
) -> anyhow::Result<Vec<Task<'a>>> {
    let votes = config.votes(sight.taper);
    let task = |scan: &'a SimulatedScan| {
        Ok(Task {
            scan,
            votes,
            space,
            readings: Readings::new(&scan.scan(), space, &votes)?,
            headings: match table {
                Table::Table1 => vec![scan.heading],
                _ => (0..space.directions.count()).collect(),
            },
        })
    };
    scans.iter().map(task).collect()
}

/// The paper's k: cells that a taper covers along an axis, on average.
fn taper_cells(tasks: &[Task<'_>]) -> anyhow::Result<f64> {
    let (mut cells, mut beams) = (0, 0);
    for task in tasks {
        let program = ScanProgram::new(&task.scan.scan(), 0.0, task.space, &task.votes)?;
        beams += program.beams();
        let width = |beam| 2 * program.taper(beam, 0).profile.len() - 1;
        cells += (0..program.beams()).map(width).sum::<usize>();
    }
    Ok(cells as f64 / beams.max(1) as f64)
}

/// Fills in the ratios to the fastest reverse projection that finds the best pose alone.
fn compare(rows: &mut [Row]) {
    use Method::{Exhaustive, Scatter, Search, Sweep};
    let plain = [Scatter, Sweep, Exhaustive, Search].map(Method::name);
    let times = rows.iter().filter(|row| plain.contains(&row.method));
    let fastest = times.filter_map(|row| row.cpu_ms).min_by(f64::total_cmp);
    for row in rows {
        row.ratio_to_reverse_projection = row.cpu_ms.zip(fastest).map(|(ms, least)| ms / least);
    }
}
