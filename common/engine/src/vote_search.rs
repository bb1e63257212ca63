//! A map and its settings, ready for searches.

mod config;
mod preparation;
mod together;

use std::sync::Arc;

use crate::EngineError;
use crate::accumulator::Query;
use crate::grid::{Grid, GridFrame};
use crate::instruction_set::InstructionSet;
use crate::limits::Limits;
use crate::observation::Observation;
use crate::program::ScanProgram;
use crate::search::{self, BlockBounds, SearchIndex};
use crate::simd::Simd;
use crate::space::Space;
use crate::sweep::{self, FieldSweep};
use crate::votes::{FieldVotes, VoteSet, VoteShare};
pub use config::VoteSearchConfig;
pub use preparation::Preparation;

/// Prior knowledge of the heading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Prior {
    /// No knowledge: all headings are searched.
    #[default]
    None,
    /// Each scan comes with its heading: only x and y are searched.
    Heading,
}

/// A map prepared for searches with one kind of [`Prior`].
#[derive(Debug, Clone)]
pub struct VoteSearch {
    prepared: Preparation,
    method: Method,
}

#[derive(Debug, Clone)]
enum Method {
    Search(Arc<SearchIndex>),
    Field(Box<FieldSweep>, Limits),
}

/// Buffers for searches, and the last outcome. Kept from scan to scan: once the buffers are large
/// enough, nothing is allocated any more. They may serve any map, one after the other.
#[derive(Debug, Default)]
pub struct Workspace {
    program: ScanProgram,
    search: search::Workspace,
    sweep: sweep::Workspace,
    field: Vec<u16>,
    field_votes: FieldVotes,
    outcome: Outcome,
    blocks: BlockBounds,
}

impl Workspace {
    /// Intensities of all cells, row by row from the lowest y, at the heading of the last search at
    /// a heading; empty before the first.
    pub fn intensities(&self) -> &[u16] {
        &self.field
    }

    /// Outcome of the last scan.
    pub fn outcome(&self) -> &Outcome {
        &self.outcome
    }
}

/// Votes that one scan gives to poses, and search statistics.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outcome {
    /// The poses with the most votes.
    pub found: VoteSet,
    /// Votes of a pose with which every beam agrees fully.
    pub highest_possible: u32,
    /// Votes of the best pose; if another of several maps has it, the smallest number of votes that
    /// is as good on this map.
    pub lead: u16,
    /// Number of beams that voted: those not longer than the map.
    pub beams_used: u32,
    /// Number of beams without a usable reading.
    pub beams_silent: u32,
    /// Largest rounding of a bearing to the heading grid, in radians.
    pub bearing_rounding: f64,
    /// Number of headings per turn.
    pub headings: u32,
    /// Known heading in the map frame, in radians; `None` if all headings were searched.
    pub known_heading: Option<f64>,
}

impl Outcome {
    /// Votes of the best collected pose as a share of the highest possible.
    pub fn best_share(&self) -> VoteShare {
        VoteShare::new(self.found.best, self.highest_possible as u16)
    }
}

impl VoteSearch {
    /// Prepares a grid, which is searched at its own resolution.
    ///
    /// # Errors
    /// See [`Preparation::new`] and [`Preparation::finish`].
    pub fn new(
        frame: GridFrame,
        grid: Grid,
        config: VoteSearchConfig,
        prior: Prior,
    ) -> Result<Self, EngineError> {
        Preparation::new(frame, grid, config, prior)?.finish()
    }

    /// Returns the search index, worth caching for the next start; `None` if prepared for known
    /// headings.
    pub fn search_index(&self) -> Option<Arc<SearchIndex>> {
        match &self.method {
            Method::Search(index) => Some(Arc::clone(index)),
            Method::Field(..) => None,
        }
    }

    /// Number of map cells along the side of a search cell.
    pub fn pooling(&self) -> usize {
        self.prepared.pooling
    }

    /// Cell size and pose in the map of the grid that is searched.
    pub fn frame(&self) -> GridFrame {
        self.prepared.frame
    }

    /// Settings of the search.
    pub fn config(&self) -> &VoteSearchConfig {
        &self.prepared.config
    }

    /// Cells that are searched.
    pub fn grid(&self) -> &Grid {
        &self.prepared.grid
    }

    /// Number of cells in which poses are searched.
    pub fn searchable_cells(&self) -> usize {
        self.limits().open_cells(&self.prepared.grid).count()
    }

    /// Memory of the search data in bytes, without the cells.
    pub fn index_bytes(&self) -> usize {
        match &self.method {
            Method::Search(index) => index.bytes(),
            Method::Field(sweeps, _) => sweeps.bytes(),
        }
    }

    fn limits(&self) -> &Limits {
        match &self.method {
            Method::Search(index) => index.limits(),
            Method::Field(_, limits) => limits,
        }
    }

    /// Makes beams count up to this length, see [`Space::reaching`].
    #[must_use]
    pub fn reaching(self, reach_m: f64) -> Self {
        let space = self.prepared.space.reaching(reach_m);
        VoteSearch {
            prepared: Preparation {
                space,
                ..self.prepared
            },
            ..self
        }
    }

    /// Space of poses that is searched.
    pub fn space(&self) -> &Space {
        &self.prepared.space
    }

    /// Searches all poses in a new workspace.
    ///
    /// # Errors
    /// See [`VoteSearch::search_in`].
    pub fn search<'s>(
        &self,
        scan: impl Into<Observation<'s>>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Outcome>, EngineError> {
        let mut workspace = Workspace::default();
        let found = self.search_in(&mut workspace, scan, None, stop)?.is_some();
        Ok(found.then_some(workspace.outcome))
    }

    /// Searches all poses or, if a heading in the map frame is given (radians), x and y at that
    /// heading; then it leaves the intensities of all cells in [`Workspace::intensities`]. Returns
    /// `None` if `stop` returned true before the end.
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`], the heading is not finite, or the map
    /// was prepared for the other [`Prior`].
    pub fn search_in<'w, 's>(
        &self,
        workspace: &'w mut Workspace,
        scan: impl Into<Observation<'s>>,
        heading: Option<f64>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<&'w Outcome>, EngineError> {
        match heading {
            Some(heading) => self.at_heading(workspace, scan.into(), heading, stop),
            None => self.at_any_heading(workspace, scan.into(), stop),
        }
    }

    fn at_any_heading<'w>(
        &self,
        workspace: &'w mut Workspace,
        scan: Observation<'_>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<&'w Outcome>, EngineError> {
        let index = self.index()?;
        let Workspace {
            program,
            search,
            outcome,
            ..
        } = workspace;
        let Preparation {
            grid,
            space,
            config,
            ..
        } = &self.prepared;
        program.compile(scan, 0.0, space, &config.votes)?;
        let how = (InstructionSet::best(), usize::from(config.threads));
        let collect = (config.collect, &mut outcome.found);
        let found = index.search_in(search, how, grid, (program, space), collect, stop);
        Ok(found.map(|()| self.describe(program, None, outcome)))
    }

    fn index(&self) -> Result<&SearchIndex, EngineError> {
        match &self.method {
            Method::Search(index) => Ok(index),
            Method::Field(..) => Err(EngineError::HeadingMissing),
        }
    }

    /// Returns upper bounds of the votes that [`VoteSearch::search`] can find, by block: a coarse
    /// picture of where the robot may be.
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`], or the map was prepared for known
    /// headings.
    pub fn block_bounds<'w, 's>(
        &self,
        workspace: &'w mut Workspace,
        scan: impl Into<Observation<'s>>,
    ) -> Result<&'w BlockBounds, EngineError> {
        let index = self.index()?;
        let Workspace {
            program,
            search,
            blocks,
            ..
        } = workspace;
        program.compile(scan, 0.0, &self.prepared.space, &self.prepared.config.votes)?;
        index.block_bounds_in(search, (program, &self.prepared.space), blocks);
        Ok(blocks)
    }

    /// Searches x and y at a heading in the map frame (radians) in a new workspace; returns the
    /// outcome and the intensities of all cells.
    ///
    /// # Errors
    /// See [`VoteSearch::search_in`].
    pub fn search_at<'s>(
        &self,
        scan: impl Into<Observation<'s>>,
        heading: f64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<(Outcome, Vec<u16>)>, EngineError> {
        let mut workspace = Workspace::default();
        let found = self.search_in(&mut workspace, scan, Some(heading), stop)?;
        let found = found.is_some();
        Ok(found.then_some((workspace.outcome, workspace.field)))
    }

    fn at_heading<'w>(
        &self,
        workspace: &'w mut Workspace,
        scan: Observation<'_>,
        heading: f64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<&'w Outcome>, EngineError> {
        let Method::Field(sweeps, limits) = &self.method else {
            return Err(EngineError::HeadingGiven(heading));
        };
        if !heading.is_finite() {
            return Err(EngineError::Heading(heading));
        }
        let Workspace {
            program,
            sweep,
            field,
            field_votes,
            outcome,
            ..
        } = workspace;
        let Preparation {
            frame,
            grid,
            space,
            config,
            ..
        } = &self.prepared;
        // The beams are turned by the rest of the heading after rounding to the heading grid.
        let turned = heading - frame.map_from_grid.yaw;
        let (heading_index, turn) = space.directions.nearest(turned);
        program.compile(scan, turn, space, &config.votes)?;
        let query = Query {
            program,
            space,
            heading: heading_index,
        };
        let simd = Simd::new(InstructionSet::best());
        if sweeps.fill(simd, query, sweep, field, stop).is_none() {
            return Ok(None);
        }
        limits.clear(field, heading_index);
        let (image, how) = ((&field[..], grid.width()), (config.collect, space));
        field_votes.collect(image, heading_index as u16, how, &mut outcome.found);
        Ok(Some(self.describe(program, Some(heading), outcome)))
    }

    /// Fills in an outcome except the votes found.
    fn describe<'w>(
        &self,
        program: &ScanProgram,
        known_heading: Option<f64>,
        outcome: &'w mut Outcome,
    ) -> &'w Outcome {
        outcome.lead = outcome.found.best;
        outcome.highest_possible = program.highest_possible();
        outcome.beams_used = program.beams() as u32;
        outcome.beams_silent = program.silent() as u32;
        outcome.bearing_rounding = program.bearing_rounding();
        outcome.headings = self.prepared.config.headings;
        outcome.known_heading = known_heading;
        outcome
    }
}

#[cfg(test)]
mod tests;
