//! Prepares a localizer from a map and its boundary, or from each map of a set.

use engine::Map;
use engine::grid::{CellRules, GridFrame};
use engine::space::Space;
use engine::vote_search::{Preparation, Prior, VoteSearch, VoteSearchConfig};
use index_cache::{IndexCache, Kept, Prepared};
use messages::{BoundaryCell, BoundaryHeader, MapHeader};
use twox_hash::XxHash3_64;

use crate::AccumulatorError;
use crate::subject::{Refused, Subject};

/// Identity of a localizer's inputs: equal keys give equal localizers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Key {
    pub map_id: u64,
    /// Rules for reading its cells.
    pub rules: CellRules,
    /// Hash of the boundary cells; `None` for a map of a set.
    boundary: Option<u64>,
}

/// A map as it was received, with its boundary unless it belongs to a set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Received<'a> {
    pub(crate) map: MapHeader,
    pub(crate) occupancy: &'a [u8],
    pub(crate) boundary: Option<(&'a BoundaryHeader, &'a [BoundaryCell])>,
}

impl Received<'_> {
    /// Returns the key of the map; `None` if the boundary belongs to another map.
    pub(crate) fn key(&self) -> Result<Option<Key>, Refused> {
        let hash = |cells| XxHash3_64::oneshot(bytemuck::cast_slice(cells));
        let key = Key {
            map_id: self.map.map_id,
            rules: self.rules()?,
            boundary: self.boundary.map(|(_, cells)| hash(cells)),
        };
        let is_whole = |(header, _): (&BoundaryHeader, _)| header.map_id == key.map_id;
        Ok(self.boundary.is_none_or(is_whole).then_some(key))
    }

    /// Copies the messages, because samples must stay on the thread that received them. Beams count
    /// up to `reach_m` metres, if that exceeds the map's own length.
    pub(crate) fn job(&self, reach_m: f64) -> Result<Job, Refused> {
        if let Some((header, cells)) = self.boundary {
            let (expected, found) = (header.boundary_cells, cells.len());
            if expected != found as u64 {
                return Err(self.refused(AccumulatorError::BoundarySize { expected, found }));
            }
        }
        Ok(Job {
            map: self.map,
            occupancy: self.occupancy.to_vec(),
            rules: self.rules()?,
            boundary: self.boundary.map(|(_, cells)| cells.to_vec()),
            reach_m,
        })
    }

    fn rules(&self) -> Result<CellRules, Refused> {
        CellRules::of(&self.map).map_err(|error| self.refused(error))
    }

    fn refused(&self, error: impl Into<AccumulatorError>) -> Refused {
        Subject::map(&self.map).refused(error)
    }
}

#[derive(Debug, Clone)]
pub struct PreparedMap {
    pub map_id: u64,
    pub vote_search: VoteSearch,
    /// Space of the original map, whose cells may be finer than the searched ones.
    pub space: Space,
}

/// Input for a localizer: a map, with its boundary unless it belongs to a set.
#[derive(Debug, Clone)]
pub struct Job {
    map: MapHeader,
    occupancy: Vec<u8>,
    rules: CellRules,
    boundary: Option<Vec<BoundaryCell>>,
    /// Length up to which beams count, metres, if it exceeds the map's own.
    reach_m: f64,
}

impl Job {
    pub fn subject(&self) -> Subject {
        Subject::map(&self.map)
    }

    /// Prepares the localizer, which takes milliseconds to seconds unless the index is cached.
    pub fn prepare(
        self,
        config: VoteSearchConfig,
        prior: Prior,
        cache: Option<&IndexCache>,
    ) -> Result<(PreparedMap, Kept), AccumulatorError> {
        let frame = GridFrame::of(&self.map)?;
        let (width, height) = (self.map.width as usize, self.map.height as usize);
        let space = Space::new(config.headings, frame.resolution_m, width, height)?;
        let map = Map {
            frame,
            sides: (width, height),
            occupancy: &self.occupancy,
            rules: self.rules,
        };
        let preparation = Preparation::of_map(map, config, prior)?;
        let preparation = match self.boundary {
            None => preparation,
            Some(boundary) => preparation.with_boundary(&boundary)?,
        };
        let Prepared { vote_search, kept } = Prepared::new(cache, preparation)?;
        let map = PreparedMap {
            map_id: self.map.map_id,
            vote_search: vote_search.reaching(self.reach_m),
            space: space.reaching(self.reach_m),
        };
        Ok((map, kept))
    }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use engine::boundary;
    use engine::grid::{Cell, Grid};

    use super::*;

    struct Pair {
        map: MapHeader,
        occupancy: Vec<u8>,
        header: BoundaryHeader,
        cells: Vec<BoundaryCell>,
    }

    /// Returns a room of 6 by 4 cells with bare walls.
    fn room() -> Pair {
        let is_wall = |x, y| x == 0 || x == 5 || y == 0 || y == 3;
        let occupancy: Vec<u8> = (0..24)
            .map(|i| 100 * u8::from(is_wall(i % 6, i / 6)))
            .collect();
        let grid = Grid::new(6, 4, &occupancy, CellRules::default()).unwrap();
        let cells = boundary::extract(&grid);
        let map = MapHeader {
            map_id: 77,
            width: 6,
            height: 4,
            resolution_m: 0.1,
            ..MapHeader::default()
        };
        let header = BoundaryHeader {
            map_id: 77,
            boundary_cells: cells.len() as u64,
            ..Zeroable::zeroed()
        };
        Pair {
            map,
            occupancy,
            header,
            cells,
        }
    }

    impl Pair {
        fn received(&self) -> Received<'_> {
            Received {
                map: self.map,
                occupancy: &self.occupancy,
                boundary: Some((&self.header, &self.cells)),
            }
        }
    }

    fn prepare(change: impl FnOnce(&mut Pair)) -> Result<PreparedMap, AccumulatorError> {
        let mut pair = room();
        change(&mut pair);
        let job = pair.received().job(0.0).map_err(|(_, error)| *error)?;
        let prepared = job.prepare(VoteSearchConfig::default(), Prior::Heading, None);
        prepared.map(|(map, _)| map)
    }

    #[track_caller]
    fn refused(expected: &str, change: impl FnOnce(&mut Pair)) {
        let error = prepare(change).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    }

    #[test]
    fn rays_hit_nothing_where_the_boundary_lacks_a_cell() {
        let prepared = prepare(|pair| {
            assert_eq!((pair.cells[3].x, pair.cells[3].y), (3, 0));
            pair.cells.remove(3);
            pair.header.boundary_cells -= 1;
        });
        let grid = prepared.unwrap();
        let grid = grid.vote_search.grid();
        assert_eq!(grid.get(3, 0), Some(Cell::Blocked));
        assert_eq!((grid.occupied_cells(), grid.free_cells()), (15, 8));
    }

    #[test]
    fn a_map_that_was_kept_is_read_by_its_rules() {
        let folder = tempfile::tempdir().unwrap();
        let cache = IndexCache::new(folder.path().join("maps"), 10_000_000);
        let prepare = |pair: &Pair| {
            let job = pair.received().job(0.0).unwrap();
            job.prepare(VoteSearchConfig::default(), Prior::None, Some(&cache))
                .unwrap()
        };
        let mut pair = room();
        let (_, kept) = prepare(&pair);
        assert!(!kept.is_read);
        kept.unsaved.unwrap().save().unwrap();
        let (map, kept) = prepare(&pair);
        assert!(kept.is_read && kept.unsaved.is_none());
        assert_eq!((map.map_id, map.vote_search.searchable_cells()), (77, 8));
        // One index serves two rules that classify all cells alike.
        pair.map.occupied_from = 66;
        assert!(prepare(&pair).1.is_read);
        pair.occupancy[7] = 50;
        assert!(!prepare(&pair).1.is_read, "a cell is unknown now");
    }

    #[test]
    fn a_pair_is_of_one_map_by_its_rules_and_with_its_boundary() {
        let mut pair = room();
        let key = |pair: &Pair| pair.received().key().unwrap();
        let first = key(&pair).unwrap();
        assert_eq!((first.map_id, first.rules), (77, CellRules::default()));
        assert_eq!(key(&pair), Some(first));
        pair.map.unknown_blocks = 1;
        assert_ne!(key(&pair), Some(first));
        pair.map.unknown_blocks = 0;
        pair.cells.truncate(15);
        assert_ne!(key(&pair), Some(first));
        pair.header.map_id = 78;
        assert_eq!(key(&pair), None);
    }

    #[test]
    fn a_map_that_is_not_sound_is_refused() {
        refused("allowed: 0.001..=10 m", |pair| pair.map.resolution_m = 0.0);
        refused("occupied_from of the map is 0", |pair| {
            pair.map.occupied_from = 0;
        });
        refused("instead of 30", |pair| pair.map.height = 5);
        refused("nowhere that the robot could be", |pair| {
            pair.occupancy.fill(100);
        });
    }

    #[test]
    fn a_boundary_of_other_cells_is_refused() {
        refused("15 cells instead of 16", |pair| pair.cells.truncate(15));
        refused("cell 1, 1 of the boundary", |pair| {
            pair.cells[3] = BoundaryCell { x: 1, y: 1 };
        });
    }
}
