//! Last two maps, or sets, ready for the fit of scans, as votes in transit are of the old one.

use engine::EngineError;
use engine::fit::DistanceField;
use engine::grid::{CellRules, GridFrame};
use engine::space;
use messages::{MapHeader, MapSet};

use crate::PeakError;

#[derive(Debug, Clone)]
pub struct Map {
    pub map_id: u64,
    pub width: u32,
    pub height: u32,
    pub frame: GridFrame,
    /// Distances to obstacles, according to the map's cell rules.
    pub distance_field: DistanceField,
    /// Length up to which beams count, metres, if it exceeds the map's own.
    pub reach_m: f64,
}

#[derive(Debug, Clone, Default)]
pub struct Maps {
    known: Vec<Vec<Map>>,
}

impl Map {
    fn new(header: &MapHeader, occupancy: &[u8], reach_m: f64) -> Result<Self, EngineError> {
        let frame = GridFrame::of(header)?;
        let sides = (header.width as usize, header.height as usize);
        Ok(Map {
            map_id: header.map_id,
            width: header.width,
            height: header.height,
            frame,
            distance_field: DistanceField::new(frame, sides, occupancy, CellRules::of(header)?)?,
            reach_m,
        })
    }
}

impl Maps {
    /// Stores a map that is searched alone; a rejected one changes nothing.
    pub fn receive(&mut self, header: &MapHeader, occupancy: &[u8]) -> Result<(), EngineError> {
        self.replace(vec![Map::new(header, occupancy, 0.0)?]);
        Ok(())
    }

    /// Stores maps that are searched together; if one is rejected, nothing changes.
    pub fn receive_set(&mut self, set: &MapSet<'_>) -> Result<(), EngineError> {
        let reach_m = space::reach_m(set.maps.iter().map(|(header, _)| header));
        let maps = set.maps.iter();
        let maps = maps.map(|(header, occupancy)| Map::new(header, occupancy, reach_m));
        self.replace(maps.collect::<Result<_, _>>()?);
        Ok(())
    }

    fn replace(&mut self, maps: Vec<Map>) {
        let ids = |maps: &[Map]| maps.iter().map(|map| map.map_id).collect::<Vec<_>>();
        self.known.retain(|known| ids(known) != ids(&maps));
        self.known.truncate(1);
        self.known.insert(0, maps);
    }

    pub fn get(&self, map_id: u64) -> Result<&Map, PeakError> {
        let found = self.known.iter().flatten().find(|map| map.map_id == map_id);
        found.ok_or_else(|| PeakError::UnknownMap {
            found: map_id,
            known: self.names(),
        })
    }

    fn names(&self) -> String {
        let known = self.known.iter().flatten();
        let names: Vec<String> = known.map(|map| format!("{:016x}", map.map_id)).collect();
        if names.is_empty() {
            return "none".into();
        }
        names.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use geometry::Pose;
    use messages::Pose2;

    use super::*;

    const CELLS: [u8; 30 * 20] = [0; 30 * 20];

    fn map(map_id: u64) -> MapHeader {
        MapHeader {
            map_id,
            width: 30,
            height: 20,
            resolution_m: 0.05,
            map_from_grid: Pose2::new(-1.0, 2.0, 0.5),
            ..MapHeader::default()
        }
    }

    #[test]
    fn the_last_two_maps_are_known() {
        let mut maps = Maps::default();
        for map_id in [1, 2, 3] {
            maps.receive(&map(map_id), &CELLS).unwrap();
        }
        let found = maps.get(2).unwrap();
        assert_eq!((found.map_id, found.width, found.height), (2, 30, 20));
        assert_eq!(found.frame.map_from_grid, Pose::new(-1.0, 2.0, 0.5));
        assert_eq!(maps.get(3).unwrap().map_id, 3);
        let error = maps.get(1).unwrap_err().to_string();
        assert!(error.contains("map 0000000000000001"), "{error}");
        let known = "before: 0000000000000003, 0000000000000002";
        assert!(error.ends_with(known), "{error}");
    }

    #[test]
    fn a_map_that_is_served_again_does_not_push_out_the_one_before() {
        let mut maps = Maps::default();
        for map_id in [1, 2, 2] {
            maps.receive(&map(map_id), &CELLS).unwrap();
        }
        assert!(maps.get(1).is_ok() && maps.get(2).is_ok());
    }

    #[test]
    fn a_map_that_is_not_sound_changes_nothing() {
        let mut maps = Maps::default();
        assert!(maps.get(1).unwrap_err().to_string().ends_with("none"));
        maps.receive(&map(1), &CELLS).unwrap();
        let mut refuse = |change: fn(&mut MapHeader), expected: &str| {
            let mut broken = map(2);
            change(&mut broken);
            let error = maps.receive(&broken, &CELLS).unwrap_err().to_string();
            assert!(error.contains(expected), "{error}");
        };
        refuse(|map| map.free_to = 100, "free_to of the map is 100");
        refuse(|map| map.height = 21, "600 occupancies instead of 630");
        refuse(|map| map.resolution_m = f64::NAN, "0.001..=10 m");
        assert!(maps.get(1).is_ok() && maps.get(2).is_err());
    }
}
