//! Tracking of a robot by scans and odometry: the same as `nodes/tracker` in the graph, with the
//! same engine, and searches made in place of those that it requests.

use std::sync::{Mutex, PoisonError};

use engine::joined::{ByOdometry, JoinConfig, Joiner, Kept};
use engine::observation::Observation;
use engine::peaks::Target;
use engine::tracking::{self, Candidate, Need, Seen, TrackingConfig};
use engine::vote_search::Prior;
use geometry::{Covariance, Pose};
use messages::Hypothesis;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{detached, of_engine, value};
use crate::joined::{header, message};
use crate::map::Map;
use crate::numbers;
use crate::scan::GivenScan;
use crate::search::Search;
use crate::settings::TrackerSettings;
use crate::tracked::{Followed, TrackedPose};

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
    map: Py<Map>,
    search: Search,
    config: TrackingConfig,
    join: JoinConfig,
    state: Mutex<State>,
}

/// State that is kept from scan to scan.
#[derive(Debug)]
struct State {
    tracker: tracking::PlaceTracker,
    /// Newest scan, and the motion of the robot.
    joiner: Joiner,
    /// Scan to be searched later, if the tracker needs it.
    asked: Option<Kept>,
    /// Pose of the laser by odometry at the previous scan.
    before: Option<ByOdometry>,
    /// Stamp of the last scan.
    newest_ns: Option<i64>,
    /// Expected pose of the base, and its covariance.
    expected: Option<(Pose, Covariance)>,
}

impl State {
    fn new(config: TrackingConfig, join: JoinConfig) -> Self {
        State {
            tracker: tracking::PlaceTracker::new(config),
            joiner: Joiner::new(join),
            asked: None,
            before: None,
            newest_ns: None,
            expected: None,
        }
    }
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
        let search = Search::prepare(py, map.get(), engine, Prior::None)?;
        let join = JoinConfig {
            motion,
            ..JoinConfig::default()
        };
        Ok(Tracker {
            map,
            search,
            config: tracking,
            state: Mutex::new(State::new(tracking, join.clone())),
            join,
        })
    }

    /// Takes odometry: the base's pose, (x, y, yaw) since the odometry's start in metres
    /// and radians, at a time in nanoseconds.
    ///
    /// Odometry must come in order of time, and before the scans that it covers: up to the
    /// middle of a scan, or to its end if the motion within the scan is to be removed.
    fn add_odometry(&self, py: Python<'_>, stamp_ns: i64, pose: &Bound<'_, PyAny>) -> PyResult<()> {
        let odom_from_base = numbers::pose("pose", pose)?;
        self.with_state(py, |state| {
            state.joiner.on_odometry(&message(stamp_ns, odom_from_base));
            Ok(())
        })
    }

    /// Follows the robot to a scan.
    ///
    /// stamp_ns is the time of the first range, nanoseconds, at least a millisecond after that
    /// of the last scan, and time_increment the seconds
    /// from one range to the next: if odometry covers the scan, the motion between them is
    /// removed. odometry is the base's pose at that time, in the form of add_odometry; it
    /// is not needed if that is called. Without any odometry, scans are matched to each
    /// other.
    ///
    /// The other arguments are those of Localizer.locate: metres and radians, and the
    /// mount, with which poses are the base's.
    ///
    /// Raises ValueError if the scan is invalid; the tracker then stays as it was.
    #[pyo3(signature = (
        ranges, angle_min, angle_increment, stamp_ns, *, odometry=None, range_min=0.0,
        range_max=None, mount=None, upside_down=false, time_increment=0.0
    ))]
    #[allow(clippy::too_many_arguments)]
    fn update(
        &self,
        py: Python<'_>,
        ranges: &Bound<'_, PyAny>,
        angle_min: f64,
        angle_increment: f64,
        stamp_ns: i64,
        odometry: Option<&Bound<'_, PyAny>>,
        range_min: f64,
        range_max: Option<f64>,
        mount: Option<&Bound<'_, PyAny>>,
        upside_down: bool,
        time_increment: f64,
    ) -> PyResult<TrackedPose> {
        let scan = GivenScan::new(
            ranges,
            (angle_min, angle_increment),
            (range_min, range_max),
            (mount, upside_down),
            (stamp_ns, time_increment),
        )?;
        let odom_from_base = odometry
            .map(|given| numbers::pose("odometry", given))
            .transpose()?;
        let followed = self.with_state(py, |state| {
            check_stamp(state.newest_ns, stamp_ns)?;
            if let Some(odom_from_base) = odom_from_base {
                state.joiner.on_odometry(&message(stamp_ns, odom_from_base));
            }
            let followed = self.follow(state, &scan)?;
            state.newest_ns = Some(stamp_ns);
            Ok(followed)
        })?;
        followed.read(py)
    }

    /// Forgets everything, and expects the robot at this pose at the next scan: the base's
    /// pose, or the laser's without a mount, (x, y, yaw) in the map, metres and radians. It
    /// is tried first, and not believed before scans confirm it. Raises ValueError if it is
    /// off the map.
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
        self.map.get().check_holds("pose", pose)?;
        let (metres, radians) = EXPECTED_ERROR;
        let covariance = match covariance {
            Some(given) => numbers::covariance("covariance", given)?,
            None => Covariance::from_deviations(metres, metres, radians),
        };
        self.with_state(py, |state| {
            state.expected = Some((pose, covariance));
            Ok(())
        })
    }

    /// Forgets everything: the next scan is the first.
    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        self.with_state(py, |state| {
            *state = State::new(self.config, self.join.clone());
            Ok(())
        })
    }

    /// The map.
    #[getter]
    fn map(&self, py: Python<'_>) -> Py<Map> {
        self.map.clone_ref(py)
    }

    fn __repr__(&self) -> String {
        format!("<backcast.Tracker on {}>", self.map.get())
    }
}

impl Tracker {
    /// Runs with the state; waits for other threads without Python's lock, so that they can end.
    fn with_state<T: Send>(
        &self,
        py: Python<'_>,
        run: impl FnOnce(&mut State) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        detached(py, || {
            let state = self.state.lock();
            run(&mut state.unwrap_or_else(PoisonError::into_inner))
        })
    }

    fn follow(&self, state: &mut State, scan: &GivenScan) -> PyResult<Followed> {
        let State {
            tracker,
            joiner,
            asked,
            before,
            expected,
            ..
        } = state;
        let map = self.search.map();
        joiner.on_scan(&header(scan), scan.ranges());
        joiner.bring().map_err(|error| of_engine(&error))?;
        let brought = joiner.seen();
        let ends = map.ends(brought.observation());
        let ends = ends.map_err(|error| of_engine(&error))?;
        let target = Target::of(scan.base_from_laser, false);
        if let Some((base, covariance)) = expected.take() {
            let laser = target.from_base(base);
            tracker.expect((0, laser), covariance.carried(base, laser));
        }
        let now = joiner.by_odometry();
        let moved = ByOdometry::between(*before, now);
        *before = now;
        let seen = Seen {
            distance_field: map.distance_field(),
            ends: &ends,
            fit: &map.peaks().fit,
        };
        let found = match tracker.begin(&[seen], scan.stamp_ns, moved) {
            Need::Nothing => None,
            Need::ThisScan => {
                *asked = None;
                Some(self.candidates(brought.observation()))
            }
            Need::EarlierScan => asked
                .take()
                .map(|kept| self.candidates(kept.seen().observation())),
        };
        let searched = found.is_some();
        let (found, interrupt) = match found.transpose() {
            Ok(found) => (found, None),
            Err(interrupt) => (None, Some(interrupt)),
        };
        // A scan that was begun is finished, even if its search was interrupted.
        tracker.finish(&[seen], found.as_deref());
        if tracker.asks_ahead() {
            *asked = Some(Kept::of(&brought));
        }
        match interrupt {
            Some(interrupt) => Err(interrupt),
            None => Ok(Followed {
                stamp_ns: scan.stamp_ns,
                report: tracker.report(),
                base_from_laser: scan.base_from_laser,
                odom_from_laser: now.map(|now| now.odom_from_target),
                searched,
            }),
        }
    }

    /// Searches the map; the candidates pass through the graph's messages, with scores of 32 bits.
    fn candidates(&self, seen: Observation<'_>) -> PyResult<Vec<Candidate>> {
        let of_laser = Target::of(None, false);
        let (verdict, hypotheses) = self.search.locate(seen, None, |found| {
            let places = found.places.places.iter();
            let hypotheses = places.map(|place| place.hypothesis(0, of_laser));
            (
                found.places.verdict,
                hypotheses.collect::<Vec<Hypothesis>>(),
            )
        })?;
        let mut candidates = Vec::new();
        Candidate::fill(
            &mut candidates,
            Some(verdict),
            hypotheses.iter().map(|found| (0, found)),
            of_laser,
        );
        Ok(candidates)
    }
}

/// Checks that a scan is later than the one before, by what nanoseconds allow.
fn check_stamp(newest_ns: Option<i64>, stamp_ns: i64) -> PyResult<()> {
    const LEAST_NS: i64 = 1_000_000;
    let Some(later_ns) = newest_ns.map(|newest| stamp_ns.saturating_sub(newest)) else {
        return Ok(());
    };
    match later_ns >= LEAST_NS {
        true => Ok(()),
        false => Err(value(format!(
            "stamp_ns is {stamp_ns}, {later_ns} after that of the last scan; allowed: at least \
             {LEAST_NS} nanoseconds after it, or reset() for another drive"
        ))),
    }
}
