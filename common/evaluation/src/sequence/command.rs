//! Reads drives, evaluates them one by one, and prints the figures.

use std::path::Path;

use command_line::{names, say, stdout};
use offline::{Accepted, Options, Progress, Session, no_truth_taken};
use plots::draw_drive;

use super::drive::Moment;
use super::errors::Samples;
use super::figures::{Figures, Judged};
use super::limits::Reached;
use super::run::Said;
use super::{SequenceOptions, Task, course, drive, follow, interruption, starts, stress};
use crate::outcomes::{Outcomes, total_line};

/// Evaluates the files; one that cannot be evaluated is reported, and the next one follows.
pub(crate) fn evaluate(task: &Task<'_>, outcomes: &mut Outcomes) -> anyhow::Result<()> {
    let names = names::of(task.bags);
    task.sequence.prepare(&names, task.report.force)?;
    if let Some(stress) = &task.sequence.stress {
        return stress::evaluate(task, (&names, stress), outcomes);
    }
    let (mut total, mut drives) = (Judged::default(), 0);
    let missed = |judged: &Judged| {
        let truths = task.truths.missed(judged.truths).into_iter();
        let reached = Reached::of(&judged.starts, &judged.followed);
        let limits = task.sequence.limits.missed(&reached, true);
        truths.chain(limits).collect::<Vec<_>>()
    };
    for (bag, file_name) in task.bags.iter().zip(&names) {
        let name = bag.display().to_string();
        let judged = match one((bag, file_name), task) {
            Ok(judged) => judged,
            Err(error) => {
                outcomes.failed(&name, &error, say);
                continue;
            }
        };
        total.merge(&judged);
        drives += 1;
        let figures = Figures::of(name.clone(), &judged);
        stdout::print(&match task.report.json {
            true => command_line::json::object(&figures) + "\n",
            false => figures.text(),
        })?;
        if !task.report.total {
            outcomes.judged(&name, None, &missed(&judged), say);
        }
    }
    if drives > 1 {
        let figures = Figures::of("total".to_owned(), &total);
        stdout::print(&match task.report.json {
            true => total_line(&figures),
            false => figures.text(),
        })?;
    }
    if task.report.total {
        outcomes.judged("total", None, &missed(&total), say);
    }
    Ok(())
}

fn one((bag, file_name): (&Path, &str), task: &Task<'_>) -> anyhow::Result<Judged> {
    let (options, sequence) = (task.options, task.sequence);
    let (recording, truths) = task.truths.open(bag, options)?;
    let mut session = Session::open(&recording, options, task.map)?;
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
    let with_truth = moments.iter().filter(|moment| moment.truth.is_some());
    let with_truth = with_truth.count() as u64;
    if with_truth == 0 {
        return Err(no_truth_taken(bag, moments.len() as u64, truths.recorded()));
    }
    let (world, config) = (session.world()?, sequence.tracking);
    let said = course::of(world, &moments, config)?;
    show(&session, (&moments, &said), (options, sequence), file_name)?;
    let chosen = starts::choose(&moments, sequence.starts);
    let starts = starts::evaluate(world, &moments, &chosen, config)?;
    let followed = follow::evaluate(world, &moments, config, true)?;
    let chosen = interruption::jumps(&moments, sequence.kidnaps);
    let jumps = interruption::evaluate(world, &moments, &chosen, config)?;
    let chosen = interruption::outages(&moments, sequence.outages);
    let outages = interruption::evaluate(world, &moments, &chosen, config)?;
    for (start, scan, off_m) in &starts.wrong {
        progress.say(&format!(
            "{name}: started at scan {start}, Unique and {off_m:.1} m off at scan {scan}"
        ));
    }
    let lost: Vec<String> = followed.losses.iter().map(ToString::to_string).collect();
    if !lost.is_empty() {
        progress.say(&format!("{name}: lost at scans {}", lost.join(", ")));
    }
    for (from, to, _) in &jumps.wrong {
        progress.say(&format!(
            "{name}: put from scan {from} to {to}, Unique and wrong"
        ));
    }
    for (from, to, off_m) in &outages.wrong {
        progress.say(&format!(
            "{name}: no data between scans {from} and {to}, Unique and {off_m:.1} m off after that"
        ));
    }
    Ok(Judged {
        truths: with_truth,
        starts,
        followed,
        jumps,
        outages,
        from_first_scan: Samples::of(&course::pairs(&moments, &said)),
        searching_ms: moments.iter().map(|moment| moment.search_ms).collect(),
    })
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
