//! Core of the node: turns a message of `votes` into one of `hypotheses`.

mod beams;
mod together;

use bytemuck::Zeroable;
use engine::EngineError;
use engine::fit::Ends;
use engine::grid::GridFrame;
use engine::peaks::{self, Judged, Merged, PeakConfig, Place, Places, Target};
use engine::space::Space;
use geometry::Pose;
use messages::{
    Beam, BeamsHeader, HypothesesHeader, Hypothesis, SearchOutcome, Verdict, Vote, VotesHeader,
};

use crate::PeakError;
use crate::check::{Checked, check, mount};
use crate::maps::Maps;
use crate::scans::Scans;
use beams::judged;

/// Buffers for answering, reused from scan to scan. It may serve any maps.
#[derive(Debug, Default)]
pub struct Workspace {
    maps: Vec<OnMap>,
    map_ids: Vec<u64>,
    merged: Merged,
    beams: Vec<Beam>,
}

#[derive(Debug, Default)]
struct OnMap {
    peaks: peaks::Workspace,
    space: Option<(Extent, Space)>,
}

/// Headings per turn, side of a cell and reach in metres, number of cells along x and y.
type Extent = (u32, (f64, f64), usize, usize);

#[derive(Debug, Clone, PartialEq)]
pub struct Answer<'a> {
    /// Header of `hypotheses`, without the times of extracting and sending.
    pub header: HypothesesHeader,
    /// Places, best first.
    pub places: &'a [Place],
    /// Ids of the maps, indexed by the map numbers of places.
    pub map_ids: &'a [u64],
    pub beams_header: BeamsHeader,
    pub beams: &'a [Beam],
    pub target: Target,
    /// Grid frame of the best place's map; `None` if there is no result.
    pub frame: Option<GridFrame>,
}

/// Finds the places of a scan from its votes; on an error, [`nothing`] is to be sent.
pub fn answer<'w>(
    header: &VotesHeader,
    votes: &[Vote],
    (maps, scans): (&Maps, &Scans),
    config: &PeakConfig,
    workspace: &'w mut Workspace,
) -> Result<Answer<'w>, PeakError> {
    if header.maps > 0 {
        return together::on_several(header, votes, (maps, scans), config, workspace);
    }
    let Some(checked) = check(header, votes, maps)? else {
        let mut answer = nothing(header);
        if header.outcome == SearchOutcome::NoVotes as u32 {
            answer.header.searched = header.searched;
        }
        return Ok(answer);
    };
    let base_from_laser = mount(header)?;
    workspace.maps.resize_with(1, OnMap::default);
    workspace.map_ids.clear();
    workspace.map_ids.push(header.map_id);
    let Workspace {
        maps,
        map_ids,
        beams,
        ..
    } = workspace;
    let Judged { places, ends, .. } = maps[0].judge(header, &checked, scans, config)?;
    beams.clear();
    beams.extend(judged(ends, places));
    let frame = checked.map.frame;
    Ok(said(
        header,
        places,
        (map_ids, beams),
        (base_from_laser, frame),
    ))
}

fn said<'w>(
    header: &VotesHeader,
    places: &'w Places,
    (map_ids, beams): (&'w [u64], &'w [Beam]),
    (base_from_laser, frame): (Option<Pose>, GridFrame),
) -> Answer<'w> {
    let best = places.places.first();
    Answer {
        header: described(header, places, base_from_laser.is_some()),
        beams_header: BeamsHeader {
            stamp: header.stamp,
            map_id: header.map_id,
            map_from_laser: best
                .map_or(Pose::IDENTITY, |best| best.map_from_laser)
                .into(),
        },
        beams,
        places: &places.places,
        map_ids,
        target: Target::of(base_from_laser, header.lasers_used > 0),
        frame: Some(frame),
    }
}

impl OnMap {
    fn judge(
        &mut self,
        header: &VotesHeader,
        Checked { input, map, beams }: &Checked<'_>,
        scans: &Scans,
        config: &PeakConfig,
    ) -> Result<Judged<'_>, PeakError> {
        let space = &mut self.space;
        let take = |ends: &mut Ends| -> Result<(), PeakError> {
            let resolution_m = map.frame.resolution_m;
            if header.has_readings == 1 {
                return Ok(ends.take(scans.readings(header.stamp)?, resolution_m)?);
            }
            let scan = scans.get(header.stamp)?;
            let sides = (map.width as usize, map.height as usize);
            let lengths_m = (resolution_m, map.reach_m);
            let extent = (header.headings, lengths_m, sides.0, sides.1);
            Ok(ends.find(&scan, kept_or_made(space, extent)?, beams)?)
        };
        self.peaks.judge(input, &map.distance_field, config, take)
    }
}

/// Returns the space of the previous scan if it fits, else creates a new one.
fn kept_or_made(kept: &mut Option<(Extent, Space)>, extent: Extent) -> Result<&Space, EngineError> {
    if kept.as_ref().is_none_or(|(of, _)| *of != extent) {
        let (headings, (resolution_m, reach_m), width, height) = extent;
        let made = Space::new(headings, resolution_m, width, height)?.reaching(reach_m);
        *kept = Some((extent, made));
    }
    let (_, space) = kept.as_ref().expect("it was made");
    Ok(space)
}

/// Returns the answer to votes that are empty or rejected: it counts as no search.
pub fn nothing(votes: &VotesHeader) -> Answer<'static> {
    let header = HypothesesHeader {
        stamp: votes.stamp,
        map_id: votes.map_id,
        search_ns: votes.engine_ns,
        verdict: Verdict::NoScan as u32,
        ..HypothesesHeader::zeroed()
    };
    Answer {
        header,
        places: &[],
        map_ids: &[],
        beams_header: BeamsHeader {
            stamp: votes.stamp,
            map_id: votes.map_id,
            map_from_laser: Pose::IDENTITY.into(),
        },
        beams: &[],
        target: Target::of(None, false),
        frame: None,
    }
}

impl Answer<'_> {
    pub fn hypotheses(&self) -> impl ExactSizeIterator<Item = Hypothesis> {
        let (map_ids, target) = (self.map_ids, self.target);
        let places = self.places.iter();
        places.map(move |place| place.hypothesis(map_ids[place.map as usize], target))
    }
}

fn described(votes: &VotesHeader, places: &Places, mount_known: bool) -> HypothesesHeader {
    HypothesesHeader {
        verdict: places.verdict as u32,
        alternatives: places.alternatives,
        confidence: places.confidence as f32,
        inlier_share: places.inlier_share as f32,
        best: votes.best,
        highest_possible: votes.highest_possible,
        mount_known: mount_known.into(),
        searched: votes.searched,
        ..nothing(votes).header
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use messages::{MapHeader, ScanHeader};

    use super::*;
    use crate::testing::{cells, room, scans, vote, votes_header};

    /// Returns a map with these cells, rotated by 90°: grid x is map y, grid y is -x.
    fn maps(cells: &[u8]) -> Maps {
        let mut maps = Maps::default();
        let map = MapHeader {
            map_id: 7,
            map_from_grid: Pose::new(0.0, 0.0, FRAC_PI_2).into(),
            ..room()
        };
        maps.receive(&map, cells).unwrap();
        maps
    }

    fn header() -> VotesHeader {
        VotesHeader {
            engine_ns: 1234,
            certified_floor: 60,
            base_from_laser: Pose::new(0.75, 0.0, 0.0).into(),
            mount_known: 1,
            searched: 9,
            ..votes_header()
        }
    }

    /// Two places, one ahead of the other by a third.
    fn votes() -> [Vote; 2] {
        [vote(10, 5, 0, 100), vote(20, 5, 90, 75)]
    }

    fn extract<'w>(header: &VotesHeader, workspace: &'w mut Workspace) -> Answer<'w> {
        let known = (&maps(&cells()), &scans(header.stamp));
        answer(header, &votes(), known, &PeakConfig::default(), workspace).unwrap()
    }

    #[test]
    fn without_a_mount_the_base_is_the_laser() {
        let unknown = VotesHeader {
            mount_known: 0,
            ..header()
        };
        let mut workspace = Workspace::default();
        let answer = extract(&unknown, &mut workspace);
        assert_eq!(answer.header.mount_known, 0);
        for hypothesis in answer.hypotheses() {
            let laser = Pose::from(hypothesis.map_from_laser);
            let base = Pose::from(hypothesis.map_from_base);
            assert!(base.is_within(laser, 1e-12, 1e-12));
        }
    }

    #[test]
    fn the_fit_needs_the_scan_of_the_votes() {
        let mut scans = Scans::default();
        let config = PeakConfig::default();
        let mut workspace = Workspace::default();
        let known = (&maps(&[0; 30 * 20]), &scans);
        let unknown = answer(&header(), &votes(), known, &config, &mut workspace);
        assert!(matches!(unknown, Err(PeakError::UnknownScan)));
        let scan = ScanHeader {
            stamp: header().stamp,
            angle_increment: 0.1,
            range_max_m: 30.0,
            ..Zeroable::zeroed()
        };
        scans.receive(&scan, &[1.0, 2.0]);
        let known = (&maps(&[0; 30 * 20]), &scans);
        let said = answer(&header(), &votes(), known, &config, &mut workspace).unwrap();
        // The map is empty, so nothing fits.
        assert_eq!(said.header.verdict, Verdict::PoorFit as u32);
        let hypotheses: Vec<Hypothesis> = said.hypotheses().collect();
        assert_eq!((hypotheses.len(), hypotheses[0].score), (2, 0.0));
        assert!(hypotheses[0].probability < 0.01, "{hypotheses:?}");
    }

    #[test]
    fn scans_without_votes_need_no_map_and_have_no_hypotheses() {
        for (outcome, searched) in [(SearchOutcome::NoVotes, 9), (SearchOutcome::Refused, 0)] {
            let empty = VotesHeader {
                outcome: outcome as u32,
                best: 0,
                ..header()
            };
            let known = (&Maps::default(), &Scans::default());
            let (config, mut workspace) = (PeakConfig::default(), Workspace::default());
            let said = answer(&empty, &[], known, &config, &mut workspace).unwrap();
            let mut expected = nothing(&empty);
            expected.header.searched = searched;
            assert_eq!(said, expected);
            assert_eq!(said.header.verdict, Verdict::NoScan as u32);
            assert_eq!(
                (said.header.stamp, said.header.search_ns),
                (header().stamp, 1234)
            );
            assert_eq!(said.hypotheses().len(), 0);
        }
    }
}
