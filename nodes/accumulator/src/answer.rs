//! Searches scans with the engine and fills in the messages about them.

use bytemuck::Zeroable;
use engine::EngineError;
use engine::observation::Observation;
use engine::vote_search::{Outcome, VoteSearch, Workspace};
use engine::votes::VoteSet;
use messages::{FieldHeader, FieldKind, ScanHeader, SearchOutcome, Vote, VotesHeader};

use crate::preparation::PreparedMap;

/// Header and items of `votes`; the items are borrowed from the engine's workspace.
pub type Answer<'a> = (VotesHeader, &'a [Vote]);

pub type Image<'a> = (FieldHeader, &'a [u16]);

/// Searches the maps, at least one, each in its workspace; returns the leading map's index, or
/// `None` if `stop` interrupted. A known heading needs maps prepared for it.
pub fn ask(
    maps: &[PreparedMap],
    workspaces: &mut Vec<Workspace>,
    scan: Observation<'_>,
    heading: Option<f64>,
    stop: &dyn Fn() -> bool,
) -> Result<Option<usize>, EngineError> {
    workspaces.resize_with(maps.len(), Workspace::default);
    if let ([map], [workspace]) = (maps, &mut workspaces[..]) {
        let found = map.vote_search.search_in(workspace, scan, heading, stop)?;
        return Ok(found.map(|_| 0));
    }
    let searches = maps.iter().map(|map| &map.vote_search);
    let searched = searches.zip(workspaces.iter_mut()).collect();
    VoteSearch::search_together(searched, scan, heading, stop)
}

/// Returns the message about a scan for which the engine took `engine_ns`.
pub fn answered<'w>(
    scan: &ScanHeader,
    map: &PreparedMap,
    outcome: &'w Outcome,
    engine_ns: u64,
) -> Answer<'w> {
    let found = &outcome.found;
    let beams = &map.vote_search.config().votes.beams;
    let code = match found.best > 0 {
        true => SearchOutcome::Found,
        false => SearchOutcome::NoVotes,
    };
    let votes = VotesHeader {
        total: found.votes.len() as u64,
        engine_ns,
        poses_evaluated: found.poses_evaluated,
        floor: found.floor.into(),
        certified_floor: found.certified_floor.into(),
        best: found.best.into(),
        highest_possible: outcome.highest_possible,
        truncated: truncated(found),
        beams_used: outcome.beams_used,
        beams_silent: outcome.beams_silent,
        heading_known: outcome.known_heading.is_some().into(),
        known_heading: outcome.known_heading.unwrap_or(0.0),
        bearing_rounding: outcome.bearing_rounding,
        max_beams: beams.max_beams,
        pooling: map.vote_search.pooling() as u32,
        beam_arc_m: beams.beam_arc_m,
        ..unsearched(scan, code, map.map_id, outcome.headings)
    };
    (votes, &found.votes)
}

/// Returns the image of the last search: all intensities, or the bounds of blocks.
pub fn image<'w>(
    votes: &VotesHeader,
    vote_search: &VoteSearch,
    workspace: &'w mut Workspace,
    scan: Observation<'_>,
) -> Result<Image<'w>, EngineError> {
    // The heading stays 0 for bounds: they hold for all headings.
    let header = FieldHeader {
        stamp: votes.stamp,
        map_id: votes.map_id,
        highest_possible: votes.highest_possible,
        ..FieldHeader::zeroed()
    };
    if votes.heading_known == 1 {
        let grid = vote_search.grid();
        let header = FieldHeader {
            // A side of a grid has at most 15 bits.
            width: grid.width() as u32,
            height: grid.height() as u32,
            block: votes.pooling,
            kind: FieldKind::Exact as u32,
            best: votes.best,
            heading: votes.known_heading,
            ..header
        };
        return Ok((header, workspace.intensities()));
    }
    let blocks = vote_search.block_bounds(workspace, scan)?;
    let header = FieldHeader {
        // At most the number of cells along a side.
        width: blocks.columns as u32,
        height: blocks.rows() as u32,
        block: blocks.side as u32 * votes.pooling,
        kind: FieldKind::UpperBound as u32,
        best: blocks.bounds.iter().copied().max().unwrap_or(0).into(),
        ..header
    };
    Ok((header, &blocks.bounds))
}

/// Says whether votes were left out, and whether the search was cut.
fn truncated(found: &VoteSet) -> u32 {
    match found.cut {
        true => VotesHeader::CUT,
        false => found.truncated.into(),
    }
}

/// Returns the header of the votes of a scan without a search; `map_id` is 0 if there is no map.
pub fn unsearched(
    scan: &ScanHeader,
    outcome: SearchOutcome,
    map_id: u64,
    headings: u32,
) -> VotesHeader {
    VotesHeader {
        stamp: scan.stamp,
        map_id,
        headings,
        outcome: outcome as u32,
        base_from_laser: scan.base_from_laser,
        mount_known: scan.mount_known,
        ..VotesHeader::zeroed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_search_that_was_cut_says_so() {
        let said = |cut| {
            truncated(&VoteSet {
                truncated: true,
                cut,
                ..VoteSet::default()
            })
        };
        assert_eq!((said(false), said(true)), (1, VotesHeader::CUT));
    }
}
