//! From a scan to the places at which it may have been taken, in one call.
//!
//! ```text
//! scan ── Localizer: votes ── peaks::Workspace::judge: places, verdict
//! ```
//!
//! The graph runs the two halves in two processes, the accumulator and the peak
//! extractor; a [`Locator`] runs them one after the other, with the same code.

use crate::EngineError;
use crate::beams::BeamConfig;
use crate::fit::{BeamClass, DistanceField, Ends};
use crate::grid::{CellRules, GridFrame};
use crate::localizer::{self, Localizer, LocalizerConfig, Outcome, Prior};
use crate::observation::Observation;
use crate::peaks::{self, Judged, PeakConfig, PeakInput};
use crate::space::Space;

/// A borrowed occupancy map.
#[derive(Debug, Clone, Copy)]
pub struct OccupancyView<'a> {
    /// Cell size and pose of the grid in the map frame.
    pub frame: GridFrame,
    /// Number of cells along x and y.
    pub sides: (usize, usize),
    /// Occupancies in per cent, or [`messages::UNKNOWN`], row by row from the lowest y.
    pub occupancy: &'a [u8],
    /// Thresholds for occupied, free and unknown cells.
    pub rules: CellRules,
}

/// Settings of both stages of a [`Locator`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LocatorConfig {
    /// First stage: finds the poses with the most votes.
    pub localizer: LocalizerConfig,
    /// Second stage: groups them to places and decides if one is unambiguous.
    pub peaks: PeakConfig,
}

/// A map prepared for locating scans, shared by any number of threads.
///
/// ```
/// use engine::grid::{CellRules, GridFrame};
/// use engine::localizer::Prior;
/// use engine::locator::{Locator, LocatorConfig, OccupancyView, Workspace};
/// use engine::scan::Scan;
/// use geometry::Pose;
/// use messages::Verdict;
///
/// // A hall of 12 m × 8 m with a store room in a corner, cells of 0.1 m.
/// let (width, height) = (120, 80);
/// let is_wall = |x: usize, y: usize| {
///     x < 2 || y < 2 || x >= width - 2 || y >= height - 2 || (x > 75 && y > 50)
/// };
/// let occupancy: Vec<u8> = (0..width * height)
///     .map(|i| if is_wall(i % width, i / width) { 100 } else { 0 })
///     .collect();
/// let map = OccupancyView {
///     frame: GridFrame { resolution_m: 0.1, map_from_grid: Pose::IDENTITY },
///     sides: (width, height),
///     occupancy: &occupancy,
///     rules: CellRules::default(),
/// };
/// let locator = Locator::new(map, LocatorConfig::default(), Prior::None)?;
///
/// // Ranges of a laser with one beam per degree at 3 m, 2.5 m, turned by a radian.
/// let truth = Pose::new(3.0, 2.5, 1.0);
/// let ranges: Vec<f32> = (0..360)
///     .map(|beam| {
///         let (sin, cos) = (truth.yaw + f64::from(beam).to_radians()).sin_cos();
///         let (x, y) = (10.0 * truth.x, 10.0 * truth.y);
///         let is_free = |r: &f64| !is_wall((x + r * cos) as usize, (y + r * sin) as usize);
///         let cells = (0..).map(|step| 0.1 * f64::from(step)).take_while(is_free).last();
///         0.1 * cells.unwrap_or_default() as f32
///     })
///     .collect();
/// let scan = Scan {
///     angle_min: 0.0,
///     angle_increment: 1f64.to_radians(),
///     range_min_m: 0.1,
///     range_max_m: 30.0,
///     ranges: &ranges,
/// };
///
/// let mut workspace = Workspace::default();
/// let found = locator.locate(&mut workspace, &scan)?;
/// assert_eq!(found.places.verdict, Verdict::Unique);
/// assert!(found.places.places[0].map_from_laser.is_within(truth, 0.1, 0.02));
/// # Ok::<(), engine::EngineError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Locator {
    localizer: Localizer,
    distance_field: DistanceField,
    /// Space of the map at full resolution; the localizer may search a coarser one.
    space: Space,
    peaks: PeakConfig,
}

/// Buffers for locating, kept from scan to scan: once they are large enough, nothing is allocated
/// any more. They may serve any locator.
#[derive(Debug, Default)]
pub struct Workspace {
    localizer: localizer::Workspace,
    peaks: peaks::Workspace,
}

/// Result of locating one scan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Located<'w> {
    /// Votes and search statistics.
    pub outcome: &'w Outcome,
    /// Places and verdict.
    pub places: &'w peaks::Places,
    /// Beams of the scan as they were compared with the map.
    pub ends: &'w Ends,
}

impl Workspace {
    pub(crate) fn localizer(&mut self) -> &mut localizer::Workspace {
        &mut self.localizer
    }

    /// Votes of the last scan.
    pub(crate) fn outcome(&self) -> &Outcome {
        self.localizer.outcome()
    }

    /// Classes of the beams of the last scan at its best place.
    pub(crate) fn classes(&self) -> &Vec<BeamClass> {
        self.peaks.classes()
    }

    /// Beams of the last scan.
    pub(crate) fn ends(&self) -> &Ends {
        self.peaks.ends()
    }
}

impl Locator {
    /// Prepares a map, which takes milliseconds to seconds.
    ///
    /// # Errors
    /// If the map has no occupied or no free cell, or a setting is out of range.
    pub fn new(
        map: OccupancyView<'_>,
        config: LocatorConfig,
        prior: Prior,
    ) -> Result<Self, EngineError> {
        let LocatorConfig { localizer, peaks } = config;
        let OccupancyView {
            frame,
            sides,
            occupancy,
            rules,
        } = map;
        let localizer = Localizer::of_map(frame, sides, occupancy, rules, localizer, prior)?;
        Self::with(localizer, map, peaks)
    }

    /// Does the same with a localizer that was already prepared for the map.
    ///
    /// # Errors
    /// See [`Locator::new`].
    pub fn with(
        localizer: Localizer,
        map: OccupancyView<'_>,
        peaks: PeakConfig,
    ) -> Result<Self, EngineError> {
        let ((width, height), headings) = (map.sides, localizer.config().headings);
        Ok(Locator {
            distance_field: DistanceField::new(map.frame, map.sides, map.occupancy, map.rules)?,
            space: Space::new(headings, map.frame.resolution_m, width, height)?,
            localizer,
            peaks,
        })
    }

    /// Makes beams count up to this length, see [`Space::reaching`].
    #[must_use]
    pub fn reaching(self, reach_m: f64) -> Self {
        Locator {
            localizer: self.localizer.reaching(reach_m),
            space: self.space.reaching(reach_m),
            ..self
        }
    }

    /// Diagonal of the map, in metres.
    pub(crate) fn longest_m(&self) -> f64 {
        self.space.longest_m
    }

    /// Returns the places at which a scan may have been taken, at any heading.
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`].
    ///
    /// # Panics
    /// If the locator was prepared for known headings.
    pub fn locate<'w, 's>(
        &self,
        workspace: &'w mut Workspace,
        scan: impl Into<Observation<'s>>,
    ) -> Result<Located<'w>, EngineError> {
        let found = self.locate_unless(workspace, scan, None, &|| false)?;
        Ok(found.expect("a search that nothing stops ends with an outcome"))
    }

    /// Locates a scan as [`Locator::locate`] does, or, if a heading in the map frame is given
    /// (radians), among all positions at that heading. Returns `None` if `stop` returned true
    /// before the end.
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`], or the heading is not finite.
    ///
    /// # Panics
    /// If the locator was prepared for unknown headings and one is given, or vice versa.
    pub fn locate_unless<'w, 's>(
        &self,
        workspace: &'w mut Workspace,
        scan: impl Into<Observation<'s>>,
        heading: Option<f64>,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Located<'w>>, EngineError> {
        let (scan, localizer) = (scan.into(), &mut workspace.localizer);
        let found = match heading {
            Some(heading) => self
                .localizer
                .search_at_in(localizer, scan, heading, stop)?,
            None => self.localizer.search_in(localizer, scan, stop)?,
        };
        let Some(outcome) = found else {
            return Ok(None);
        };
        let peaks = &mut workspace.peaks;
        let alone = (&self.peaks, false);
        let Judged { places, ends, .. } = self.judged((outcome, peaks), scan, alone)?;
        Ok(Some(Located {
            outcome,
            places,
            ends,
        }))
    }

    /// Runs the second stage alone, for a scan whose votes are in the workspace. `how` is the
    /// settings and true if other maps are searched together with this one.
    pub(crate) fn judge<R>(
        &self,
        workspace: &mut Workspace,
        scan: Observation<'_>,
        how: (&PeakConfig, bool),
        read: impl FnOnce(&Outcome, &Judged<'_>) -> R,
    ) -> Result<R, EngineError> {
        let Workspace { localizer, peaks } = workspace;
        let outcome = localizer.outcome();
        let judged = self.judged((outcome, peaks), scan, how)?;
        Ok(read(outcome, &judged))
    }

    fn judged<'w>(
        &self,
        (outcome, peaks): (&Outcome, &'w mut peaks::Workspace),
        scan: Observation<'_>,
        (config, has_others): (&PeakConfig, bool),
    ) -> Result<Judged<'w>, EngineError> {
        let input = PeakInput {
            has_others,
            ..PeakInput::of(outcome, self.localizer.frame())
        };
        let find = |ends: &mut Ends| ends.find(scan, &self.space, self.beams());
        peaks.judge(&input, &self.distance_field, config, find)
    }

    /// Returns the beams of a scan as the second stage compares them with the map.
    ///
    /// # Errors
    /// If the scan is rejected, see [`Observation::check`].
    pub fn ends<'s>(&self, scan: impl Into<Observation<'s>>) -> Result<Ends, EngineError> {
        Ends::new(scan, &self.space, self.beams())
    }

    fn beams(&self) -> &BeamConfig {
        &self.localizer.config().votes.beams
    }

    /// The first stage.
    #[must_use]
    pub fn localizer(&self) -> &Localizer {
        &self.localizer
    }

    /// Distance field of the map, for the second stage.
    #[must_use]
    pub fn distance_field(&self) -> &DistanceField {
        &self.distance_field
    }

    /// Settings of the second stage.
    #[must_use]
    pub fn peaks(&self) -> &PeakConfig {
        &self.peaks
    }
}
