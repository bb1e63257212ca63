//! Maps in the form that the tracker uses.

use engine::EngineError;
use engine::beams::BeamConfig;
use engine::fit::{DistanceField, Ends, FitConfig};
use engine::grid::{CellRules, GridFrame};
use engine::observation::Observation;
use engine::space::{self, Space};
use engine::tracking::Seen;
use messages::{MapHeader, MapName, MapSet, Transition, searched_id};

/// Headings per turn for which beams are selected, as in the search by default.
const HEADINGS: u32 = 360;

struct World {
    map_id: u64,
    /// Name of the map in its set; empty for a map that is served alone.
    name: MapName,
    distance_field: DistanceField,
    space: Space,
    /// End points of the last scan's beams, in cells.
    ends: Ends,
}

/// Maps on which the robot may be, indexed by number: one map, or those of a set.
#[derive(Default)]
pub(crate) struct Worlds {
    maps: Vec<World>,
    pub(crate) transitions: Vec<Transition>,
}

impl World {
    /// Prepares a map; beams count up to `reach_m` metres if that exceeds the map's own length.
    fn new(header: &MapHeader, occupancy: &[u8], reach_m: f64) -> Result<Self, EngineError> {
        let (frame, rules) = (GridFrame::of(header)?, CellRules::of(header)?);
        let (width, height) = (header.width as usize, header.height as usize);
        Ok(World {
            map_id: header.map_id,
            name: header.name,
            distance_field: DistanceField::new(frame, (width, height), occupancy, rules)?,
            space: Space::new(HEADINGS, frame.resolution_m, width, height)?.reaching(reach_m),
            ends: Ends::default(),
        })
    }
}

impl Worlds {
    pub(crate) fn of_map(header: &MapHeader, occupancy: &[u8]) -> Result<Self, EngineError> {
        Ok(Worlds {
            maps: vec![World::new(header, occupancy, 0.0)?],
            transitions: Vec::new(),
        })
    }

    pub(crate) fn of_set(set: &MapSet<'_>) -> Result<Self, (u64, EngineError)> {
        let reach_m = space::reach_m(set.maps.iter().map(|(header, _)| header));
        let maps = set.maps.iter().map(|(header, occupancy)| {
            World::new(header, occupancy, reach_m).map_err(|error| (header.map_id, error))
        });
        Ok(Worlds {
            maps: maps.collect::<Result<_, _>>()?,
            transitions: set.transitions.clone(),
        })
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.maps.is_empty()
    }

    /// Returns the id of the map with this number; 0 if there is none.
    pub(crate) fn map_id(&self, number: u32) -> u64 {
        let map = self.maps.get(number as usize);
        map.map_or(0, |map| map.map_id)
    }

    pub(crate) fn name(&self, number: u32) -> MapName {
        let map = self.maps.get(number as usize);
        map.map_or(MapName::new(""), |map| map.name)
    }

    pub(crate) fn searched(&self) -> u64 {
        searched_id(self.maps.iter().map(|map| map.map_id))
    }

    pub(crate) fn number(&self, map_id: u64) -> Option<u32> {
        let number = self.maps.iter().position(|map| map.map_id == map_id);
        number.map(|number| number as u32)
    }

    /// Returns the number of the map with this name, which is unique and kept by edits.
    pub(crate) fn number_of_name(&self, name: MapName) -> Option<u32> {
        let number = self.maps.iter().position(|map| map.name == name);
        number.map(|number| number as u32)
    }

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

    /// Returns the scan on each map; the beams are the same on all.
    pub(crate) fn seen<'a>(&'a self, fit: &'a FitConfig) -> Vec<Seen<'a>> {
        let seen = self.maps.iter().map(|map| Seen {
            distance_field: &map.distance_field,
            ends: &map.ends,
            fit,
        });
        seen.collect()
    }
}

#[cfg(test)]
mod tests {
    use engine::fit::GridPose;
    use engine::scan::Scan;

    use super::*;

    /// Returns a bare square room with cells of 0.1 m.
    fn room(side: u32) -> (MapHeader, Vec<u8>) {
        let is_wall = |i: u32| i == 0 || i == side - 1;
        let cells =
            (0..side * side).map(|i| 100 * u8::from(is_wall(i % side) || is_wall(i / side)));
        let cells: Vec<u8> = cells.collect();
        let mut header = MapHeader {
            width: side,
            height: side,
            resolution_m: 0.1,
            ..MapHeader::default()
        };
        header.map_id = header.id_of(&cells);
        (header, cells)
    }

    #[test]
    fn readings_that_a_map_is_too_small_for_count_on_it() {
        let (small, large) = (room(40), room(400));
        let set = MapSet {
            maps: vec![(small.0, &small.1[..]), (large.0, &large.1)],
            transitions: Vec::new(),
        };
        let mut worlds = Worlds::of_set(&set).unwrap();
        let ranges = [15.0; 30];
        let scan = Scan {
            angle_min: -0.3,
            angle_increment: 0.02,
            range_min_m: 0.1,
            range_max_m: 40.0,
            ranges: &ranges,
        };
        worlds
            .find_ends((&scan).into(), &BeamConfig::default())
            .unwrap();
        let fit = FitConfig::default();
        let seen = worlds.seen(&fit);
        assert_eq!(
            seen[0].ends.beams(),
            30,
            "by the first map scans are judged blank"
        );
        assert_eq!(seen[1].ends.beams(), 30);
        let score = |map: usize, x: f64| {
            let (at, y) = (&seen[map], 20.5);
            let pose = GridPose { x, y, heading: 0.0 };
            at.distance_field.score(at.ends, pose, &fit)
        };
        assert!(score(0, 20.5) < 0.1, "{}", score(0, 20.5));
        assert!(score(1, 249.5) > 0.3, "{}", score(1, 249.5));
    }
}
