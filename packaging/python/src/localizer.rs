//! Localization of single scans, without memory.

use engine::TimedScan;
use engine::localizer::Answer;
use engine::peaks::Target;
use engine::vote_search::Prior;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{detached, value};
use crate::joined;
use crate::map::Map;
use crate::result::{Found, LocateResult};
use crate::scan::{self, GivenScan};
use crate::search::{self, Search};
use crate::settings::EngineSettings;

/// A map that is prepared for locating scans, each by itself.
///
/// Preparing takes from milliseconds to seconds. With heading_known=True only x and y
/// are searched, and each scan comes with its heading. The other keywords are the
/// engine's settings, those of `backcast locate`, with the same defaults: see
/// backcast.Settings.
///
/// Any number of threads may call it at the same time: Python's lock is released while
/// the map is prepared and while it is searched. Ctrl-C ends a search at once; while a map
/// is prepared, it raises KeyboardInterrupt at once, and the preparing ends in the
/// background.
#[pyclass(frozen, module = "backcast")]
pub(crate) struct Localizer {
    /// The map.
    #[pyo3(get)]
    map: Py<Map>,
    search: Search,
    /// True if each scan comes with its heading.
    #[pyo3(get)]
    heading_known: bool,
}

#[pymethods]
impl Localizer {
    #[new]
    #[pyo3(signature = (map, *, heading_known=false, **settings))]
    fn new(
        py: Python<'_>,
        map: Py<Map>,
        heading_known: bool,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let settings = EngineSettings::new(settings)?;
        let prior = match heading_known {
            true => Prior::Heading,
            false => Prior::None,
        };
        let localizer = search::prepare(py, map.get(), settings, prior)?;
        Ok(Localizer {
            map,
            search: Search::new(localizer),
            heading_known,
        })
    }

    /// Finds the places at which a scan may have been taken.
    ///
    /// ranges are metres, in the order in which they were measured; NaN, infinite, zero and
    /// negative ones, and masked ones, are no returns, as are those below range_min and those at
    /// or above range_max (metres; None for no limit). Range i has the bearing
    /// angle_min + i · angle_increment, radians counter-clockwise from the laser's x axis; the
    /// increment is negative if the laser turns clockwise.
    ///
    /// mount is the pose of the laser on the robot, (x, y, yaw) in the base's frame, metres
    /// and radians. With it the poses of the result are the base's, otherwise the laser's.
    /// upside_down means that the laser is mounted rolled by half a turn about its x axis.
    ///
    /// heading is the heading in the map of the base or, without a mount, of the laser,
    /// radians: it is given if and only if the localizer was made with heading_known=True.
    ///
    /// In place of ranges and what belongs to them, a Scan may be given, or a list of Scans of
    /// several lasers of one robot, the main one first. Several need mounts on the same base,
    /// and stamps within a second of the first's. odometry is (stamps_ns, poses) around the
    /// scans, nanoseconds and N × 3 poses of the base: with it, the motion between the scans
    /// and within each is removed; without it, the robot counts as standing.
    ///
    /// Raises ValueError if a scan is invalid, with the value found and the values
    /// allowed.
    #[pyo3(signature = (
        ranges, angle_min=None, angle_increment=None, *, range_min=0.0, range_max=None,
        mount=None, upside_down=false, heading=None, odometry=None
    ))]
    #[allow(clippy::too_many_arguments)]
    fn locate(
        &self,
        py: Python<'_>,
        ranges: &Bound<'_, PyAny>,
        angle_min: Option<f64>,
        angle_increment: Option<f64>,
        range_min: f64,
        range_max: Option<f64>,
        mount: Option<&Bound<'_, PyAny>>,
        upside_down: bool,
        heading: Option<f64>,
        odometry: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<LocateResult> {
        let odometry = odometry.map_or(Ok(Vec::new()), joined::odometry)?;
        let angles = angle_min.zip(angle_increment);
        let is_mounted = mount.is_some() || upside_down;
        let has_angles = angle_min.or(angle_increment).is_some();
        let has_others = has_angles || is_mounted || range_min != 0.0 || range_max.is_some();
        let scans = scan::scans_of(ranges, has_others, || {
            let missing = || scan::missing("angle_min or angle_increment");
            let (start, step) = angles.ok_or_else(missing)?;
            GivenScan::new(
                ranges,
                start,
                step,
                range_min,
                range_max,
                mount,
                upside_down,
                0,
                0.0,
            )
        })?;
        let scans: Vec<TimedScan<'_>> = scans.iter().map(|scan| scan.get().timed()).collect();
        let heading = self.of_laser(heading, &scans[0])?;
        let joiner = joined::join(&scans, &odometry)?;
        let heading = heading.map(|heading| joiner.target_heading(heading));
        let base_from_laser = scans[0].base_from_laser;
        let target = Target::of(base_from_laser, joiner.targets_base());
        let found = detached(py, || {
            let seen = joiner.seen();
            let read = |answer: Answer<'_>| Found::of(answer, target);
            self.search.locate(seen.observation(), heading, read)
        })?;
        found.read(py, base_from_laser)
    }

    /// Size of the search index in bytes, in addition to the map's cells.
    #[getter]
    fn index_bytes(&self) -> usize {
        self.search.map().vote_search().index_bytes()
    }

    fn __repr__(&self) -> String {
        format!("<backcast.Localizer on {}>", self.map.get())
    }
}

impl Localizer {
    /// Returns the heading of the laser, from the given one of the base or the laser.
    fn of_laser(&self, heading: Option<f64>, scan: &TimedScan<'_>) -> PyResult<Option<f64>> {
        match (self.heading_known, heading) {
            (false, Some(heading)) => Err(value(format!(
                "heading is {heading}; allowed: None, unless the localizer was made with \
                 heading_known=True"
            ))),
            (true, None) => Err(value(
                "heading is None; allowed: radians in the map, for the localizer was made with \
                 heading_known=True",
            )),
            (_, heading) => {
                let mount = scan.base_from_laser.unwrap_or_default();
                Ok(heading.map(|heading| heading + mount.yaw))
            }
        }
    }
}
