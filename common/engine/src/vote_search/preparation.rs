//! Preparation of a map for the first stage; its index is built, or read from a cache.

use std::sync::Arc;

use messages::BoundaryCell;

use super::{Method, Prior, VoteSearch, VoteSearchConfig};
use crate::EngineError;
use crate::boundary;
use crate::grid::{self, Grid, GridFrame, Pooled};
use crate::limits::Limits;
use crate::occupancy_map::Map;
use crate::search::{IndexKey, SECTIONS, SearchIndex, SectionError, UncheckedIndex};
use crate::space::Space;
use crate::sweep::FieldSweep;

const MEGABYTE: u64 = 1_000_000;

/// Share of the best pose's votes down to which a map of fewer blocks than candidates is searched:
/// on cells of 0.5 m, a place of an office is not found from 0.88 on.
const FEW_BLOCKS_FLOOR: f64 = 0.85;

/// A map and its settings, checked: a [`VoteSearch`] without the parts that take long to build.
#[derive(Debug, Clone)]
pub struct Preparation {
    pub(super) frame: GridFrame,
    pub(super) pooling: usize,
    pub(super) grid: Grid,
    pub(super) space: Space,
    pub(super) config: VoteSearchConfig,
    pub(super) prior: Prior,
}

impl Preparation {
    /// Takes a map, of which cells smaller than the search cell are pooled.
    ///
    /// # Errors
    /// See [`Grid::new`] and [`Preparation::new`].
    pub fn of_map(
        map: Map<'_>,
        config: VoteSearchConfig,
        prior: Prior,
    ) -> Result<Self, EngineError> {
        let Map {
            frame,
            sides,
            occupancy,
            rules,
        } = map;
        let pooling = grid::pooling(frame.resolution_m, config.search_cell);
        if pooling == 1 {
            let grid = Grid::new(sides.0, sides.1, occupancy, rules)?;
            return Preparation::new(frame, grid, config, prior);
        }
        let pooled = Pooled::new(frame, sides, occupancy, rules, pooling)?;
        let (width, height) = pooled.sides;
        let mut grid = Grid::new(width, height, &pooled.occupancy, rules)?;
        if rules.unknown_blocks {
            // A free cell may contain unknown ones, behind which the map's own rays hit nothing.
            let boundary = boundary::extract(&Grid::new(sides.0, sides.1, occupancy, rules)?);
            grid = grid.with_boundary(&boundary, pooling)?;
        }
        let preparation = Preparation::new(pooled.frame, grid, config, prior)?;
        Ok(Preparation {
            pooling,
            ..preparation
        })
    }

    /// Takes a grid, which is searched at its own resolution.
    ///
    /// # Errors
    /// If the map has no occupied or no free cell, or a setting is out of range.
    pub fn new(
        frame: GridFrame,
        grid: Grid,
        config: VoteSearchConfig,
        prior: Prior,
    ) -> Result<Self, EngineError> {
        grid.check_use()?;
        let space = Space::new(
            config.headings,
            frame.resolution_m,
            grid.width(),
            grid.height(),
        )?;
        Ok(Preparation {
            frame,
            pooling: 1,
            grid,
            space,
            config,
            prior,
        })
    }

    /// Takes the cells in which rays end with a hit from the boundary of the map's obstacles, see
    /// [`Grid::with_boundary`]. Where the map is searched in larger cells, a ray hits those that
    /// contain one.
    ///
    /// # Errors
    /// If a cell of the boundary is not occupied on the map.
    pub fn with_boundary(self, boundary: &[BoundaryCell]) -> Result<Self, EngineError> {
        let grid = self.grid.with_boundary(boundary, self.pooling)?;
        Ok(Preparation { grid, ..self })
    }

    /// Returns the key of the index that would be built; `None` for known headings, which need no
    /// index.
    pub fn key(&self) -> Option<IndexKey> {
        let Preparation {
            frame,
            grid,
            space,
            config,
            ..
        } = self;
        let key = || IndexKey::of(grid, space, *frame, &config.limits);
        (self.prior == Prior::None).then(key)
    }

    /// Allocates buffers for the sections of a cached index, given their lengths in bytes.
    ///
    /// # Errors
    /// If the lengths do not fit an index of this map, or exceed the memory limit.
    pub fn unchecked_index(
        &self,
        lengths: [u64; SECTIONS],
    ) -> Result<UncheckedIndex, SectionError> {
        let bytes = lengths
            .iter()
            .fold(0u64, |sum, &length| sum.saturating_add(length));
        match self.memory_limit() {
            Some(limit) if bytes > limit => Err(SectionError::Memory { bytes, limit }),
            _ => UncheckedIndex::new(lengths, &self.grid, &self.space),
        }
    }

    /// Finishes with a cached index that has the key of this map.
    #[must_use]
    pub fn with(self, index: SearchIndex) -> VoteSearch {
        self.vote_search(Method::Search(Arc::new(index)))
    }

    /// Finishes by building what is missing.
    ///
    /// # Errors
    /// If the limits exclude every pose, or more memory would be needed than is allowed.
    pub fn finish(self) -> Result<VoteSearch, EngineError> {
        let Preparation {
            frame,
            grid,
            space,
            config,
            ..
        } = &self;
        let limits = Limits::new(&config.limits, *frame, grid, &space.directions)?;
        let method = match self.prior {
            Prior::None => {
                self.check_memory(&limits)?;
                Method::Search(Arc::new(SearchIndex::within(grid, space, limits)))
            }
            Prior::Heading => Method::Field(Box::new(FieldSweep::new(grid)), limits),
        };
        Ok(self.vote_search(method))
    }

    fn vote_search(mut self, method: Method) -> VoteSearch {
        let collect = &mut self.config.collect;
        if let Method::Search(index) = &method
            && index.blocks() < collect.candidates as usize
        {
            // The search has a candidate for each block, and more only above its floor.
            collect.floor_share = collect.floor_share.min(FEW_BLOCKS_FLOOR);
        }
        VoteSearch {
            prepared: self,
            method,
        }
    }

    /// Memory limit in bytes.
    fn memory_limit(&self) -> Option<u64> {
        let megabytes = self.config.memory_limit?;
        Some(u64::from(megabytes) * MEGABYTE)
    }

    /// Rejects a map that needs more memory than allowed, before it is allocated. The need is
    /// computed only if there is a limit.
    fn check_memory(&self, limits: &Limits) -> Result<(), EngineError> {
        let Some(limit) = self.memory_limit() else {
            return Ok(());
        };
        let needed = SearchIndex::needed_bytes(&self.grid, &self.space, limits) as u64;
        match needed > limit {
            true => Err(EngineError::Memory {
                needed_mb: needed.div_ceil(MEGABYTE),
                limit_mb: (limit / MEGABYTE) as u32,
            }),
            false => Ok(()),
        }
    }
}
