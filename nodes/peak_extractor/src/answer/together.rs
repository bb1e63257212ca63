//! Votes on several maps that were searched together.

use engine::peaks::{Found, PeakConfig, merge};
use engine::votes::VoteShare;
use messages::{Vote, VotesHeader};

use super::{Answer, OnMap, Workspace, judged, said};
use crate::PeakError;
use crate::check::{check_on_map, mount};
use crate::maps::Maps;
use crate::scans::Scans;

/// Finds the places on several maps, as the engine's `Localizer` in one process.
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
    let maps_agree = by_map.len() as u64 == header.maps;
    if by_map.is_empty() || !maps_agree || parts != votes.len() as u64 {
        let (maps, total) = (by_map.len(), votes.len());
        return Err(PeakError::Votes(format!(
            "{maps} maps have {parts} votes together, and {total} came"
        )));
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
        found.push(Found::on(number, share(on_map), &judged));
    }
    *merged = merge(&found, config);
    let best = &on_maps[merged.best_of];
    merged.places.classes.clone_from(best.peaks.classes());
    let best_map = &by_map[merged.best_of];
    let frame = maps.get(best_map.map_id)?.frame;
    beams.clear();
    beams.extend(judged(best.peaks.ends(), &merged.places));
    let votes = VotesHeader {
        maps: header.maps,
        engine_ns: header.engine_ns,
        searched: header.searched,
        ..*best_map
    };
    let of = (&map_ids[..], &beams[..]);
    Ok(said(&votes, &merged.places, of, (base_from_laser, frame)))
}

#[cfg(test)]
mod tests {
    use messages::{Hypothesis, MapHeader, MapSet, SearchOutcome, Verdict};

    use super::super::answer;
    use super::*;
    use crate::testing::{cells, room, scans, votes_header};

    /// Returns two maps of a set, 7 and 8, which look alike.
    fn maps() -> Maps {
        let map = |map_id| MapHeader { map_id, ..room() };
        let cells = cells();
        let set = MapSet {
            maps: vec![(map(7), &cells[..]), (map(8), &cells)],
            transitions: Vec::new(),
        };
        let mut maps = Maps::default();
        maps.receive_set(&set).unwrap();
        maps
    }

    fn vote(x: u16, intensity: u16) -> Vote {
        crate::testing::vote(x, 5, 0, intensity)
    }

    /// Returns the header for this many votes on a map, the best of which has intensity `best`.
    fn on_map(map_id: u64, total: u64, best: u32) -> VotesHeader {
        let outcome = match best {
            0 => SearchOutcome::NoVotes,
            _ => SearchOutcome::Found,
        };
        VotesHeader {
            map_id,
            total,
            outcome: outcome as u32,
            certified_floor: best / 2,
            best,
            ..votes_header()
        }
    }

    /// Returns the result for votes on the maps of `parts`; the first one leads.
    fn said(
        parts: &[VotesHeader],
        votes: &[Vote],
    ) -> Result<(Verdict, Vec<Hypothesis>), PeakError> {
        let stamp = votes_header().stamp;
        let mut scans = scans(stamp);
        scans.take_by_map(stamp, parts);
        said_after(&scans, parts, votes)
    }

    fn said_after(
        scans: &Scans,
        parts: &[VotesHeader],
        votes: &[Vote],
    ) -> Result<(Verdict, Vec<Hypothesis>), PeakError> {
        let header = VotesHeader {
            maps: parts.len() as u64,
            total: votes.len() as u64,
            ..parts[0]
        };
        let (config, mut workspace) = (PeakConfig::default(), Workspace::default());
        let answer = answer(&header, votes, (&maps(), scans), &config, &mut workspace)?;
        let verdict = Verdict::from_code(answer.header.verdict).unwrap();
        Ok((verdict, answer.hypotheses().collect()))
    }

    #[track_caller]
    fn refused(parts: &[VotesHeader], votes: &[Vote], expected: &str) {
        let error = said(parts, votes).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }

    #[test]
    fn votes_are_those_of_the_maps_one_after_the_other() {
        let parts = [on_map(7, 2, 100), on_map(8, 1, 75)];
        let votes = [vote(10, 100), vote(20, 60), vote(3, 75)];
        let (verdict, found) = said(&parts, &votes).unwrap();
        assert_eq!(verdict, Verdict::Unique);
        let mut found: Vec<_> = found.iter().map(|h| (h.map_id, h.intensity)).collect();
        assert_eq!(found[0], (7, 100));
        found.sort_unstable();
        assert_eq!(found, [(7, 60), (7, 100), (8, 75)]);
        let even = [on_map(7, 1, 100), on_map(8, 1, 99)];
        let (verdict, _) = said(&even, &[vote(10, 100), vote(10, 99)]).unwrap();
        assert_eq!(verdict, Verdict::Ambiguous, "on another map");
    }

    #[test]
    fn where_no_map_has_votes_there_are_no_hypotheses() {
        let parts = [on_map(7, 0, 0), on_map(8, 0, 0)];
        let (verdict, found) = said(&parts, &[]).unwrap();
        assert_eq!((verdict, found.len()), (Verdict::NoScan, 0));
    }

    #[test]
    fn which_votes_are_on_which_map_has_to_be_known_and_to_hold() {
        let (parts, votes) = ([on_map(7, 1, 100)], [vote(10, 100)]);
        let unknown = said_after(&Scans::default(), &parts, &votes);
        assert!(matches!(unknown, Err(PeakError::UnknownParts)));
        refused(&[on_map(7, 2, 100)], &votes, "1 maps have 2 votes");
        refused(
            &[on_map(7, 1, 100), on_map(8, u64::MAX, 75)],
            &votes,
            "2 maps have 18446744073709551615 votes",
        );
        let (stamp, mut scans) = (votes_header().stamp, Scans::default());
        scans.take_by_map(stamp, &[on_map(7, 1, 100), on_map(8, 0, 0)]);
        let fewer = said_after(&scans, &parts, &votes);
        assert!(fewer.unwrap_err().to_string().starts_with("2 maps have"));
        scans.take_by_map(stamp, &[]);
        let none = said_after(&scans, &parts, &[]);
        assert!(none.unwrap_err().to_string().starts_with("0 maps have"));
    }

    #[test]
    fn each_part_is_checked() {
        let votes = [vote(10, 100), vote(3, 75)];
        let check = |change: fn(&mut VotesHeader), expected: &str| {
            let mut parts = [on_map(7, 1, 100), on_map(8, 1, 75)];
            change(&mut parts[1]);
            refused(&parts, &votes, expected);
        };
        check(|part| part.map_id = 9, "of map 0000000000000009");
        check(|part| part.outcome = 4, "outcome is 4");
        check(|part| part.best = 74, "best is 74 of 125");
        check(|part| part.headings = 0, "headings is 0");
    }
}
