//! The node's heart: from a scan to the message that the graph's peak extractor would
//! send. Pure: no socket, no clock, no file.

use bytemuck::Zeroable;
use engine::EngineError;
use engine::grid::{CellRules, GridFrame};
use engine::localizer::{Prior, Together};
use engine::locator::{LocatorConfig, OccupancyView};
pub use engine::map_set::Workspace;
use engine::map_set::{Located, MapSet};
use engine::peaks::{Place, Places, Target};
use engine::scan::Scan;
use engine::search::Lead;
use map::OccupancyGrid;
use messages::{HypothesesHeader, Hypothesis, ScanHeader, searched_id};

use crate::shard::{Part, Shard};

/// A map, or several, ready to be searched by any number of threads.
#[derive(Debug)]
pub struct Locator {
    /// Ids and names, in the order of the set.
    maps: Vec<(u64, String)>,
    /// Their numbers and ids in the whole set.
    held: Vec<(u32, u64)>,
    /// Which part of the set it is, and the names of all maps of that.
    part_of: (Shard, Vec<String>),
    set: MapSet,
}

/// A map of a set, ready to be searched.
#[derive(Debug)]
pub struct SearchedMap {
    id: u64,
    number: u32,
    name: String,
    locator: engine::locator::Locator,
}

/// Header and items of `hypotheses`, all but the times of computing.
pub type Answer = (HypothesesHeader, Vec<Hypothesis>);

impl SearchedMap {
    /// Prepares the map of this number and name in the whole set, which takes from
    /// milliseconds to seconds.
    ///
    /// # Errors
    /// If the map has no occupied or no free cell, or a setting is out of range.
    pub fn new(
        (number, name): (u32, String),
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
        Ok(SearchedMap {
            id: map.id(),
            number,
            name,
            locator: engine::locator::Locator::new(view, config, Prior::None)?,
        })
    }
}

impl Locator {
    /// Prepares one map.
    ///
    /// # Errors
    /// As [`SearchedMap::new`].
    pub fn new(
        map: &OccupancyGrid,
        rules: CellRules,
        config: LocatorConfig,
    ) -> Result<Self, EngineError> {
        let map = SearchedMap::new((0, String::new()), map, rules, config)?;
        Ok(Locator::of_set(
            vec![map],
            (Shard::WHOLE, vec![String::new()]),
            0.0,
        ))
    }

    /// Searches maps together, of which there is at least one. They are that part of a set
    /// whose maps have these names, and of which the maps of other shards have diagonals of so
    /// many metres at most.
    #[must_use]
    pub fn of_set(
        maps: Vec<SearchedMap>,
        part_of: (Shard, Vec<String>),
        others_reach_m: f64,
    ) -> Self {
        let held = maps.iter().map(|map| (map.number, map.id)).collect();
        let (ids, locators): (_, Vec<_>) = maps
            .into_iter()
            .map(|map| ((map.id, map.name), map.locator))
            .unzip();
        Locator {
            maps: ids,
            held,
            part_of,
            set: MapSet::part(locators, others_reach_m),
        }
    }

    /// The id of the map; of several, a number that differs where one of them or their order
    /// does.
    #[must_use]
    pub fn map_id(&self) -> u64 {
        searched_id(self.maps.iter().map(|&(id, _)| id))
    }

    /// The name of a map, where there are several.
    #[must_use]
    pub fn name_of(&self, map_id: u64) -> Option<&str> {
        let mut maps = self.maps.iter().filter(|_| self.maps.len() > 1);
        let found = maps.find(|&&(id, _)| id == map_id);
        found.map(|(_, name)| name.as_str())
    }

    /// Finds the places of a scan; `None` if `stop` said so before it was done.
    ///
    /// # Errors
    /// If the engine refuses the scan.
    pub fn locate(
        &self,
        workspace: &mut Workspace,
        scan: (&ScanHeader, &[f32]),
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Answer>, EngineError> {
        let found = self.search(workspace, scan, stop)?;
        Ok(found.map(|found| {
            let outcome = found.outcome;
            let votes = (outcome.found.best.into(), outcome.highest_possible);
            described(scan.0, &self.maps, votes, found.places)
        }))
    }

    /// The same as it is merged with what others find on other maps of the set, while it is known
    /// what the best pose of all has.
    ///
    /// # Errors
    /// As [`Locator::locate`].
    pub fn locate_part(
        &self,
        workspace: &mut Workspace,
        (header, ranges): (&ScanHeader, &[f32]),
        lead: &Lead,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Part>, EngineError> {
        let together = Together {
            lead: Some(lead),
            ..Together::default()
        };
        let scan = Scan::of(header, ranges);
        let found = self.set.locate_beside(workspace, &scan, together, stop)?;
        // After the search: it was beside no better pose than that.
        let how = (self.set.locators()[0].peaks().score, lead.share());
        Ok(found.map(|found| Part::new(self.part_of.clone(), &self.held, &found, how)))
    }

    fn search<'w>(
        &self,
        workspace: &'w mut Workspace,
        (header, ranges): (&ScanHeader, &[f32]),
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Located<'w>>, EngineError> {
        let scan = Scan::of(header, ranges);
        self.set.locate_unless(workspace, &scan, None, stop)
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
