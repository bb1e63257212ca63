//! The command `backcast bench`: sets up the cases of a table, measures, prints.

use std::process::ExitCode;

use command_line::wrong_use;
use engine::instruction_set::InstructionSet;
use offline::Progress;

use super::contest::{self, Effort};
use super::docs;
use super::line_up::LineUp;
use super::paper;
use super::row::Row;
use super::scope::{Cases, Filter, Place, Table, cases, name_of};
use super::text;

pub const NOTES: &str = "\
Worlds are generated: buildings, corridors or scattered boxes with the wanted p/n, boundary
cells over free cells. Noise q % adds a normal error of q/100 of the range to each reading,
and the votes expect the same. The full tables take an hour or so: --quick takes a minute,
and the options above pick single cases. The table `paper` is not printed but written
into a folder; in full it takes below an hour, with --quick two minutes. The table `docs`
runs `backcast evaluate` and `locate` on the recordings and writes what they say into README.md
and docs: half a minute, and with --data some minutes.

Exit codes: 0 measured, 1 failed, or with --check a figure differs, 2 wrong use";

const SEED: u64 = 1;

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Measured {
    /// The paper's Table 1: the heading is known
    Table1,
    /// The paper's Table 2: the heading is searched too
    Table2,
    /// The exact search over all headings, on worlds of every kind and size
    Search,
    /// All claims of the paper's sections II to V, into a folder of tables and pictures
    Paper,
    /// The figures in README.md and docs, into these pages
    Docs,
}

/// Options of `backcast bench`.
#[derive(Debug, clap::Args)]
pub struct Config {
    /// What is measured
    #[arg(value_enum, value_name = "TABLE")]
    table: Measured,

    /// Print JSON, an object for each method and case
    #[arg(long)]
    json: bool,

    /// Measure fewer cases, less often: about a minute
    #[arg(long)]
    quick: bool,

    /// Seed of the random worlds and scans
    #[arg(long, value_name = "NUMBER", default_value_t = SEED)]
    seed: u64,

    /// Maximum number of scans per case, 1..=1000; methods that take long are measured
    /// on fewer [default: 10, or 5 with --quick]
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=1000))]
    scans: Option<u32>,

    #[command(flatten)]
    filter: Filter,

    #[command(flatten)]
    paper: paper::Config,

    #[command(flatten)]
    docs: docs::Config,
}

impl Config {
    /// Checks that no options of another table are given.
    fn check_table(&self) -> anyhow::Result<()> {
        let has_docs = self.docs != docs::Config::default();
        let has_paper = self.paper != paper::Config::default();
        let has_cases = self.json || self.scans.is_some() || self.filter != Filter::default();
        let has_effort = self.quick || self.seed != SEED;
        let message = match self.table {
            Measured::Docs if has_cases || has_effort || has_paper => {
                "`bench docs` takes --root, --data, --check, --constants, --stress and --times"
                    .to_owned()
            }
            Measured::Paper if has_cases || has_docs => {
                "`bench paper` takes --quick, --seed, --out, --part and --recording".to_owned()
            }
            Measured::Paper | Measured::Docs => return Ok(()),
            table if has_docs => format!(
                "--root, --data, --check, --constants, --stress and --times are for `bench docs`, not for {}",
                name_of(&table)
            ),
            table if has_paper => format!(
                "--out, --part and --recording are for `bench paper`, not for {}",
                name_of(&table)
            ),
            _ => return Ok(()),
        };
        Err(wrong_use(message))
    }

    fn effort(&self) -> Effort {
        let (scans, budget_ms, patience_s) = match self.quick {
            true => (5, 300.0, 2.0),
            false => (10, 2000.0, 60.0),
        };
        Effort {
            scans: self.scans.map_or(scans, |scans| scans as usize),
            budget_ms,
            patience_s,
            seed: self.seed,
        }
    }

    fn check(&self, cases: &Cases) -> anyhow::Result<()> {
        for (place, sights) in cases {
            for sight in sights {
                if !place.headings.is_multiple_of(sight.beams) {
                    return Err(wrong_use(format!(
                        "{} beams do not fall on a grid of {} headings: use --beams and --headings \
                         of which the second is a multiple of the first",
                        sight.beams, place.headings
                    )));
                }
            }
        }
        Ok(())
    }
}

pub fn run(config: &Config) -> anyhow::Result<ExitCode> {
    config.check_table()?;
    match config.table {
        Measured::Table1 => run_table(config, Table::Table1),
        Measured::Table2 => run_table(config, Table::Table2),
        Measured::Search => run_table(config, Table::Search),
        Measured::Paper => paper::run(&config.paper, config.quick, config.seed),
        Measured::Docs => docs::run(&config.docs),
    }
}

/// Measures case by case, and prints each as soon as it is done.
fn run_table(config: &Config, table: Table) -> anyhow::Result<ExitCode> {
    let cases = cases(table, config.quick, &config.filter);
    config.check(&cases)?;
    let sights: usize = cases.iter().map(|(_, sights)| sights.len()).sum();
    let measurements = sights * contest::rows(table);
    let progress = Progress::counting("measuring", "measurements", measurements as u64);
    if !config.json {
        let instructions = InstructionSet::best().to_string();
        progress.write(&text::title(table, &instructions))?;
    }
    for (place, sights) in cases {
        progress.show(format!("{} is prepared", name(&place)));
        let mut line_up = LineUp::new(table, place, config.seed)?;
        for sight in sights {
            progress.show(format!("{}, {} beams", name(&place), sight.beams));
            let rows = line_up.run(&sight, config.effort(), || progress.step())?;
            progress.write(&printed(&rows, config.json))?;
        }
    }
    if !config.json {
        progress.write(text::LEGEND)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn name(place: &Place) -> String {
    let (kind, size) = (name_of(&place.kind), place.size);
    format!("{kind} {size} x {size}, p/n {} %", place.p_over_n)
}

fn printed(rows: &[Row], as_json: bool) -> String {
    if as_json {
        rows.iter()
            .map(|row| command_line::json::object(row) + "\n")
            .collect()
    } else {
        text::block(rows)
    }
}
