//! The node's heart: from a scan to its places on one map. Pure: no socket, no
//! clock, no file.
//!
//! It does what the graph's accumulator and peak extractor do, with the same
//! engine and the same settings, and answers as they would.

use bytemuck::Zeroable;
use engine::EngineError;
use engine::beams::BeamConfig;
use engine::fit::{Ends, Terrain};
use engine::grid::{CellRules, GridFrame};
use engine::localizer::{self, Localizer, LocalizerConfig, Prior};
use engine::peaks::{self, PeakConfig, PeakInput, Places, Score, Sought};
use engine::scan::Scan;
use engine::space::Space;
use map::OccupancyGrid;
use messages::{HypothesesHeader, Hypothesis, ScanHeader};

/// A map that is ready to be searched, by any number of threads.
#[derive(Debug)]
pub struct Locator {
    map_id: u64,
    localizer: Localizer,
    terrain: Terrain,
    space: Space,
    beams: BeamConfig,
    peaks: PeakConfig,
}

/// What locating takes, kept from scan to scan by each thread.
#[derive(Debug, Default)]
pub struct Workspace {
    localizer: localizer::Workspace,
    ends: Ends,
    peaks: peaks::Workspace,
}

/// Header and items of `hypotheses`, all but the times of computing.
pub type Answer = (HypothesesHeader, Vec<Hypothesis>);

impl Locator {
    /// Prepares a map, which takes from milliseconds to seconds.
    ///
    /// # Errors
    /// If the map has no occupied or no free cell, or a setting is out of range.
    pub fn new(
        map: &OccupancyGrid,
        rules: CellRules,
        config: &LocalizerConfig,
        peaks: PeakConfig,
    ) -> Result<Self, EngineError> {
        let frame = GridFrame {
            resolution_m: map.resolution_m,
            map_from_grid: map.map_from_grid,
        };
        let sides = (map.width as usize, map.height as usize);
        let (cells, headings) = (&map.cells, config.headings);
        Ok(Locator {
            map_id: map.id(),
            terrain: Terrain::new(frame, sides, cells, rules)?,
            space: Space::new(headings, frame.resolution_m, sides.0, sides.1)?,
            beams: config.votes.beams,
            localizer: Localizer::of_map(frame, sides, cells, rules, config.clone(), Prior::None)?,
            peaks,
        })
    }

    /// The id of the map.
    #[must_use]
    pub fn map_id(&self) -> u64 {
        self.map_id
    }

    /// Finds the places of a scan; `None` if `stop` said so before it was done.
    ///
    /// # Errors
    /// If the engine refuses the scan.
    pub fn locate(
        &self,
        workspace: &mut Workspace,
        (header, ranges): (&ScanHeader, &[f32]),
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Answer>, EngineError> {
        let Workspace {
            localizer,
            ends,
            peaks,
        } = workspace;
        let scan = Scan::of(header, ranges);
        let Some(outcome) = self.localizer.search_in(localizer, &scan, stop)? else {
            return Ok(None);
        };
        let input = PeakInput::of(outcome, self.localizer.frame());
        let places = match self.peaks.score {
            Score::Votes => peaks.by_votes(&input, &self.peaks),
            Score::Fit => {
                ends.find(&scan, &self.space, &self.beams)?;
                peaks.by_fit(&input, (&self.terrain, ends), &self.peaks)
            }
        };
        let (best, highest) = (outcome.found.best.into(), outcome.highest_possible);
        Ok(Some(described(
            header,
            self.map_id,
            (best, highest),
            places,
        )))
    }
}

fn described(
    scan: &ScanHeader,
    map_id: u64,
    (best, highest_possible): (u32, u32),
    places: &Places,
) -> Answer {
    let mount_known = scan.mount_known == 1;
    let sought = Sought::of(mount_known.then(|| scan.base_from_laser.into()), false);
    let header = HypothesesHeader {
        stamp: scan.stamp,
        map_id,
        verdict: places.verdict as u32,
        alternatives: places.alternatives,
        confidence: places.confidence as f32,
        inlier_share: places.inlier_share as f32,
        best,
        highest_possible,
        mount_known: mount_known.into(),
        ..HypothesesHeader::zeroed()
    };
    let places = places.places.iter();
    let hypotheses = places.map(|place| place.hypothesis(map_id, sought));
    (header, hypotheses.collect())
}
