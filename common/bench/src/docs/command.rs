//! The command `backcast bench docs`.

use std::path::PathBuf;
use std::process::ExitCode;

use command_line::{FAILED, stdout};

use super::marks::Place;
use super::pages::Pages;
use super::recordings::Folders;
use super::{constants, measured, stress, tables, times};

/// Options of `backcast bench docs`.
// Its group would have the same name as that of the other options.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
#[group(skip)]
#[command(next_help_heading = "Table docs")]
pub(in super::super) struct Config {
    /// Checkout of Backcast [default: the current folder]
    #[arg(long, value_name = "FOLDER")]
    root: Option<PathBuf>,

    /// Folder with evaluation/, the recordings that are not in the repository: their tables, too
    #[arg(long, value_name = "FOLDER")]
    data: Option<PathBuf>,

    /// Write nothing; exit code 1 if a figure is another one on its page
    #[arg(long)]
    check: bool,

    /// The table of constants, too: some minutes
    #[arg(long, requires = "data")]
    constants: bool,

    /// The tables of drives with something broken, too: a minute, and with --data most of an hour
    #[arg(long)]
    stress: bool,

    /// The times, too, with processor and commit; one recording at a time
    #[arg(long, conflicts_with = "check")]
    times: bool,
}

/// Places of all figures.
fn places() -> Vec<Place> {
    let mut places = tables::places();
    places.extend([
        constants::PLACE,
        stress::CORRIDOR,
        stress::DRIVES,
        stress::PROBABILITIES,
    ]);
    places.extend(times::PLACES);
    places
}

/// Measures, and writes the figures into the pages or compares them.
pub(in super::super) fn run(config: &Config) -> anyhow::Result<ExitCode> {
    let root = config.root.clone().unwrap_or_else(|| ".".into());
    let mut pages = Pages::read(&root, &places())?;
    let folders = Folders::new(&root, config.data.as_deref())?;
    let mut written = measured::measure(&folders)?;
    if config.constants {
        written.push(constants::measure(&folders, &pages)?);
    }
    if config.stress {
        written.extend(stress::measure(&folders)?);
    }
    if config.times {
        written.extend(times::measure(&root, &folders)?);
    }
    let mut has_differences = false;
    for figures in &written {
        for difference in pages.take(figures)? {
            stdout::print(&format!("{difference}\n"))?;
            has_differences = true;
        }
    }
    if config.check {
        return Ok(match has_differences {
            true => ExitCode::from(FAILED),
            false => ExitCode::SUCCESS,
        });
    }
    for page in pages.save()? {
        stdout::print(&format!("{page}: written\n"))?;
    }
    Ok(ExitCode::SUCCESS)
}
