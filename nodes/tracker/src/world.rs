//! The maps as the tracker reads them.

use engine::EngineError;
use engine::beams::BeamConfig;
use engine::fit::{DistanceField, Ends, FitConfig};
use engine::grid::{CellRules, GridFrame};
use engine::observation::Observation;
use engine::space::Space;
use engine::tracking::Seen;
use messages::{MapHeader, MapName, MapSet, Transition, searched_id};

/// Headings a turn that scans are thinned for, as the search does by default.
const HEADINGS: u32 = 360;

/// A map, ready for the fit of scans.
struct World {
    /// Its id in messages.
    map_id: u64,
    /// What it is called in its set; empty of one that is served alone.
    name: MapName,
    /// Distances to obstacles.
    distance_field: DistanceField,
    /// What scans are thinned for.
    space: Space,
    /// Where the beams of the last scan end, in cells.
    ends: Ends,
}

/// The maps on which the robot may be, by their numbers: one, or those of a set.
#[derive(Default)]
pub(crate) struct Worlds {
    maps: Vec<World>,
    /// Between them.
    pub(crate) transitions: Vec<Transition>,
}

impl World {
    fn new(header: &MapHeader, occupancy: &[u8]) -> Result<Self, EngineError> {
        let (frame, rules) = (GridFrame::of(header)?, CellRules::of(header)?);
        let (width, height) = (header.width as usize, header.height as usize);
        Ok(World {
            map_id: header.map_id,
            name: header.name,
            distance_field: DistanceField::new(frame, (width, height), occupancy, rules)?,
            space: Space::new(HEADINGS, frame.resolution_m, width, height)?,
            ends: Ends::default(),
        })
    }
}

impl Worlds {
    /// Prepares one map.
    ///
    /// # Errors
    /// If the grid's sides, resolution, origin or rules are out of range, or the number of
    /// cells is not what the sides say.
    pub(crate) fn of_map(header: &MapHeader, occupancy: &[u8]) -> Result<Self, EngineError> {
        Ok(Worlds {
            maps: vec![World::new(header, occupancy)?],
            transitions: Vec::new(),
        })
    }

    /// Prepares all maps of a set.
    ///
    /// # Errors
    /// As of one map; with its id.
    pub(crate) fn of_set(set: &MapSet<'_>) -> Result<Self, (u64, EngineError)> {
        let maps = set.maps.iter().map(|(header, occupancy)| {
            World::new(header, occupancy).map_err(|error| (header.map_id, error))
        });
        Ok(Worlds {
            maps: maps.collect::<Result<_, _>>()?,
            transitions: set.transitions.clone(),
        })
    }

    /// Whether there is no map yet.
    pub(crate) fn is_empty(&self) -> bool {
        self.maps.is_empty()
    }

    /// The id of the map with a number; 0 where there is none.
    pub(crate) fn map_id(&self, number: u32) -> u64 {
        let map = self.maps.get(number as usize);
        map.map_or(0, |map| map.map_id)
    }

    /// What the map with a number is called.
    pub(crate) fn name(&self, number: u32) -> MapName {
        let map = self.maps.get(number as usize);
        map.map_or(MapName::new(""), |map| map.name)
    }

    /// What a search on all of them has for its id.
    pub(crate) fn searched(&self) -> u64 {
        searched_id(self.maps.iter().map(|map| map.map_id))
    }

    /// The number of the map with an id.
    pub(crate) fn number(&self, map_id: u64) -> Option<u32> {
        let number = self.maps.iter().position(|map| map.map_id == map_id);
        number.map(|number| number as u32)
    }

    /// The number of the map that is called so: in a set each name is of one map, which keeps
    /// it when it is edited.
    pub(crate) fn number_of_name(&self, name: MapName) -> Option<u32> {
        let number = self.maps.iter().position(|map| map.name == name);
        number.map(|number| number as u32)
    }

    /// Finds where the beams of a scan end.
    ///
    /// # Errors
    /// If the scan is refused; the one before stays.
    pub(crate) fn find_ends(
        &mut self,
        scan: Observation<'_>,
        beams: &BeamConfig,
    ) -> Result<(), EngineError> {
        for map in &mut self.maps {
            map.ends.find(scan, &map.space, beams)?;
        }
        Ok(())
    }

    /// The scan on each map.
    pub(crate) fn seen<'a>(&'a self, fit: &'a FitConfig) -> Vec<Seen<'a>> {
        let seen = self.maps.iter().map(|map| Seen {
            distance_field: &map.distance_field,
            ends: &map.ends,
            fit,
        });
        seen.collect()
    }
}
