//! A map and its settings, ready to be asked where scans were taken.

use crate::EngineError;
use crate::accumulator::{Accumulator, Query};
use crate::grid::{self, CellRules, Grid, GridFrame, Pooled};
use crate::instruction_set::InstructionSet;
use crate::limits::{Limits, LimitsConfig};
use crate::program::{ScanProgram, VoteConfig};
use crate::scan::Scan;
use crate::search::{BlockBounds, SearchIndex};
use crate::space::Space;
use crate::sweep::FieldSweep;
use crate::votes::{self, CollectConfig, VoteSet};

/// How scans are matched with the map.
#[derive(Debug, Clone, PartialEq, clap::Args)]
pub struct LocalizerConfig {
    /// Headings a turn, a multiple of 8 from 8 to 3600.
    #[arg(long, value_name = "COUNT", default_value_t = 360)]
    pub headings: u32,
    /// Threads of a search, 1..=64; the answer is the same with any number.
    #[arg(long, value_name = "COUNT", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=64))]
    pub threads: u8,
    /// How readings become votes.
    #[command(flatten)]
    pub votes: VoteConfig,
    /// What is collected of a search.
    #[command(flatten)]
    pub collect: CollectConfig,
    /// Where poses are sought.
    #[command(flatten)]
    pub limits: LimitsConfig,
    /// Finer maps are searched in cells of at most this side, and what is found
    /// is refined on the map as it is, metres, 0..=1; 0 searches each map as it
    /// is.
    #[arg(long, value_name = "METRES", default_value_t = 0.05, value_parser = parse_cell)]
    pub search_cell: f64,
}

fn parse_cell(text: &str) -> Result<f64, String> {
    crate::config::parse(text, 0.0..=1.0, "metres")
}

impl Default for LocalizerConfig {
    fn default() -> Self {
        LocalizerConfig {
            headings: 360,
            threads: 1,
            votes: VoteConfig::default(),
            collect: CollectConfig::default(),
            limits: LimitsConfig::default(),
            search_cell: 0.05,
        }
    }
}

/// What the localizer knows of the heading beforehand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prior {
    /// Nothing: all headings are searched.
    None,
    /// Each scan comes with its heading: only x and y are searched.
    Heading,
}

/// A map prepared for one kind of question.
#[derive(Debug, Clone)]
pub struct Localizer {
    frame: GridFrame,
    pooling: usize,
    grid: Grid,
    space: Space,
    config: LocalizerConfig,
    limits: Limits,
    method: Method,
}

#[derive(Debug, Clone)]
enum Method {
    Search(Box<SearchIndex>),
    Sweep(FieldSweep),
}

/// What a scan says about the pose.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The poses with the most votes.
    pub found: VoteSet,
    /// What a pose would have if every beam agreed fully.
    pub highest_possible: u32,
    /// Beams that voted.
    pub beams_used: u32,
    /// Beams whose reading says nothing.
    pub beams_silent: u32,
    /// The largest rounding of a bearing to the heading grid, radians.
    pub bearing_rounding: f64,
    /// Headings a turn.
    pub headings: u32,
    /// The heading that was given, in the map frame, radians.
    pub known_heading: Option<f64>,
}

impl Localizer {
    /// Prepares a map of `width · height` occupancies, row by row from the
    /// lowest y; one finer than is searched is pooled.
    ///
    /// # Errors
    /// See [`Grid::new`] and [`Localizer::new`].
    pub fn of_map(
        frame: GridFrame,
        (width, height): (usize, usize),
        occupancy: &[u8],
        rules: CellRules,
        config: LocalizerConfig,
        prior: Prior,
    ) -> Result<Self, EngineError> {
        let pooling = grid::pooling(frame.resolution_m, config.search_cell);
        if pooling == 1 {
            let grid = Grid::new(width, height, occupancy, rules)?;
            return Localizer::new(frame, grid, config, prior);
        }
        let pooled = Pooled::new(frame, (width, height), occupancy, rules, pooling)?;
        let (width, height) = pooled.sides;
        let grid = Grid::new(width, height, &pooled.occupancy, rules)?;
        let localizer = Localizer::new(pooled.frame, grid, config, prior)?;
        Ok(Localizer {
            pooling,
            ..localizer
        })
    }

    /// Prepares a grid, which is searched as it is.
    ///
    /// # Errors
    /// If the map has no occupied or no free cell, a setting is out of range, or
    /// the limits leave no pose.
    pub fn new(
        frame: GridFrame,
        grid: Grid,
        config: LocalizerConfig,
        prior: Prior,
    ) -> Result<Self, EngineError> {
        if grid.occupied_cells() == 0 {
            return Err(EngineError::NoOccupiedCell);
        }
        if grid.free_cells() == 0 {
            return Err(EngineError::NoFreeCell);
        }
        let space = Space::new(
            config.headings,
            frame.resolution_m,
            grid.width(),
            grid.height(),
        )?;
        let limits = Limits::new(&config.limits, frame, &grid, &space.directions)?;
        let method = match prior {
            Prior::None => {
                let index = SearchIndex::new(&grid, &space).within(limits.clone());
                Method::Search(Box::new(index))
            }
            Prior::Heading => Method::Sweep(FieldSweep::new(&grid)),
        };
        Ok(Localizer {
            frame,
            pooling: 1,
            grid,
            space,
            config,
            limits,
            method,
        })
    }

    /// Cells of the map along the side of a cell that is searched.
    #[must_use]
    pub fn pooling(&self) -> usize {
        self.pooling
    }

    /// Where the grid that is searched lies in the map.
    #[must_use]
    pub fn frame(&self) -> GridFrame {
        self.frame
    }

    /// How scans are matched.
    #[must_use]
    pub fn config(&self) -> &LocalizerConfig {
        &self.config
    }

    /// The cells that are searched.
    #[must_use]
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The space that is searched.
    #[must_use]
    pub fn space(&self) -> &Space {
        &self.space
    }

    /// Searches all poses; `None` if `stop` said so before the end.
    ///
    /// # Errors
    /// If the scan is refused, see [`Scan::check`].
    ///
    /// # Panics
    /// If the localizer was prepared for known headings.
    pub fn search(
        &self,
        scan: &Scan<'_>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Outcome>, EngineError> {
        let Method::Search(index) = &self.method else {
            panic!("this localizer was prepared for known headings");
        };
        let program = ScanProgram::new(scan, 0.0, &self.space, &self.config.votes)?;
        let how = (InstructionSet::best(), usize::from(self.config.threads));
        let (scan, collect) = ((&program, &self.space), self.config.collect);
        let found = index.search_with(how, &self.grid, scan, collect, stop);
        Ok(found.map(|found| self.outcome(&program, found, None)))
    }

    /// Upper bounds of what [`Localizer::search`] can find, by block: where the
    /// robot may be, roughly.
    ///
    /// # Errors
    /// If the scan is refused, see [`Scan::check`].
    ///
    /// # Panics
    /// If the localizer was prepared for known headings.
    pub fn block_bounds(&self, scan: &Scan<'_>) -> Result<BlockBounds, EngineError> {
        let Method::Search(index) = &self.method else {
            panic!("this localizer was prepared for known headings");
        };
        let program = ScanProgram::new(scan, 0.0, &self.space, &self.config.votes)?;
        Ok(index.block_bounds(&program, &self.space))
    }

    /// Searches x and y at a heading in the map frame, radians, and fills in
    /// the intensities of all cells, row by row from the lowest y; `None` if
    /// `stop` said so before the end.
    ///
    /// # Errors
    /// If the scan is refused, see [`Scan::check`], or the heading not finite.
    ///
    /// # Panics
    /// If the localizer was prepared for unknown headings.
    pub fn search_at(
        &self,
        scan: &Scan<'_>,
        heading: f64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<(Outcome, Vec<u16>)>, EngineError> {
        let Method::Sweep(sweeps) = &self.method else {
            panic!("this localizer was prepared for unknown headings");
        };
        if !heading.is_finite() {
            return Err(EngineError::Heading(heading));
        }
        // What the heading grid does not hold of the heading turns the beams.
        let (index, turn) = self
            .space
            .directions
            .nearest(heading - self.frame.map_from_grid.yaw);
        let program = ScanProgram::new(scan, turn, &self.space, &self.config.votes)?;
        let query = Query {
            program: &program,
            space: &self.space,
            heading: index,
        };
        let mut field = Vec::new();
        if sweeps.accumulator().fill(query, &mut field, stop).is_none() {
            return Ok(None);
        }
        self.limits.clear(&mut field, index);
        let (width, collect) = (self.grid.width(), self.config.collect);
        let mut found = votes::of_field(&field, width, index as u16, collect);
        let wanted = collect.candidates as usize;
        if wanted > 0 && found.best > 0 {
            let others = votes::best_of_blocks(&field, width, index as u16);
            found.add_candidates(others, &self.space, wanted);
        }
        Ok(Some((self.outcome(&program, found, Some(heading)), field)))
    }

    fn outcome(
        &self,
        program: &ScanProgram,
        found: VoteSet,
        known_heading: Option<f64>,
    ) -> Outcome {
        Outcome {
            found,
            highest_possible: program.highest_possible(),
            beams_used: program.beams() as u32,
            beams_silent: program.silent() as u32,
            bearing_rounding: program.bearing_rounding(),
            headings: self.config.headings,
            known_heading,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::f64::consts::{FRAC_PI_2, PI};

    use geometry::Pose;

    use super::*;
    use crate::grid::drawn::grid;
    use crate::reference;

    /// An L-shaped room with a pillar: no pose looks like another.
    const ROOM: [&str; 12] = [
        "####################",
        "#..................#",
        "#..................#",
        "#...........##.....#",
        "#...........##.....#",
        "#..................#",
        "#.......############",
        "#.......#...........",
        "#.......#...........",
        "#..#....#...........",
        "#.......#...........",
        "#########...........",
    ];
    const FRAME: GridFrame = GridFrame {
        resolution_m: 0.25,
        map_from_grid: Pose::new(3.0, -1.0, 0.5),
    };

    fn localizer(prior: Prior) -> Localizer {
        let grid = grid(&ROOM);
        Localizer::new(FRAME, grid, LocalizerConfig::default(), prior).unwrap()
    }

    /// What a laser with a beam a degree all around reads at a pose of the grid.
    fn ranges(x: i64, y: i64, heading: usize) -> Vec<f32> {
        let grid = grid(&ROOM);
        let space = Space::new(360, FRAME.resolution_m, grid.width(), grid.height()).unwrap();
        let beams = (0..360).map(|beam| {
            let direction = space.directions.get(heading + 180 + beam);
            reference::range(&grid, x, y, direction).map_or(f32::INFINITY, |steps| {
                (f64::from(steps) / direction.steps_per_cell * FRAME.resolution_m) as f32
            })
        });
        beams.collect()
    }

    fn scan(ranges: &[f32]) -> Scan<'_> {
        let angle_increment = 1f64.to_radians();
        Scan {
            angle_min: -PI,
            angle_increment,
            range_min_m: 0.0,
            range_max_m: 30.0,
            ranges,
        }
    }

    #[test]
    fn finds_the_pose_that_a_scan_was_taken_at() {
        let ranges = ranges(5, 3, 40);
        let outcome = localizer(Prior::None)
            .search(&scan(&ranges), &|| false)
            .unwrap()
            .unwrap();
        let best = outcome.found.votes[0];
        assert_eq!((best.x, best.y, best.heading), (5, 3, 40));
        assert_eq!(
            u32::from(best.intensity),
            outcome.highest_possible,
            "every beam agrees"
        );
    }

    #[test]
    fn a_known_heading_is_taken_in_the_map_frame() {
        let ranges = ranges(5, 3, 40);
        let heading = 40f64.to_radians() + 0.5;
        let (outcome, field) = localizer(Prior::Heading)
            .search_at(&scan(&ranges), heading, &|| false)
            .unwrap()
            .unwrap();
        let best = outcome.found.votes[0];
        assert_eq!((best.x, best.y, best.heading), (5, 3, 40));
        assert_eq!(field[3 * 20 + 5], best.intensity);
        assert!(outcome.bearing_rounding < 1e-6);
    }

    #[test]
    fn a_search_at_a_heading_ends_when_it_is_told_to() {
        let (ranges, localizer) = (ranges(5, 3, 40), localizer(Prior::Heading));
        let asked = Cell::new(0);
        let search_until = |last| {
            asked.set(0);
            let stop = || {
                asked.set(asked.get() + 1);
                asked.get() == last
            };
            localizer.search_at(&scan(&ranges), 0.0, &stop).unwrap()
        };
        assert!(search_until(0).is_some());
        let times = asked.get();
        assert!(times > 1, "it is asked again and again: {times}");
        for last in 1..=times {
            assert_eq!(search_until(last), None);
            assert_eq!(asked.get(), last, "nothing is swept after that");
        }
    }

    #[test]
    fn a_map_without_obstacles_or_space_is_refused() {
        let make = |rows: &[&str]| {
            let grid = grid(rows);
            Localizer::new(FRAME, grid, LocalizerConfig::default(), Prior::None).map(|_| ())
        };
        assert_eq!(make(&["...", "..."]), Err(EngineError::NoOccupiedCell));
        assert_eq!(make(&["###", "#?#"]), Err(EngineError::NoFreeCell));
    }

    #[test]
    fn a_scan_in_which_nothing_returned_has_no_votes() {
        let outcome = localizer(Prior::None).search(&scan(&[f32::INFINITY; 9]), &|| false);
        let outcome = outcome.unwrap().unwrap();
        assert_eq!(
            (outcome.found.best, outcome.beams_used, outcome.beams_silent),
            (0, 0, 9)
        );
        let (outcome, field) = localizer(Prior::Heading)
            .search_at(&scan(&[f32::NAN; 9]), FRAC_PI_2, &|| false)
            .unwrap()
            .unwrap();
        assert_eq!(outcome.found.votes, []);
        assert!(field.iter().all(|&intensity| intensity == 0));
    }
}
