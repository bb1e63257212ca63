//! Turns a scan into the message that the graph's peak extractor would send. Pure.

use bytemuck::Zeroable;
use engine::EngineError;
use engine::Map;
use engine::grid::{CellRules, GridFrame};
pub use engine::localizer::Workspace;
use engine::localizer::{Localizer, PreparedMap, Settings};
use engine::peaks::{Place, Places, Target};
use engine::scan::Scan;
use map::OccupancyGrid;
use messages::{HypothesesHeader, Hypothesis, ScanHeader, searched_id};

#[derive(Debug)]
pub struct Locator {
    /// Ids and names of the maps, in the order of the set.
    maps: Vec<(u64, String)>,
    localizer: Localizer,
}

#[derive(Debug)]
pub struct SearchedMap {
    id: u64,
    name: String,
    prepared: PreparedMap,
}

/// Header and items of `hypotheses`, without the times of computing.
pub type Answer = (HypothesesHeader, Vec<Hypothesis>);

impl SearchedMap {
    /// Prepares the map, which takes milliseconds to seconds.
    pub fn new(
        name: String,
        map: &OccupancyGrid,
        rules: CellRules,
        settings: Settings,
    ) -> Result<Self, EngineError> {
        let view = Map {
            frame: GridFrame::new(map.resolution_m, map.map_from_grid),
            sides: (map.width as usize, map.height as usize),
            occupancy: &map.cells,
            rules,
        };
        Ok(SearchedMap {
            id: map.id(),
            name,
            prepared: PreparedMap::new(view, settings)?,
        })
    }
}

impl Locator {
    pub fn of_set(maps: Vec<SearchedMap>) -> Result<Self, EngineError> {
        let (ids, prepared) = maps
            .into_iter()
            .map(|map| ((map.id, map.name), map.prepared))
            .unzip();
        Ok(Locator {
            maps: ids,
            localizer: Localizer::of_maps(prepared)?,
        })
    }

    /// Returns the id of the map; for several maps an id that depends on the maps and their order.
    pub fn map_id(&self) -> u64 {
        searched_id(self.maps.iter().map(|&(id, _)| id))
    }

    /// Returns the name of a map if there are several maps.
    pub fn name_of(&self, map_id: u64) -> Option<&str> {
        let mut maps = self.maps.iter().filter(|_| self.maps.len() > 1);
        let found = maps.find(|&&(id, _)| id == map_id);
        found.map(|(_, name)| name.as_str())
    }

    /// Finds the places of a scan; `None` if `stop` interrupted the search.
    pub fn locate(
        &self,
        workspace: &mut Workspace,
        scan: (&ScanHeader, &[f32]),
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Answer>, EngineError> {
        let seen = Scan::of(scan.0, scan.1);
        let localizer = &self.localizer;
        let found = localizer.locate_unless(workspace, &seen, None, stop)?;
        Ok(found.map(|found| {
            let outcome = found.outcome;
            let votes = (outcome.found.best.into(), outcome.highest_possible);
            described(scan.0, &self.maps, votes, found.places)
        }))
    }
}

fn described(
    scan: &ScanHeader,
    maps: &[(u64, String)],
    (best, highest_possible): (u32, u32),
    places: &Places,
) -> Answer {
    let mount_known = scan.mount_known == 1;
    let id_of = |place: &Place| maps[place.map as usize].0;
    let target = Target::of(mount_known.then(|| scan.base_from_laser.into()), false);
    let header = HypothesesHeader {
        stamp: scan.stamp,
        map_id: places.places.first().map_or(maps[0].0, id_of),
        verdict: places.verdict as u32,
        alternatives: places.alternatives,
        confidence: places.confidence as f32,
        inlier_share: places.inlier_share as f32,
        best,
        highest_possible,
        mount_known: mount_known.into(),
        searched: searched_id(maps.iter().map(|&(id, _)| id)),
        ..HypothesesHeader::zeroed()
    };
    let places = places.places.iter();
    let hypotheses = places.map(|place| place.hypothesis(id_of(place), target));
    (header, hypotheses.collect())
}
