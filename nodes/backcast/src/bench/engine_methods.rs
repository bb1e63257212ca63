//! The engine's methods, as the bench calls them.

use std::time::Instant;

use benchmarks::worlds::World;
use engine::accumulator::{Accumulator, Query};
use engine::program::ScanProgram;
use engine::scatter::Scatter;
use engine::search::SearchIndex;
use engine::sweep::FieldSweep;
use engine::votes::{CollectConfig, VoteSet, of_field};

use super::measure::{Answer, Locate, Pose, Task};
use crate::BackcastError;

/// Only the best pose.
const ARGMAX: CollectConfig = CollectConfig {
    floor_share: 1.0,
    max_votes: 1,
    candidates: 0,
};

/// Two poses so near are one place: 0.3 m and 6.5 degrees.
const SAME_CELLS: f64 = 6.0;
const SAME_DEGREES: f64 = 6.5;

fn program(task: &Task<'_>) -> Result<ScanProgram, BackcastError> {
    ScanProgram::new(&task.scan.scan(), 0.0, task.space, &task.votes)
        .map_err(BackcastError::Refused)
}

fn best(found: &VoteSet) -> Option<Pose> {
    found.votes.first().map(|vote| Pose {
        x: usize::from(vote.x),
        y: usize::from(vote.y),
        heading: usize::from(vote.heading),
    })
}

/// By the fields of an accumulator at some headings.
fn fields<'a, A: Accumulator + 'a>(world: &'a World, accumulator: A) -> Locate<'a> {
    let (mut accumulator, mut field) = (accumulator, Vec::new());
    Box::new(move |task, headings| {
        let program = program(task)?;
        let sets = headings.iter().filter_map(|&heading| {
            let query = Query {
                program: &program,
                space: task.space,
                heading,
            };
            accumulator.fill(query, &mut field, &|| false)?;
            Some(of_field(&field, world.grid.width(), heading as u16, ARGMAX))
        });
        // Of equal ones the first, as the search has it.
        let better = |a: VoteSet, b: VoteSet| if b.best > a.best { b } else { a };
        let found = sets.reduce(better);
        Ok(Answer::Best(found.and_then(|found| best(&found))))
    })
}

/// The paper's own way: from boundary cells.
pub(super) fn scatter(world: &World) -> Locate<'_> {
    fields(world, Scatter::new(&world.grid, &world.boundary))
}

/// By sweeps along the lines of each beam.
pub(super) fn sweep<'a>(world: &'a World, sweeps: &'a FieldSweep) -> Locate<'a> {
    fields(world, sweeps.accumulator())
}

/// By bounds, down to a share of the best.
pub(super) fn search<'a>(world: &'a World, index: &'a SearchIndex, floor_share: f64) -> Locate<'a> {
    let collect = CollectConfig {
        floor_share,
        ..CollectConfig::default()
    };
    Box::new(move |task, _| {
        let found = index.search(&world.grid, &program(task)?, task.space, collect, &|| false);
        Ok(Answer::Best(found.and_then(|found| best(&found))))
    })
}

/// The sixteen best distinct poses, exactly: the floor falls until as many
/// stand above it. Gives up after so many seconds, or where a million poses are
/// not enough.
pub(super) fn top_sixteen<'a>(
    world: &'a World,
    index: &'a SearchIndex,
    patience_s: f64,
) -> Locate<'a> {
    Box::new(move |task, _| {
        let program = program(task)?;
        let start = Instant::now();
        let is_late = || start.elapsed().as_secs_f64() > patience_s;
        let mut floor_share = 0.85;
        loop {
            let collect = CollectConfig {
                floor_share,
                max_votes: 1_000_000,
                candidates: 0,
            };
            let found = index.search(&world.grid, &program, task.space, collect, &is_late);
            let Some(found) = found else {
                return Ok(Answer::GaveUp);
            };
            if distinct(&found, task) >= 16 || floor_share < 0.1 {
                return Ok(Answer::Best(best(&found)));
            }
            if found.truncated {
                return Ok(Answer::GaveUp);
            }
            floor_share *= 0.85;
        }
    })
}

/// Distinct poses among those that are certain to be complete, up to 16.
fn distinct(found: &VoteSet, task: &Task<'_>) -> usize {
    let mut places: Vec<Pose> = Vec::new();
    let certain = found
        .votes
        .iter()
        .take_while(|vote| vote.intensity >= found.certified_floor);
    for vote in certain {
        let (x, y) = (usize::from(vote.x), usize::from(vote.y));
        let heading = usize::from(vote.heading);
        let is_near = |place: &Pose| {
            let cells = (place.x.abs_diff(x) as f64).hypot(place.y.abs_diff(y) as f64);
            let turned = (place.heading as f64 - heading as f64) * task.space.directions.spacing();
            cells <= SAME_CELLS && geometry::wrap_angle(turned).abs() <= SAME_DEGREES.to_radians()
        };
        if !places.iter().any(is_near) {
            places.push(Pose { x, y, heading });
            if places.len() == 16 {
                break;
            }
        }
    }
    places.len()
}
