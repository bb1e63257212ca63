//! Reads drives, evaluates them one by one, and prints the figures.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;
use command_line::{names, output, stdout};
use map::OccupancyGrid;
use offline::{Accepted, Options, Session};
use plots::draw_drive;
use progress::{Progress, say};

use super::drive::Moment;
use super::figures::Figures;
use super::run::Said;
use super::{SequenceOptions, course, drive, follow, jumps, outages, starts, stress};

/// Evaluates one file after another. A file that cannot be evaluated is reported on standard error,
/// and the next one follows.
///
/// # Errors
/// A folder cannot be created, or output cannot be written.
pub(crate) fn evaluate(
    bags: &[PathBuf],
    json: bool,
    map: Option<&OccupancyGrid>,
    (options, sequence): (&Options, &SequenceOptions),
) -> anyhow::Result<ExitCode> {
    for folder in sequence.trajectories.iter().chain(&sequence.pictures) {
        output::make_folder(folder)
            .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    }
    if let Some(stress) = &sequence.stress {
        let how = (options, sequence);
        return stress::evaluate(bags, json, map, how, stress);
    }
    let mut code = ExitCode::SUCCESS;
    for (bag, name) in bags.iter().zip(names::of(bags)) {
        match one((bag, &name), map, options, sequence) {
            Ok(figures) => {
                let line = match json {
                    true => format!("{}\n", json::object(&figures)),
                    false => figures.text(),
                };
                stdout::print(&line)?;
                for missed in sequence.limits.missed(&figures.reached(), true) {
                    say(&format!("{}: {missed}", bag.display()));
                    code = ExitCode::FAILURE;
                }
            }
            Err(error) => {
                say(&format!("{error:#}"));
                code = ExitCode::FAILURE;
            }
        }
    }
    Ok(code)
}

fn one(
    (bag, file_name): (&Path, &str),
    map: Option<&OccupancyGrid>,
    options: &Options,
    sequence: &SequenceOptions,
) -> anyhow::Result<Figures> {
    let (recording, truths) = drive::open(bag, options)?;
    let mut session = Session::open(&recording, options, map)?;
    let name = bag.display().to_string();
    let progress = Progress::new(&name, session.scans.total());
    let mut accepted = Accepted::default();
    let moments = drive::read(
        &mut session,
        &truths,
        (
            &sequence.ignore_truth,
            (sequence.without_odometry, sequence.odometry_noise),
        ),
        (&progress, &mut accepted),
    )?;
    accepted.check(bag)?;
    let (world, config) = (session.world()?, sequence.tracking);
    let said = course::of(world, &moments, config)?;
    show(&session, (&moments, &said), (options, sequence), file_name)?;
    let chosen = starts::choose(&moments, sequence.starts);
    let starts = starts::evaluate(world, &moments, &chosen, config)?;
    let followed = follow::evaluate(world, &moments, config, true)?;
    let chosen = jumps::choose(&moments, sequence.kidnaps);
    let jumps = jumps::evaluate(world, &moments, &chosen, config)?;
    let chosen = outages::choose(&moments, sequence.outages);
    let outages = outages::evaluate(world, &moments, &chosen, config)?;
    for (start, scan, off_m) in &starts.wrong {
        progress.say(&format!(
            "{name}: started at scan {start}, Unique and {off_m:.1} m off at scan {scan}"
        ));
    }
    let lost: Vec<String> = followed.losses.iter().map(ToString::to_string).collect();
    if !lost.is_empty() {
        progress.say(&format!("{name}: lost at scans {}", lost.join(", ")));
    }
    for (from, to) in &jumps.wrong {
        progress.say(&format!(
            "{name}: put from scan {from} to {to}, Unique and wrong"
        ));
    }
    for (from, to, off_m) in &outages.wrong {
        progress.say(&format!(
            "{name}: no data between scans {from} and {to}, Unique and {off_m:.1} m off after that"
        ));
    }
    let searching_ms = moments.iter().map(|moment| moment.search_ms);
    Ok(Figures::new(
        name,
        (&starts, &followed, (&jumps, &outages)),
        course::errors(&moments, &said),
        searching_ms,
    ))
}

/// Writes the requested trajectories and picture of the drive from its first scan.
fn show(
    session: &Session<'_>,
    (moments, said): (&[Moment], &[Said]),
    (options, sequence): (&Options, &SequenceOptions),
    name: &str,
) -> anyhow::Result<()> {
    if let Some(folder) = &sequence.trajectories {
        course::write(folder, name, (moments, said))?;
    }
    if let Some(folder) = &sequence.pictures {
        let words = (name.to_owned(), course::doubts(said));
        let stops = course::stops(moments, said);
        let scene = draw_drive(session.map()?, options.engine.cells, &stops, words)?;
        plots::save_png(&scene, &folder.join(format!("{name}.png")))?;
    }
    Ok(())
}
