//! The command `backcast bench paper`: measures part by part, and writes tables and pictures.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::ValueEnum;
use offline::Progress;

use super::super::contest::Effort;
use super::super::scope::{Table, name_of};
use super::folder::Folder;
use super::{aid, corridor, counts, method, sonar, tables};

/// A part of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(in super::super) enum Part {
    /// Figures 1 to 3: the method step by step
    Method,
    /// Sections II B and III: operations against the formulas
    Counts,
    /// Section IV: eight sonars
    Sonar,
    /// The paper's Table 1: the heading is known
    Table1,
    /// The paper's Table 2: the heading is searched too
    Table2,
    /// Section V: three places in a corridor
    Corridor,
    /// Sections I and VI: the votes as an aid to Markov localization and particles
    Aid,
}

/// Options of `backcast bench paper`, in addition to those of every table.
// Its group would have the same name as that of the other options.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
#[group(skip)]
#[command(next_help_heading = "Table paper")]
pub(in super::super) struct Config {
    /// Folder for tables and pictures [default: bench-paper]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,

    /// Parts of the paper, separated by commas [default: all]
    #[arg(long, value_enum, value_delimiter = ',', value_name = "PART")]
    part: Vec<Part>,

    /// The recording of section V [default: that of the Málaga corridor, in
    /// recordings/]
    #[arg(long, value_name = "FILE")]
    recording: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy)]
struct Scope {
    is_quick: bool,
    seed: u64,
}

pub(in super::super) fn run(
    config: &Config,
    is_quick: bool,
    seed: u64,
) -> anyhow::Result<ExitCode> {
    let out = config.out.clone().unwrap_or_else(|| "bench-paper".into());
    let folder = Folder::open(&out)?;
    let parts = match &config.part[..] {
        [] => Part::value_variants(),
        asked => asked,
    };
    let scope = Scope { is_quick, seed };
    let progress = Progress::counting("measuring", "parts", parts.len() as u64);
    for part in Part::value_variants()
        .iter()
        .filter(|part| parts.contains(part))
    {
        let say = |what: String| progress.show(what);
        match part {
            Part::Method => method_part(&folder)?,
            Part::Counts => counts_part(&folder, scope)?,
            Part::Sonar => sonar_part(&folder, scope, say)?,
            Part::Table1 => table_part(&folder, Table::Table1, scope, say)?,
            Part::Table2 => table_part(&folder, Table::Table2, scope, say)?,
            Part::Corridor => corridor_part(&folder, config)?,
            Part::Aid => aid_part(&folder, scope, say)?,
        }
        progress.step();
    }
    progress.write(&format!("{}: written\n", out.display()))?;
    Ok(ExitCode::SUCCESS)
}

fn method_part(folder: &Folder) -> anyhow::Result<()> {
    folder.picture("figure1.png", &method::draw_figure_1()?)?;
    folder.picture("figure2.png", &method::draw_figure_2()?)?;
    folder.picture("figure3.png", &method::draw_figure_3()?)
}

fn counts_part(folder: &Folder, scope: Scope) -> anyhow::Result<()> {
    let (side, scans) = if scope.is_quick { (150, 5) } else { (400, 10) };
    let counted = counts::count(side, scans, scope.seed)?;
    folder.table("counts.csv", &counts::csv(&counted))?;
    folder.picture("counts.png", &counts::draw(&counted)?)
}

fn sonar_part(folder: &Folder, scope: Scope, say: impl Fn(String)) -> anyhow::Result<()> {
    let mut done = 0;
    let poses = if scope.is_quick { 200 } else { 1000 };
    let judged = sonar::judge(poses, scope.seed, || {
        done += 1;
        say(format!("eight sonars, {done} cases done"));
    })?;
    folder.table("sonar.csv", &sonar::csv(&judged))?;
    folder.picture("sonar_errors.png", &sonar::draw_errors(&judged)?)?;
    for place in sonar::PLACES {
        let [flat, surface] = sonar::draw_field(place, scope.seed)?;
        let figure = place.figure;
        folder.picture(&format!("figure{figure}_field.png"), &flat)?;
        folder.picture(&format!("figure{figure}_surface.png"), &surface)?;
    }
    Ok(())
}

fn table_part(
    folder: &Folder,
    table: Table,
    scope: Scope,
    say: impl Fn(String),
) -> anyhow::Result<()> {
    let (size, worlds, budget_ms) = match (table, scope.is_quick) {
        // All scans are measured, for their successes are compared, too.
        (Table::Table1, true) => (200, 6, f64::INFINITY),
        (Table::Table1, false) => (1200, 5, f64::INFINITY),
        // The paper's size in both. Methods that take long are measured at some headings.
        (_, true) => (100, 6, 150.0),
        (_, false) => (100, 10, 1500.0),
    };
    let extent = tables::Extent {
        size,
        worlds,
        effort: Effort {
            scans: if scope.is_quick { 5 } else { 10 },
            budget_ms,
            patience_s: 60.0,
            seed: scope.seed,
        },
    };
    let measured = tables::measure(table, extent, say)?;
    let name = name_of(&table);
    folder.table(&format!("{name}.csv"), &tables::csv(&measured))?;
    let picture = tables::draw(table, extent, &measured)?;
    folder.picture(&format!("{name}.png"), &picture)
}

fn corridor_part(folder: &Folder, config: &Config) -> anyhow::Result<()> {
    let file = config.recording.clone();
    let file = file.unwrap_or_else(|| "recordings/malaga_corridor/recording.mcap".into());
    let corridor = corridor::localize(&file)?;
    folder.table("corridor.csv", &corridor::csv(&corridor))?;
    folder.picture("figure6.png", &corridor::draw_places(&corridor)?)?;
    for (number, place) in (1..).zip(&corridor.places) {
        let picture = corridor::draw_field(&corridor, number, place)?;
        folder.picture(&format!("figure6_place{number}.png"), &picture)?;
    }
    Ok(())
}

fn aid_part(folder: &Folder, scope: Scope, say: impl FnMut(String)) -> anyhow::Result<()> {
    let (size, worlds, scans) = match scope.is_quick {
        true => (80, 3, 4),
        false => (150, 5, 10),
    };
    let extent = aid::Extent {
        size,
        beams: 24,
        worlds,
        scans,
    };
    let saved = aid::measure(extent, scope.seed, say)?;
    folder.table("aid.csv", &aid::csv(&saved))?;
    folder.picture("aid.png", &aid::draw(extent, &saved)?)
}
