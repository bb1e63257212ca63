//! A map that is ready to be searched, and what a search answers. Pure: no
//! file, no clock.

use engine::EngineError;
use engine::beams::BeamConfig;
use engine::fit::{Ends, Terrain};
use engine::grid::GridFrame;
use engine::localizer::{self, Localizer, Outcome, Prior};
use engine::peaks::{self, PeakConfig, PeakInput, Places, Score};
use engine::scan::Scan;
use engine::space::Space;
use map::OccupancyGrid;

use super::options::EngineOptions;

/// A map and all settings.
#[derive(Debug)]
pub(crate) struct World {
    /// The map's id, as the graph's messages have it.
    pub(crate) map_id: u64,
    localizer: Localizer,
    terrain: Terrain,
    /// That of the map as it is.
    space: Space,
    cells: u64,
    beams: BeamConfig,
    peaks: PeakConfig,
    workspace: Workspace,
}

/// What locating takes, kept from scan to scan.
#[derive(Debug, Default)]
struct Workspace {
    localizer: localizer::Workspace,
    ends: Ends,
    peaks: peaks::Workspace,
}

/// What a scan says about the place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Answer<'a> {
    /// The votes, and how they were come by.
    pub(crate) outcome: &'a Outcome,
    /// What they say, the verdict included.
    pub(crate) places: &'a Places,
}

impl World {
    /// Does what the graph's accumulator and peak extractor do with a map.
    ///
    /// # Errors
    /// The map has no occupied or no free cell, or a setting is out of range.
    pub(crate) fn prepare(
        map: &OccupancyGrid,
        options: &EngineOptions,
        prior: Prior,
    ) -> Result<Self, EngineError> {
        let (width, height) = (map.width as usize, map.height as usize);
        let frame = GridFrame {
            resolution_m: map.resolution_m,
            map_from_grid: map.map_from_grid,
        };
        let (sides, cells, rules) = ((width, height), &map.cells, options.cells);
        let config = options.localizer.clone();
        Ok(World {
            map_id: map.id(),
            terrain: Terrain::new(frame, sides, cells, rules)?,
            space: Space::new(
                options.localizer.headings,
                frame.resolution_m,
                width,
                height,
            )?,
            beams: options.localizer.votes.beams,
            localizer: Localizer::of_map(frame, sides, cells, rules, config, prior)?,
            cells: width as u64 * height as u64,
            peaks: options.peaks,
            workspace: Workspace::default(),
        })
    }

    /// Cells of the map.
    pub(crate) fn cells(&self) -> u64 {
        self.cells
    }

    /// Searches all poses or, where the heading in the map is given in radians,
    /// all positions; the world must be prepared for the one or the other.
    ///
    /// # Errors
    /// The scan is refused.
    pub(crate) fn locate(
        &mut self,
        scan: &Scan<'_>,
        heading: Option<f64>,
    ) -> Result<Answer<'_>, EngineError> {
        let Workspace {
            localizer: workspace,
            ends,
            peaks,
        } = &mut self.workspace;
        let localizer = &self.localizer;
        let found = match heading {
            Some(heading) => localizer.search_at_in(workspace, scan, heading, &|| false)?,
            None => localizer.search_in(workspace, scan, &|| false)?,
        };
        let outcome = found.expect("a search that nothing stops ends with an outcome");
        let input = PeakInput::of(outcome, localizer.frame());
        let places = match self.peaks.score {
            Score::Votes => peaks.by_votes(&input, &self.peaks),
            Score::Fit => {
                ends.find(scan, &self.space, &self.beams)?;
                peaks.by_fit(&input, (&self.terrain, ends), &self.peaks)
            }
        };
        Ok(Answer { outcome, places })
    }
}
