//! Tracking of a robot by scans and odometry: the engine's tracker, behind a lock and with Ctrl-C.

use std::sync::{Mutex, PoisonError};

use engine::vote_search::Prior;
use engine::{Covariance, TimedScan};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{detached, of_engine};
use crate::map::Map;
use crate::numbers;
use crate::scan::{self, GivenScan};
use crate::search;
use crate::settings::TrackerSettings;
use crate::tracked::TrackedPose;

/// Default standard deviations of an expected pose, metres and radians, as in the graph.
const EXPECTED_ERROR: (f64, f64) = (0.5, 0.26);

/// Finds the robot, and keeps its pose from scan to scan: a single scan may be
/// ambiguous or misleading.
///
/// The keywords are the engine's settings and the tracker's, with the same defaults as
/// the command's: see backcast.TrackerSettings.
///
/// Python's lock is released while the map is prepared and while a scan is processed. A
/// tracker follows one robot: calls from several threads wait for each other.
#[pyclass(frozen, module = "backcast")]
pub(crate) struct Tracker {
    /// The map.
    #[pyo3(get)]
    map: Py<Map>,
    tracker: Mutex<engine::Tracker>,
}

#[pymethods]
impl Tracker {
    #[new]
    #[pyo3(signature = (map, **settings))]
    fn new(py: Python<'_>, map: Py<Map>, settings: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let TrackerSettings {
            engine,
            tracking,
            motion,
        } = TrackerSettings::new(settings)?;
        let localizer = search::prepare(py, map.get(), engine, Prior::None)?;
        let settings = engine::TrackerSettings { tracking, motion };
        Ok(Tracker {
            map,
            tracker: Mutex::new(engine::Tracker::new(localizer, settings)),
        })
    }

    /// Takes odometry: the base's pose, (x, y, yaw) since the odometry's start in metres
    /// and radians, at a time in nanoseconds.
    ///
    /// Odometry must come in order of time, and before the scans that it covers: up to the
    /// middle of a scan, or to its end if the motion within the scan is to be removed.
    fn add_odometry(&self, py: Python<'_>, stamp_ns: i64, pose: &Bound<'_, PyAny>) -> PyResult<()> {
        let odom_from_base = numbers::pose("pose", pose)?;
        self.with_tracker(py, |tracker| {
            let added = tracker.add_odometry(stamp_ns, odom_from_base);
            added.map_err(of_engine)
        })
    }

    /// Follows the robot to a scan.
    ///
    /// stamp_ns is the time of the first range, nanoseconds, at least a millisecond after that
    /// of the last scan, and time_increment the seconds from one range to the next: if odometry
    /// covers the scan, the motion between them is removed. odometry is the base's pose at that
    /// time, in the form of add_odometry; it is not needed if that is called. Without any
    /// odometry, scans are matched to each other.
    ///
    /// The other arguments are those of Localizer.locate: metres and radians, and the
    /// mount, with which poses are the base's.
    ///
    /// In place of ranges and what belongs to them, a Scan may be given, or a list of Scans of
    /// several lasers of one robot, the main one first: its stamp is the time. Several need
    /// mounts on the same base, and stamps within a second of the first's. Each update has as
    /// many as the first, in the same order; a laser without a new scan repeats the last.
    ///
    /// Raises ValueError if a scan is invalid; the tracker then stays as it was.
    /// If a signal ends a search, as Ctrl-C does, the scan counts as one whose search has no answer.
    #[pyo3(signature = (
        ranges, angle_min=None, angle_increment=None, stamp_ns=None, *, odometry=None,
        range_min=0.0, range_max=None, mount=None, upside_down=false, time_increment=0.0
    ))]
    #[allow(clippy::too_many_arguments)]
    fn update(
        &self,
        py: Python<'_>,
        ranges: &Bound<'_, PyAny>,
        angle_min: Option<f64>,
        angle_increment: Option<f64>,
        stamp_ns: Option<i64>,
        odometry: Option<&Bound<'_, PyAny>>,
        range_min: f64,
        range_max: Option<f64>,
        mount: Option<&Bound<'_, PyAny>>,
        upside_down: bool,
        time_increment: f64,
    ) -> PyResult<TrackedPose> {
        let values = (angle_min, angle_increment, stamp_ns);
        let is_mounted = mount.is_some() || upside_down;
        let has_others = values != (None, None, None)
            || (range_min, range_max) != (0.0, None)
            || is_mounted
            || time_increment != 0.0;
        let scans = scan::scans_of(ranges, has_others, || match values {
            (Some(angle_min), Some(angle_increment), Some(stamp_ns)) => GivenScan::new(
                ranges,
                angle_min,
                angle_increment,
                range_min,
                range_max,
                mount,
                upside_down,
                stamp_ns,
                time_increment,
            ),
            _ => Err(scan::missing("angle_min, angle_increment or stamp_ns")),
        })?;
        let scans: Vec<TimedScan<'_>> = scans.iter().map(|scan| scan.get().timed()).collect();
        let odom_from_base = odometry.map(|given| numbers::pose("odometry", given));
        let odom_from_base = odom_from_base.transpose()?;
        let tracked = self.with_tracker(py, |tracker| {
            search::until_signal(|stop| {
                tracker.check(&scans)?;
                if let Some(odom_from_base) = odom_from_base {
                    tracker.add_odometry(scans[0].stamp_ns, odom_from_base)?;
                }
                tracker.update_unless(&scans, stop)
            })
        })?;
        TrackedPose::of(py, &tracked)
    }

    /// Expects the robot at this pose at the next scan: the base's pose, or the laser's without
    /// a mount, (x, y, yaw) in the map, metres and radians. It is tried first, and believed as
    /// soon as a scan fits there and no other place within the covariance fits as well. A
    /// believed pose is kept until then; if there is none, everything else is forgotten. Raises
    /// ValueError if it is off the map.
    ///
    /// covariance is 3 × 3 over x, y and yaw in m², m·rad and rad²; the default is that of
    /// standard deviations of 0.5 m and 0.26 rad.
    #[pyo3(signature = (pose, covariance=None))]
    fn expect(
        &self,
        py: Python<'_>,
        pose: &Bound<'_, PyAny>,
        covariance: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let pose = numbers::pose("pose", pose)?;
        let (metres, radians) = EXPECTED_ERROR;
        let covariance = match covariance {
            Some(given) => numbers::covariance("covariance", given)?,
            None => Covariance::from_deviations(metres, metres, radians),
        };
        self.with_tracker(py, |tracker| {
            let expected = tracker.expect((0, pose), covariance);
            expected.map_err(of_engine)
        })
    }

    /// Forgets everything: the next scan is the first.
    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        self.with_tracker(py, |tracker| {
            tracker.reset();
            Ok(())
        })
    }

    fn __repr__(&self) -> String {
        format!("<backcast.Tracker on {}>", self.map.get())
    }
}

impl Tracker {
    /// Runs with the tracker; waits for other threads without Python's lock, so that they can end.
    fn with_tracker<T: Send>(
        &self,
        py: Python<'_>,
        run: impl FnOnce(&mut engine::Tracker) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        detached(py, || {
            let tracker = self.tracker.lock();
            run(&mut tracker.unwrap_or_else(PoisonError::into_inner))
        })
    }
}
