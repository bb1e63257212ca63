//! The node's heart: from a scan to the message that the graph's peak extractor would
//! send. Pure: no socket, no clock, no file.

use bytemuck::Zeroable;
use engine::EngineError;
use engine::grid::{CellRules, GridFrame};
use engine::localizer::Prior;
pub use engine::locator::Workspace;
use engine::locator::{LocatorConfig, OccupancyView};
use engine::peaks::{Places, Target};
use engine::scan::Scan;
use map::OccupancyGrid;
use messages::{HypothesesHeader, Hypothesis, ScanHeader};

/// A map that is ready to be searched, by any number of threads.
#[derive(Debug)]
pub struct Locator {
    map_id: u64,
    engine: engine::locator::Locator,
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
        config: LocatorConfig,
    ) -> Result<Self, EngineError> {
        let view = OccupancyView {
            frame: GridFrame {
                resolution_m: map.resolution_m,
                map_from_grid: map.map_from_grid,
            },
            sides: (map.width as usize, map.height as usize),
            occupancy: &map.cells,
            rules,
        };
        Ok(Locator {
            map_id: map.id(),
            engine: engine::locator::Locator::new(view, config, Prior::None)?,
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
        let scan = Scan::of(header, ranges);
        let found = self.engine.locate_unless(workspace, &scan, None, stop)?;
        Ok(found.map(|found| {
            let outcome = found.outcome;
            let votes = (outcome.found.best.into(), outcome.highest_possible);
            described(header, self.map_id, votes, found.places)
        }))
    }
}

fn described(
    scan: &ScanHeader,
    map_id: u64,
    (best, highest_possible): (u32, u32),
    places: &Places,
) -> Answer {
    let mount_known = scan.mount_known == 1;
    let target = Target::of(mount_known.then(|| scan.base_from_laser.into()), false);
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
    let hypotheses = places.map(|place| place.hypothesis(map_id, target));
    (header, hypotheses.collect())
}
