//! Evaluates the variants of each drive, and prints the figures.

use std::path::Path;

use ::map::OccupancyGrid;
use command_line::{OutputError, say, stdout};
use offline::{Accepted, Options, Progress, Session, map_in};
use plots::draw_drive;

use super::super::limits::Reached;
use super::super::{Task, course, drive};
use super::figures::Figures;
use super::material::Material;
use super::trial::{Recorded, Trial, Wrong};
use super::variants::{Stress, Variant};
use crate::outcomes::Outcomes;
use crate::trust::{self, Trust};

/// Evaluates the variants of the files; one that cannot be evaluated is reported, and skipped.
pub(in super::super) fn evaluate(
    task: &Task<'_>,
    (names, stress): (&[String], &Stress),
    outcomes: &mut Outcomes,
) -> anyhow::Result<()> {
    let (bags, variants) = (task.bags, stress.variants());
    let mut trust = Trust::default();
    for (i, (bag, name)) in bags.iter().zip(names).enumerate() {
        let next = (bags.len() > 1).then(|| &bags[(i + 1) % bags.len()]);
        let other = task.sequence.other_map.as_ref().or(next);
        let other = other
            .map(|file| task.options.with_map(file).load_map(&[]))
            .transpose()?;
        let so_far = (&mut trust, &mut *outcomes);
        let other = other.flatten();
        match one((bag, name), task, other.as_ref(), &variants, so_far) {
            Ok(()) => {}
            Err(error) if error.is::<OutputError>() => return Err(error),
            Err(error) => outcomes.failed(&bag.display().to_string(), &error, say),
        }
    }
    if !task.report.json {
        stdout::print(&format!("\n{}", trust::table(&trust.said())))?;
    }
    Ok(())
}

fn one(
    (bag, file_name): (&Path, &str),
    task: &Task<'_>,
    other_map: Option<&OccupancyGrid>,
    variants: &[&'static Variant],
    (trust, outcomes): (&mut Trust, &mut Outcomes),
) -> anyhow::Result<()> {
    let (options, sequence) = (task.options, task.sequence);
    let json = task.report.json;
    let (recording, truths) = task.truths.open(bag, options)?;
    let map = task.map.cloned().map_or_else(|| map_in(&recording), Ok)?;
    let ignored = sequence.ignore_truth.iter().copied().collect();
    let mut session = Session::open(&recording, options, Some(&map))?;
    let known = (&truths, &ignored);
    let mut material = Material::read(&recording, &mut session, map.clone(), known)?;
    let name = bag.display().to_string();
    let progress = Progress::new(&name, (variants.len() * material.steps.len()) as u64);
    let mut accepted = Accepted::default();
    let mut moments = material.search(&mut session, (&progress, &mut accepted))?;
    accepted.check(bag)?;
    drive::measure(&mut moments);
    material.measure(&moments);
    let recorded = Recorded {
        recording: &recording,
        options,
        material: &material,
        moments: &moments,
        progress: &progress,
    };
    if !json {
        stdout::print(&format!("{name}\n{}", Figures::HEADER))?;
    }
    for variant in variants {
        let means = variant.means(sequence.seed, other_map);
        let how = (sequence.starts, sequence.tracking);
        let trial = match recorded.judge(&mut session, variant, means, how)? {
            Ok(trial) => trial,
            Err(reason) => {
                progress.say(&format!("{name}: {} is left out: {reason}", variant.name));
                continue;
            }
        };
        let tally = trial.starts.tally.with(&trial.followed.tally);
        trust.merge(&tally.trust);
        let judged = (&trial.starts, &trial.followed);
        let figures = Figures::new((name.clone(), variant.name), judged, tally);
        let line = match json {
            true => format!("{}\n", command_line::json::object(&figures)),
            false => figures.row(),
        };
        stdout::print(&line)?;
        if let Some(wrong) = &trial.first_wrong {
            progress.say(&format!("{name}: {}: {}", variant.name, words(wrong)));
            if let Some(folder) = &sequence.pictures {
                picture(folder, (file_name, variant.name), (&trial, wrong), options)?;
            }
        }
        let reached = Reached::of(&trial.starts, &trial.followed);
        // On a map where no pose is right there is nothing to follow.
        let has_truth = !trial.followed.said.is_empty();
        let missed = sequence.limits.missed(&reached, has_truth);
        let say = |line: &str| progress.say(line);
        outcomes.judged(&name, Some(variant.name), &missed, say);
    }
    Ok(())
}

fn words(wrong: &Wrong) -> String {
    let start = match wrong.start {
        Some(start) => format!("started at scan {start}"),
        None => "followed from the truth".to_owned(),
    };
    let (off_m, off_deg) = wrong.off;
    let off = match off_m.is_finite() {
        true => format!("{off_m:.1} m and {off_deg:.0}° off"),
        false => "no pose is right".to_owned(),
    };
    format!("{start}, Unique and wrong at scan {}: {off}", wrong.scan)
}

fn picture(
    folder: &Path,
    (name, variant): (&str, &str),
    (trial, wrong): (&Trial, &Wrong),
    options: &Options,
) -> anyhow::Result<()> {
    let stops = course::stops(&wrong.moments, &wrong.said);
    let title = format!("{name}, {variant}");
    let scene = draw_drive(
        &trial.map,
        options.engine.cells,
        &stops,
        (title, words(wrong)),
    )?;
    plots::save_png(&scene, &folder.join(format!("{name}_{variant}.png")))
}
