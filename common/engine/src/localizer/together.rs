//! Several maps that are searched together.

use super::{Localizer, Workspace};
use crate::EngineError;
use crate::instruction_set::InstructionSet;
use crate::observation::Observation;
use crate::search::{SearchIndex, Searched};
use crate::votes::{CollectConfig, VoteShare, least_close};

/// What is known and wanted beside the settings of the maps.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Together {
    /// The heading in the maps' frames, radians, where it is given.
    pub heading: Option<f64>,
    /// The share of a pose on a map that somebody else searches; no votes where none is known.
    pub lead: VoteShare,
    /// What is collected, where it is not what the first map's settings say.
    pub collect: Option<CollectConfig>,
}

impl Localizer {
    /// Searches maps together, each in a workspace of its own, with the settings of the first:
    /// of each map the poses that come near the best one of all. Gives what that one has, be it
    /// known beforehand, or `None` if `stop` said so before the end.
    ///
    /// Votes are compared as shares of the highest possible on each map, without rounding.
    ///
    /// # Errors
    /// If the scan is refused, see [`Observation::check`], or the heading not finite.
    ///
    /// # Panics
    /// If there is no map, or a localizer was prepared for the other kind of question.
    pub fn search_together(
        mut maps: Vec<(&Localizer, &mut Workspace)>,
        scan: Observation<'_>,
        together: Together,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<VoteShare>, EngineError> {
        let found = match together.heading {
            Some(heading) => at_heading(&mut maps, scan, heading, stop)?.map(|()| together.lead),
            None => at_any_heading(&mut maps, scan, together, stop)?,
        };
        let Some(counted) = found else {
            return Ok(None);
        };
        let shares = maps
            .iter()
            .map(|(_, workspace)| workspace.outcome.best_share());
        let shares = shares.chain([counted]);
        let lead = shares.max_by(|a, b| a.compare(*b)).expect("a share");
        for (map, workspace) in &mut maps {
            let outcome = &mut workspace.outcome;
            outcome.lead = lead.on(outcome.highest_possible as u16);
            if together.heading.is_some() {
                let floor = map.config.collect.floor(outcome.lead);
                let least = least_close(outcome.lead);
                outcome.found.confine((outcome.lead, floor), Some(least));
            }
        }
        Ok(Some(lead))
    }
}

fn at_any_heading(
    maps: &mut [(&Localizer, &mut Workspace)],
    scan: Observation<'_>,
    together: Together,
    stop: &dyn Fn() -> bool,
) -> Result<Option<VoteShare>, EngineError> {
    for (map, workspace) in maps.iter_mut() {
        let (space, votes) = (&map.space, &map.config.votes);
        workspace.program.compile(scan, 0.0, space, votes)?;
    }
    let config = &maps.first().expect("a map").0.config;
    let how = (InstructionSet::best(), usize::from(config.threads));
    let collect = together.collect.unwrap_or(config.collect);
    let searched = maps.iter_mut().map(|(map, workspace)| {
        let Workspace {
            program,
            search,
            outcome,
            ..
        } = &mut **workspace;
        Searched {
            index: map.index(),
            grid: &map.grid,
            scan: (program, &map.space),
            workspace: search,
            found: &mut outcome.found,
        }
    });
    let mut searched: Vec<_> = searched.collect();
    let found = SearchIndex::search_together(&mut searched, how, (collect, together.lead), stop);
    for (map, workspace) in maps.iter_mut() {
        let Workspace {
            program, outcome, ..
        } = &mut **workspace;
        map.describe(program, None, outcome);
    }
    Ok(found)
}

fn at_heading(
    maps: &mut [(&Localizer, &mut Workspace)],
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
