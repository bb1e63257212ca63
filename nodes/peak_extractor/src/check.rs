//! Validation of votes: with a wrong heading, cell or order, the engine would compute nonsense.

use std::cmp::Reverse;
use std::fmt::Display;

use engine::beams::BeamConfig;
use engine::peaks::PeakInput;
use engine::votes::VoteShare;
use geometry::Pose;
use messages::{SearchOutcome, Vote, VotesHeader};

use crate::PeakError;
use crate::maps::{Map, Maps};

/// Largest pooling factor: cells of one millimetre in a searched cell of one metre.
const MAX_POOLED: u32 = 1_000;

/// Validated votes of a scan in the engine's form, and the data they refer to.
#[derive(Debug)]
pub struct Checked<'a> {
    pub input: PeakInput<'a>,
    pub map: &'a Map,
    pub beams: BeamConfig,
}

/// Validates the votes of a scan; returns `None` if the scan was refused or has no votes.
pub fn check<'a>(
    header: &VotesHeader,
    votes: &'a [Vote],
    maps: &'a Maps,
) -> Result<Option<Checked<'a>>, PeakError> {
    if outcome(header)? != SearchOutcome::Found {
        return Ok(None);
    }
    if header.best == 0 {
        return Err(contradicts(header, votes));
    }
    let lead = VoteShare::new(header.best as u16, header.highest_possible as u16);
    check_on_map(header, votes, maps, lead).map(Some)
}

/// Validates the votes on one map; `lead` is the best pose's vote share on all maps.
pub fn check_on_map<'a>(
    header: &VotesHeader,
    votes: &'a [Vote],
    maps: &'a Maps,
    lead: VoteShare,
) -> Result<Checked<'a>, PeakError> {
    outcome(header)?;
    let map = maps.get(header.map_id)?;
    check_header(header, votes)?;
    let pooling = pooling(header)?;
    check_poses(
        header,
        votes,
        (map.width.div_ceil(pooling), map.height.div_ceil(pooling)),
    )?;
    check_order(votes)?;
    let input = PeakInput {
        votes,
        certified_floor: header.certified_floor,
        cut: header.truncated == VotesHeader::CUT,
        highest_possible: header.highest_possible,
        lead: lead.on(header.highest_possible as u16).into(),
        has_others: false,
        headings: header.headings,
        known_heading: (header.heading_known == 1).then_some(header.known_heading),
        frame: map.frame.pooled(pooling as usize),
    };
    let beams = beams(header)?;
    Ok(Checked { input, map, beams })
}

fn outcome(header: &VotesHeader) -> Result<SearchOutcome, PeakError> {
    let found = header.outcome;
    SearchOutcome::from_code(found).ok_or_else(|| {
        let allowed = "0 (found), 1 (no votes), 2 (refused) and 3 (not asked)";
        setting("outcome", &found, allowed)
    })
}

/// Returns the pose of the laser on the robot, if the header has it.
pub fn mount(header: &VotesHeader) -> Result<Option<Pose>, PeakError> {
    if header.mount_known != 1 {
        return Ok(None);
    }
    let found = header.base_from_laser;
    let mount = Pose::from(found);
    if !mount.is_finite() {
        let (x, y, yaw) = (found.x, found.y, found.yaw);
        return Err(PeakError::Votes(format!(
            "base_from_laser is x {x} m, y {y} m, yaw {yaw} rad: each must be finite"
        )));
    }
    Ok(Some(mount))
}

fn beams(header: &VotesHeader) -> Result<BeamConfig, PeakError> {
    let found = header.beam_arc_m;
    if !(0.0..=2.0).contains(&found) {
        return Err(setting("beam_arc_m", &found, "0 to 2 metres"));
    }
    let max_beams = header.max_beams;
    if !(1..=1 << 16).contains(&max_beams) {
        return Err(setting("max_beams", &max_beams, "1 to 65536"));
    }
    Ok(BeamConfig {
        max_beams,
        beam_arc_m: found,
    })
}

/// Returns the pooling factor: map cells per searched cell and axis.
fn pooling(header: &VotesHeader) -> Result<u32, PeakError> {
    let found = header.pooling;
    match (1..=MAX_POOLED).contains(&found) {
        true => Ok(found),
        false => Err(setting("pooling", &found, "1 to 1000")),
    }
}

fn setting(field: &str, found: &dyn Display, allowed: &str) -> PeakError {
    PeakError::Votes(format!("{field} is {found}: allowed are {allowed}"))
}

fn check_header(header: &VotesHeader, votes: &[Vote]) -> Result<(), PeakError> {
    let headings = header.headings;
    if !(1..=1 << 16).contains(&headings) {
        return Err(setting("headings", &headings, "1 to 65536"));
    }
    let heading = header.known_heading;
    if header.heading_known == 1 && !heading.is_finite() {
        return Err(setting(
            "known_heading",
            &heading,
            "finite numbers, radians",
        ));
    }
    let (best, highest_possible) = (header.best, header.highest_possible);
    let is_first = votes.first().map(|vote| vote.intensity.into()) == Some(best);
    // If another map leads, all votes on this one may be below the floor.
    let is_sound = (is_first || best == 0) && best <= highest_possible;
    match is_sound && highest_possible <= u16::MAX.into() {
        true => Ok(()),
        false => Err(contradicts(header, votes)),
    }
}

fn contradicts(header: &VotesHeader, votes: &[Vote]) -> PeakError {
    let (best, highest_possible) = (header.best, header.highest_possible);
    let first = votes.first().map(|vote| vote.intensity);
    PeakError::Votes(format!(
        "best is {best} of {highest_possible} possible, and the first vote has {first:?}: they \
         must be 1 or more, the first two rising and the last two equal"
    ))
}

fn check_poses(
    header: &VotesHeader,
    votes: &[Vote],
    (width, height): (u32, u32),
) -> Result<(), PeakError> {
    let headings = header.headings;
    let is_known = |vote: &Vote| {
        u32::from(vote.x) < width
            && u32::from(vote.y) < height
            && u32::from(vote.heading) < headings
    };
    match votes.iter().enumerate().find(|(_, vote)| !is_known(vote)) {
        None => Ok(()),
        Some((index, &Vote { x, y, heading, .. })) => Err(PeakError::Votes(format!(
            "vote {index} is for cell {x}, {y} and heading {heading}: {width} x {height} cells \
             were searched at {headings} headings"
        ))),
    }
}

fn check_order(votes: &[Vote]) -> Result<(), PeakError> {
    let order = |vote: &Vote| (Reverse(vote.intensity), vote.heading, vote.y, vote.x);
    let mut neighbours = (1..).zip(votes.iter().zip(votes.iter().skip(1)));
    match neighbours.find(|(_, (previous, vote))| order(previous) >= order(vote)) {
        None => Ok(()),
        Some((index, (previous, vote))) => Err(PeakError::Votes(format!(
            "vote {index} is {vote:?}, after {previous:?}: intensities must fall, and equal ones \
             rise by heading, y and x"
        ))),
    }
}

#[cfg(test)]
mod tests {
    use messages::MapHeader;

    use super::*;
    use crate::testing::{room, vote, votes_header};

    fn maps() -> Maps {
        let mut maps = Maps::default();
        let map = MapHeader {
            map_id: 7,
            resolution_m: 0.1,
            ..room()
        };
        maps.receive(&map, &[0; 30 * 20]).unwrap();
        maps
    }

    fn votes() -> Vec<Vote> {
        vec![
            vote(29, 19, 359, 100),
            vote(3, 4, 5, 90),
            vote(4, 4, 5, 90),
            vote(0, 5, 5, 90),
            vote(0, 0, 6, 90),
        ]
    }

    fn header() -> VotesHeader {
        VotesHeader {
            certified_floor: 85,
            highest_possible: 200,
            known_heading: 0.5,
            ..votes_header()
        }
    }

    #[test]
    fn sound_votes_are_passed_on_without_a_copy() {
        let votes = votes();
        let maps = maps();
        let checked = check(&header(), &votes, &maps).unwrap().unwrap();
        assert_eq!(
            (checked.map.map_id, checked.beams),
            (7, BeamConfig::default())
        );
        let input = checked.input;
        assert!(std::ptr::eq(input.votes, &votes[..]));
        assert_eq!((input.certified_floor, input.highest_possible), (85, 200));
        assert_eq!((input.headings, input.known_heading), (360, None));
        assert_eq!(input.frame.resolution_m, 0.1);
        let known = VotesHeader {
            heading_known: 1,
            ..header()
        };
        let checked = check(&known, &votes, &maps).unwrap().unwrap();
        assert_eq!(checked.input.known_heading, Some(0.5));
    }

    #[test]
    fn what_contradicts_itself_is_refused() {
        let refuse = |change: fn(&mut VotesHeader, &mut Vec<Vote>), expected: &str| {
            let (mut header, mut votes) = (header(), votes());
            change(&mut header, &mut votes);
            let error = check(&header, &votes, &maps()).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
        };
        refuse(|header, _| header.outcome = 4, "outcome is 4");
        refuse(|header, _| header.map_id = 8, "they are of map");
        refuse(|header, _| header.headings = 0, "headings is 0");
        refuse(|header, _| header.headings = 65_537, "headings is");
        let not_a_number = |header: &mut VotesHeader, _: &mut Vec<Vote>| {
            header.heading_known = 1;
            header.known_heading = f64::NAN;
        };
        refuse(not_a_number, "known_heading is NaN");
        refuse(|header, _| header.max_beams = 1 << 17, "max_beams is");
        refuse(|header, _| header.pooling = 0, "pooling is 0");
        // Fifteen by ten cells were searched.
        let pooled = "vote 0 is for cell 29, 19 and heading 359: 15 x 10 cells";
        refuse(|header, _| header.pooling = 2, pooled);
        refuse(|header, _| header.beam_arc_m = f64::NAN, "beam_arc_m");
        refuse(|_, votes| votes.clear(), "best is 100 of 200 possible");
        refuse(|header, _| header.best = 99, "best is 99 of 200");
        refuse(|header, _| header.highest_possible = 99, "best is 100");
        let nothing = |header: &mut VotesHeader, votes: &mut Vec<Vote>| {
            header.best = 0;
            *votes = vec![vote(0, 0, 0, 0)];
        };
        refuse(nothing, "best is 0 of 200");
        refuse(|_, votes| votes[2].x = 30, "vote 2 is for cell 30, 4");
        refuse(|_, votes| votes[0].y = 20, "vote 0 is for cell 29, 20");
        refuse(|header, _| header.headings = 359, "vote 0 is for cell");
        refuse(|_, votes| votes.swap(1, 2), "vote 2 is Vote");
        refuse(|_, votes| votes[4].intensity = 91, "vote 4 is Vote");
        refuse(|_, votes| votes[2] = votes[1], "vote 2 is Vote");
    }

    #[test]
    fn a_mount_is_given_where_it_is_known_and_finite() {
        let mounted = |mount_known, yaw| {
            let base_from_laser = Pose::new(0.5, 0.0, yaw).into();
            mount(&VotesHeader {
                mount_known,
                base_from_laser,
                ..header()
            })
        };
        assert_eq!(mounted(1, 0.25).unwrap(), Some(Pose::new(0.5, 0.0, 0.25)));
        assert_eq!(mounted(0, f64::NAN).unwrap(), None);
        let error = mounted(1, f64::NAN).unwrap_err().to_string();
        assert!(error.starts_with("base_from_laser is x 0.5 m"), "{error}");
    }
}
