//! A search over several maps together.

use std::cmp::Ordering;

use super::{Preparation, VoteSearch, Workspace};
use crate::EngineError;
use crate::instruction_set::InstructionSet;
use crate::observation::Observation;
use crate::search::{Attempt, Lead};
use crate::votes::{VoteShare, least_close};

impl VoteSearch {
    /// Searches several maps together, each in its own workspace, with the settings of the first:
    /// collects from each map the poses that come near the best one of all. Returns the number of
    /// the map with the best pose (the first one on a tie), or `None` if `stop` returned true
    /// before the end.
    ///
    /// Votes are compared as exact shares of the highest possible on each map.
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`], the heading is not finite, or a map was
    /// prepared for the other [`Prior`](super::Prior).
    ///
    /// # Panics
    /// If there is no map.
    pub fn search_together(
        mut maps: Vec<(&VoteSearch, &mut Workspace)>,
        scan: Observation<'_>,
        heading: Option<f64>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<usize>, EngineError> {
        let best = Lead::default();
        let found = match heading {
            Some(heading) => at_heading(&mut maps, scan, heading, stop)?,
            None => at_any_heading(&mut maps, scan, &best, stop)?,
        };
        if found.is_none() {
            return Ok(None);
        }
        let shares = maps
            .iter()
            .map(|(_, workspace)| workspace.outcome.best_share());
        let greater = |a: (usize, VoteShare), b: (usize, VoteShare)| match b.1.compare(a.1) {
            Ordering::Greater => b,
            _ => a,
        };
        let (leading, lead) = shares.enumerate().reduce(greater).expect("a map");
        for (map, workspace) in &mut maps {
            let outcome = &mut workspace.outcome;
            outcome.lead = lead.on(outcome.highest_possible as u16);
            if heading.is_some() {
                let floor = map.prepared.config.collect.floor(outcome.lead);
                let least = least_close(outcome.lead);
                outcome.found.confine((outcome.lead, floor), Some(least));
            }
        }
        Ok(Some(leading))
    }
}

fn at_any_heading(
    maps: &mut [(&VoteSearch, &mut Workspace)],
    scan: Observation<'_>,
    lead: &Lead,
    stop: &dyn Fn() -> bool,
) -> Result<Option<()>, EngineError> {
    let mut indices = Vec::with_capacity(maps.len());
    for (map, workspace) in maps.iter_mut() {
        indices.push(map.index()?);
        let (space, votes) = (&map.prepared.space, &map.prepared.config.votes);
        workspace.program.compile(scan, 0.0, space, votes)?;
    }
    let config = &maps.first().expect("a map").0.prepared.config;
    let how = (InstructionSet::best(), usize::from(config.threads));
    let attempts = maps.iter_mut().zip(indices);
    let attempts = attempts.map(|((map, workspace), index)| {
        let Workspace {
            program,
            search,
            outcome,
            ..
        } = &mut **workspace;
        let Preparation { grid, space, .. } = &map.prepared;
        let (scan, together) = ((&*program, space), (lead, stop));
        let attempt = index.attempt(search, how, grid, scan, config.collect, together);
        (attempt, &mut outcome.found)
    });
    let found = Attempt::find_all(&mut attempts.collect::<Vec<_>>(), stop);
    for (map, workspace) in maps.iter_mut() {
        let Workspace {
            program, outcome, ..
        } = &mut **workspace;
        map.describe(program, None, outcome);
    }
    Ok(found)
}

fn at_heading(
    maps: &mut [(&VoteSearch, &mut Workspace)],
    scan: Observation<'_>,
    heading: f64,
    stop: &dyn Fn() -> bool,
) -> Result<Option<()>, EngineError> {
    for (map, workspace) in maps.iter_mut() {
        if map.at_heading(workspace, scan, heading, stop)?.is_none() {
            return Ok(None);
        }
    }
    Ok(Some(()))
}
