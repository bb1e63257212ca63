//! A map that is ready to be searched, and the results of a search. Pure: no file, no clock.

use anyhow::Context;
use engine::EngineError;
use engine::Map;
use engine::fit::{BeamClass, DistanceField, Ends, GridPose, JudgedBeam};
use engine::grid::GridFrame;
use engine::localizer::{Localizer, PreparedMap, Settings, Workspace};
use engine::observation::Observation;
use engine::peaks::{PeakConfig, Places, Target};
use engine::scan::Scan;
use engine::vote_search::{Outcome, Prior};
use geometry::Pose;
use index_cache::{IndexCache, Kept};
use map::OccupancyGrid;

use super::maps::{frame_of, sides_of};
use super::options::{EngineOptions, NamedMap};

/// Maps prepared with all settings.
#[derive(Debug)]
pub struct World {
    /// The map's id, as in the graph's messages; that of the first map of several.
    pub map_id: u64,
    maps: Vec<KnownMap>,
    localizer: Localizer,
    workspace: Workspace,
    /// The last places, as poses of the first laser.
    of_laser: Places,
}

#[derive(Debug, Clone, PartialEq)]
pub struct KnownMap {
    /// The id in the graph's messages.
    pub id: u64,
    /// Name in the map set; empty for a single map.
    pub name: String,
    /// Floor, if the map set defines it.
    pub floor: Option<String>,
    frame: GridFrame,
    cells: u64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer<'a> {
    pub outcome: &'a Outcome,
    pub places: &'a Places,
    pub frame: GridFrame,
    pub map: &'a KnownMap,
    /// All maps that were searched; places refer to them by index.
    pub maps: &'a [KnownMap],
}

/// A scan compared with the map at a given pose.
#[derive(Debug, Clone, PartialEq)]
pub struct ScanAt {
    /// Fit to the map, at most 1.
    pub score: f64,
    /// Sorted by bearing.
    pub ends: Vec<BeamEnd>,
}

/// End point of a beam that votes, and its class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamEnd {
    /// In the map, metres.
    pub at: (f64, f64),
    pub class: BeamClass,
}

impl BeamEnd {
    pub fn distance_to(&self, pose: Pose) -> f64 {
        (self.at.0 - pose.x).hypot(self.at.1 - pose.y)
    }
}

impl ScanAt {
    /// Distance from a pose within which this share of the beams ends, in metres; 0 without beams.
    pub fn reach_m(&self, pose: Pose, share: f64) -> f64 {
        let ends = self.ends.iter();
        let mut distances: Vec<f64> = ends.map(|end| end.distance_to(pose)).collect();
        distances.sort_by(f64::total_cmp);
        let last = (share * distances.len() as f64).ceil() as usize;
        let farthest = distances.get(last.saturating_sub(1));
        farthest.copied().unwrap_or_default()
    }
}

/// Number of votes for each position at one heading.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Geometry of the cells, which can be larger than the map's.
    pub frame: GridFrame,
    pub sides: (usize, usize),
    /// Row by row from the lowest y.
    pub intensities: Vec<u16>,
    pub outcome: Outcome,
}

impl World {
    /// Prepares a map as the graph's accumulator and peak extractor do.
    /// Fails if the map has no occupied or no free cell, or a setting is out of range.
    pub fn prepare(
        map: &OccupancyGrid,
        options: &EngineOptions,
        prior: Prior,
    ) -> Result<Self, EngineError> {
        Self::prepare_with(map, options, prior, None).map(|(world, _)| world)
    }

    /// Like [`World::prepare`], with an index cache.
    pub fn prepare_with(
        map: &OccupancyGrid,
        options: &EngineOptions,
        prior: Prior,
        cache: Option<&IndexCache>,
    ) -> Result<(Self, Kept), EngineError> {
        let (prepared, kept) = prepare(map, options, prior, cache)?;
        let known = KnownMap::of(map, String::new(), None);
        Ok((World::of(vec![known], vec![prepared])?, kept))
    }

    /// Like [`World::prepare_with`], for several maps that are searched together.
    pub fn of_set(
        maps: &[NamedMap],
        options: &EngineOptions,
        prior: Prior,
        cache: Option<&IndexCache>,
    ) -> anyhow::Result<(Self, Vec<Kept>)> {
        let (mut known, mut prepared, mut all_kept) = (Vec::new(), Vec::new(), Vec::new());
        for NamedMap { name, floor, grid } in maps {
            let (map, kept) =
                prepare(grid, options, prior, cache).with_context(|| unusable(name))?;
            known.push(KnownMap::of(grid, name.clone(), floor.clone()));
            prepared.push(map);
            all_kept.push(kept);
        }
        Ok((World::of(known, prepared)?, all_kept))
    }

    fn of(maps: Vec<KnownMap>, prepared: Vec<PreparedMap>) -> Result<Self, EngineError> {
        Ok(World {
            localizer: Localizer::of_maps(prepared)?,
            map_id: maps[0].id,
            maps,
            workspace: Workspace::default(),
            of_laser: Places::default(),
        })
    }

    fn map(&self) -> &PreparedMap {
        &self.localizer.maps()[0]
    }

    pub fn cells(&self) -> u64 {
        self.maps.iter().map(|map| map.cells).sum()
    }

    /// Number of cells in which poses are searched, at the resolution of the search.
    pub fn searchable_cells(&self) -> u64 {
        self.map().vote_search().searchable_cells() as u64
    }

    pub fn index_bytes(&self) -> u64 {
        self.map().vote_search().index_bytes() as u64
    }

    /// Distance field of the map, used by the second stage.
    pub fn distance_field(&self) -> &DistanceField {
        self.map().distance_field()
    }

    pub fn peaks(&self) -> &PeakConfig {
        self.map().peaks()
    }

    /// Prepares the beams of a scan for the second stage.
    pub fn ends(&self, scan: Observation<'_>) -> Result<Ends, EngineError> {
        self.map().ends(scan)
    }

    /// Searches all poses or, if the heading in the map (radians) is given, all positions; the
    /// world must be prepared with the corresponding prior.
    ///
    /// The places are poses of the first laser, even if the base is searched.
    pub fn locate(
        &mut self,
        scan: Observation<'_>,
        heading: Option<f64>,
        target: Target,
    ) -> Result<Answer<'_>, EngineError> {
        let (localizer, workspace) = (&self.localizer, &mut self.workspace);
        let found = localizer.locate_unless(workspace, scan, heading, &|| false)?;
        let engine::Answer {
            outcome, places, ..
        } = found.expect("a search that nothing stops ends with an outcome");
        self.of_laser.clone_from(places);
        for place in &mut self.of_laser.places {
            *place = place.of_laser(target);
        }
        let best = self.of_laser.places.first();
        let map = &self.maps[best.map_or(0, |best| best.map as usize)];
        Ok(Answer {
            outcome,
            places: &self.of_laser,
            frame: map.frame,
            map,
            maps: &self.maps,
        })
    }

    /// Compares a scan with the map at a pose.
    pub fn scan_at(&self, scan: &Scan<'_>, map_from_laser: Pose) -> Result<ScanAt, EngineError> {
        let ends = self.ends(scan.into())?;
        let pose = GridPose::of(self.distance_field().frame, map_from_laser);
        let (field, fit) = (self.distance_field(), &self.peaks().fit);
        let classes = field.classes(&ends, pose, fit);
        let beams = ends.judged(&classes).map(|beam| BeamEnd {
            at: end_of(map_from_laser, beam),
            class: beam.class,
        });
        Ok(ScanAt {
            score: field.score(&ends, pose, fit),
            ends: beams.collect(),
        })
    }

    /// Votes of all positions at a heading, in radians, in a world prepared for known headings.
    pub fn field_at(&self, scan: &Scan<'_>, heading: f64) -> Result<Field, EngineError> {
        let search = self.map().vote_search();
        let found = search.search_at(scan, heading, &|| false)?;
        let (outcome, intensities) = found.expect("a search that nothing stops ends");
        let grid = search.grid();
        Ok(Field {
            frame: search.frame(),
            sides: (grid.width(), grid.height()),
            intensities,
            outcome,
        })
    }
}

impl KnownMap {
    fn of(map: &OccupancyGrid, name: String, floor: Option<String>) -> Self {
        KnownMap {
            id: map.id(),
            name,
            floor,
            frame: frame_of(map),
            cells: u64::from(map.width) * u64::from(map.height),
        }
    }
}

/// Message of a map that can be read, but not searched.
pub(super) fn unusable(name: &str) -> String {
    format!("{name} cannot be searched")
}

fn prepare(
    map: &OccupancyGrid,
    options: &EngineOptions,
    prior: Prior,
    cache: Option<&IndexCache>,
) -> Result<(PreparedMap, Kept), EngineError> {
    let view = Map {
        frame: frame_of(map),
        sides: sides_of(map),
        occupancy: &map.cells,
        rules: options.cells,
    };
    let settings = Settings {
        vote_search: options.vote_search.clone(),
        peaks: options.peaks,
        prior,
    };
    index_cache::prepared_map(cache, view, settings)
}

/// End point of a beam in the map, in metres, if the scan was taken at this pose.
fn end_of(map_from_laser: Pose, beam: JudgedBeam) -> (f64, f64) {
    let (sin, cos) = beam.bearing.sin_cos();
    map_from_laser.transform(beam.reading_m * cos, beam.reading_m * sin)
}
