//! Votes on several maps that were searched together.

use engine::peaks::{Found, PeakConfig, merge};
use engine::votes::VoteShare;
use messages::{Vote, VotesHeader};

use super::{Answer, OnMap, Workspace, judged, said};
use crate::PeakError;
use crate::check::{check_on_map, mount};
use crate::maps::Maps;
use crate::scans::Scans;

/// Reads the places from votes on several maps that were searched together, as the engine's
/// `MapSet` does it in one process.
pub(super) fn on_several<'w>(
    header: &VotesHeader,
    votes: &[Vote],
    (maps, scans): (&Maps, &Scans),
    config: &PeakConfig,
    workspace: &'w mut Workspace,
) -> Result<Answer<'w>, PeakError> {
    let by_map = scans.by_map(header.stamp)?;
    let parts = by_map
        .iter()
        .fold(0, |all: u64, on_map| all.saturating_add(on_map.total));
    if by_map.is_empty() || parts != votes.len() as u64 {
        return Err(PeakError::Parts {
            maps: by_map.len(),
            parts,
            total: votes.len(),
        });
    }
    let base_from_laser = mount(header)?;
    let Workspace {
        maps: on_maps,
        map_ids,
        merged,
        beams,
    } = workspace;
    on_maps.resize_with(by_map.len(), OnMap::default);
    map_ids.clear();
    map_ids.extend(by_map.iter().map(|on_map| on_map.map_id));
    let share =
        |votes: &VotesHeader| VoteShare::new(votes.best as u16, votes.highest_possible as u16);
    let (lead, each) = (share(header), config.of_each_map());
    let mut found = Vec::with_capacity(by_map.len());
    let mut rest = votes;
    for (number, (on_map, workspace)) in (0..).zip(by_map.iter().zip(on_maps.iter_mut())) {
        let (here, after) = rest.split_at(on_map.total as usize);
        rest = after;
        let mut checked = check_on_map(on_map, here, maps, lead)?;
        checked.input.has_others = by_map.len() > 1;
        let judged = workspace.judge(header, &checked, scans, &each)?;
        let lead = (number, share(on_map));
        found.push(Found::with(lead, on_map.certified_floor, &judged));
    }
    *merged = merge(&found, config);
    let best = &on_maps[merged.best_of];
    merged.places.classes.clone_from(best.peaks.classes());
    let best_map = &by_map[merged.best_of];
    let frame = maps.get(best_map.map_id)?.frame;
    beams.clear();
    if let Some(ends) = best.peaks.judged_ends(config.score) {
        beams.extend(judged(ends, &merged.places));
    }
    let votes = VotesHeader {
        maps: header.maps,
        engine_ns: header.engine_ns,
        searched: header.searched,
        ..*best_map
    };
    let of = (&map_ids[..], &beams[..]);
    Ok(said(&votes, &merged.places, of, (base_from_laser, frame)))
}
