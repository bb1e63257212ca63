//! The engine's methods, as the bench calls them.

use std::cmp::Reverse;
use std::time::Instant;

use crate::baselines::Estimate;
use crate::worlds::World;
use engine::accumulator::{Accumulator, Query};
use engine::instruction_set::InstructionSet;
use engine::program::ScanProgram;
use engine::search::{SearchIndex, Workspace};
use engine::space::Space;
use engine::sweep::{FieldSweep, Sweep};
use engine::votes::{CollectConfig, VoteSet, distinct};
use messages::Vote;

use super::measure::{Answer, Locate, Task};

/// Collects only the best pose.
pub(super) const ARGMAX: CollectConfig = CollectConfig {
    floor_share: 1.0,
    max_votes: 1,
    candidates: 0,
    work_limit: None,
};

fn program(task: &Task<'_>) -> anyhow::Result<ScanProgram> {
    let program = ScanProgram::new(&task.scan.scan(), 0.0, task.space, &task.votes);
    Ok(program?)
}

/// By the fields of an accumulator at some headings.
pub(super) fn fields<'a, A: Accumulator + 'a>(world: &'a World, accumulator: A) -> Locate<'a> {
    let (mut accumulator, mut field) = (accumulator, Vec::new());
    let width = world.grid.width();
    Box::new(move |task, headings| {
        let program = program(task)?;
        let bests = headings.iter().filter_map(|&heading| {
            let query = Query {
                program: &program,
                space: task.space,
                heading,
            };
            accumulator.fill(query, &mut field, &|| false)?;
            let first_best = |(i, votes): (usize, &u16)| (*votes, Reverse(heading), Reverse(i));
            field.iter().enumerate().map(first_best).max()
        });
        // Of equal ones the first, as the search has it.
        let best = bests.max().filter(|&(votes, ..)| votes > 0);
        Ok(Answer::Best(best.map(|(votes, heading, Reverse(cell))| {
            Estimate::new(cell % width, cell / width, heading.0, votes.into())
        })))
    })
}

/// By bounds, in a workspace that is kept from scan to scan, as the graph does it.
pub(super) fn search<'a>(
    world: &'a World,
    index: &'a SearchIndex,
    collect: CollectConfig,
) -> Locate<'a> {
    let (mut workspace, mut found) = (Workspace::default(), VoteSet::default());
    Box::new(move |task, _| {
        let (how, program) = ((InstructionSet::best(), 1), program(task)?);
        let (scan, collect) = ((&program, task.space), (collect, &mut found));
        let grid = &world.grid;
        let searched = index.search_in(&mut workspace, how, grid, scan, collect, &|| false);
        let best = searched.and_then(|()| found.votes.first());
        Ok(Answer::Best(best.map(Estimate::from)))
    })
}

/// The sixteen best distinct poses, exactly, with every pose counted: down to half of the
/// best one's votes at first, and lower where fewer are distinct. Gives up after this many
/// seconds, or where a million poses are not enough.
pub(super) fn top_sixteen<'a>(
    world: &'a World,
    sweeps: &'a FieldSweep,
    patience_s: f64,
) -> Locate<'a> {
    const COUNT: usize = 16;
    Box::new(move |task, _| {
        let program = program(task)?;
        let start = Instant::now();
        let is_late = || start.elapsed().as_secs_f64() > patience_s;
        let (mut accumulator, scan) = (sweeps.accumulator(), (&program, task.space));
        let mut floor_share = 0.5;
        loop {
            let width = world.grid.width();
            let Some(found) = count_all(&mut accumulator, width, scan, floor_share, &is_late)
            else {
                return Ok(Answer::GaveUp);
            };
            let poses = distinct(&found, task.space, COUNT);
            let best = found.first().map_or(0, |best| best.intensity);
            // At 1 or below, all poses that have votes were collected.
            if poses.len() == COUNT || floor_of(best, floor_share) <= 1 {
                return Ok(Answer::Best(poses.first().map(Estimate::from)));
            }
            floor_share /= 2.0;
        }
    })
}

/// Counts the votes of every pose, heading by heading. Returns those with at least this share of the
/// most votes, best first; `None` if `stop` returned true, or they are more than a million.
fn count_all(
    accumulator: &mut Sweep<'_>,
    width: usize,
    (program, space): (&ScanProgram, &Space),
    floor_share: f64,
    stop: &dyn Fn() -> bool,
) -> Option<Vec<Vote>> {
    const MOST: usize = 1_000_000;
    let (mut field, mut found, mut floor) = (Vec::new(), Vec::new(), 1);
    for heading in 0..space.directions.count() {
        let query = Query {
            program,
            space,
            heading,
        };
        accumulator.fill(query, &mut field, stop)?;
        for (y, row) in (0..).zip(field.chunks_exact(width)) {
            // A maximum is quick to compute, and few rows contain a pose that matters.
            let most = row.iter().copied().fold(0, u16::max);
            floor = floor.max(floor_of(most, floor_share));
            if most < floor {
                continue;
            }
            let votes = (0..).zip(row).filter(|&(_, &votes)| votes >= floor);
            found.extend(votes.map(|(x, &intensity)| Vote {
                x,
                y,
                heading: heading as u16,
                intensity,
            }));
        }
        found.retain(|vote: &Vote| vote.intensity >= floor);
        if found.len() > MOST {
            return None;
        }
    }
    found.sort_unstable_by_key(|vote| (Reverse(vote.intensity), vote.heading, vote.y, vote.x));
    Some(found)
}

/// Smallest number of votes that is at least this share of the most votes, and 1.
fn floor_of(most: u16, share: f64) -> u16 {
    ((f64::from(most) * share).ceil() as u16).max(1)
}
