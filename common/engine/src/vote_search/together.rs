//! A search over several maps together.

use std::cmp::Ordering;

use super::{VoteSearch, Workspace};
use crate::EngineError;
use crate::instruction_set::InstructionSet;
use crate::observation::Observation;
use crate::search::{Lead, SearchIndex, Searched};
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
                let floor = map.config.collect.floor(outcome.lead);
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
        let (space, votes) = (&map.space, &map.config.votes);
        workspace.program.compile(scan, 0.0, space, votes)?;
    }
    let config = &maps.first().expect("a map").0.config;
    let how = (InstructionSet::best(), usize::from(config.threads));
    let searched = maps
        .iter_mut()
        .zip(indices)
        .map(|((map, workspace), index)| {
            let Workspace {
                program,
                search,
                outcome,
                ..
            } = &mut **workspace;
            Searched {
                index,
                grid: &map.grid,
                scan: (program, &map.space),
                workspace: search,
                found: &mut outcome.found,
            }
        });
    let mut searched: Vec<_> = searched.collect();
    let found = SearchIndex::search_together(&mut searched, how, (config.collect, lead), stop);
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
        if map.search_at_in(workspace, scan, heading, stop)?.is_none() {
            return Ok(None);
        }
    }
    Ok(Some(()))
}
