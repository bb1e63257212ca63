//! A scan from Python: an array of ranges, with their common angles and limits.

use engine::scan::MAX_RANGES;
use engine::{EngineError, Scan, TimedScan};
use geometry::Pose;
use numpy::{
    PyArray1, PyArrayDescrMethods, PyReadonlyArray1, PyUntypedArray, PyUntypedArrayMethods,
    get_array_module,
};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use recording::Mount;
use ros::LaserScan;

use crate::error::{of_engine, value};
use crate::numbers::{self, PoseTuple};

/// A scan of a laser, with the laser's mount on the robot.
///
/// The arguments are those of Localizer.locate. stamp_ns is the time of the first range,
/// nanoseconds, and time_increment the seconds from one range to the next: with odometry,
/// the motion between them is removed.
///
/// Raises ValueError if the scan is invalid, with the value found and the values allowed.
#[pyclass(frozen, module = "backcast", name = "Scan")]
#[derive(Debug)]
pub(crate) struct GivenScan {
    ranges: Vec<f32>,
    /// Bearing of the first range, radians.
    #[pyo3(get)]
    angle_min: f64,
    /// Angle from one range to the next, radians.
    #[pyo3(get)]
    angle_increment: f64,
    /// Smallest range, metres.
    #[pyo3(get, name = "range_min")]
    range_min_m: f32,
    /// Range from which readings are no returns, metres; infinite for no limit.
    #[pyo3(get, name = "range_max")]
    range_max_m: f32,
    base_from_laser: Option<Pose>,
    /// True if the laser is mounted upside down.
    #[pyo3(get)]
    upside_down: bool,
    /// Time of the first range, nanoseconds.
    #[pyo3(get)]
    stamp_ns: i64,
    /// Time from one range to the next, seconds.
    #[pyo3(get)]
    time_increment: f64,
}

#[pymethods]
impl GivenScan {
    #[new]
    #[pyo3(signature = (
        ranges, angle_min, angle_increment, *, range_min=0.0, range_max=None, mount=None,
        upside_down=false, stamp_ns=0, time_increment=0.0
    ))]
    #[allow(clippy::too_many_arguments)]
    pub(crate) fn new(
        ranges: &Bound<'_, PyAny>,
        angle_min: f64,
        angle_increment: f64,
        range_min: f64,
        range_max: Option<f64>,
        mount: Option<&Bound<'_, PyAny>>,
        upside_down: bool,
        stamp_ns: i64,
        time_increment: f64,
    ) -> PyResult<Self> {
        let scan = GivenScan {
            ranges: metres(ranges)?,
            angle_min,
            angle_increment,
            range_min_m: range_min as f32,
            range_max_m: range_max.unwrap_or(f64::INFINITY) as f32,
            base_from_laser: mount.map(numbers::mount).transpose()?,
            upside_down,
            stamp_ns,
            time_increment,
        };
        scan.checked()
    }

    /// A copy of the ranges, metres, (beams,) of float32, in the order in which they were
    /// measured.
    #[getter(ranges)]
    fn copied_ranges<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f32>> {
        PyArray1::from_slice(py, &self.ranges)
    }

    /// Pose of the laser on the robot, (x, y, yaw) in the base's frame, metres and radians;
    /// None if it is not known.
    #[getter]
    fn mount(&self) -> Option<PoseTuple> {
        self.base_from_laser.map(numbers::tuple)
    }

    fn __repr__(&self) -> String {
        let (ranges, stamp_ns) = (self.ranges.len(), self.stamp_ns);
        format!("<backcast.Scan of {ranges} ranges at {stamp_ns} ns>")
    }
}

impl GivenScan {
    /// Takes a scan of a recording, and the mount of its laser.
    pub(crate) fn recorded(message: &LaserScan, mount: Option<&Mount>) -> PyResult<Self> {
        let scan = GivenScan {
            ranges: message.ranges.clone(),
            angle_min: message.angle_min.into(),
            angle_increment: message.angle_increment.into(),
            range_min_m: message.range_min,
            range_max_m: message.range_max,
            base_from_laser: mount.map(|mount| mount.base_from_laser),
            upside_down: mount.is_some_and(|mount| mount.upside_down),
            stamp_ns: message.header.stamp.as_ns(),
            time_increment: message.time_increment.into(),
        };
        scan.checked()
    }

    fn checked(self) -> PyResult<Self> {
        self.timed().check().map_err(of_engine)?;
        self.check_unit()?;
        Ok(self)
    }

    /// Refuses ranges that cannot be metres: no scan has returns from beyond 100 m alone.
    fn check_unit(&self) -> PyResult<()> {
        const FAR_M: f64 = 100.0;
        let scan = self.above();
        let returns = (0..scan.beams()).filter_map(|beam| scan.reading(beam));
        let nearest = returns.fold(f64::INFINITY, f64::min);
        match nearest.is_finite() && nearest > FAR_M {
            true => Err(value(format!(
                "the nearest of the ranges is {nearest}; allowed: metres, at least one within \
                 {FAR_M}: are they millimetres?"
            ))),
            false => Ok(()),
        }
    }

    /// Returns the scan in the engine's form.
    pub(crate) fn timed(&self) -> TimedScan<'_> {
        TimedScan {
            scan: self.above(),
            stamp_ns: self.stamp_ns,
            time_increment_s: self.time_increment,
            base_from_laser: self.base_from_laser,
        }
    }

    fn above(&self) -> Scan<'_> {
        let as_measured = Scan {
            angle_min: self.angle_min,
            angle_increment: self.angle_increment,
            range_min_m: self.range_min_m,
            range_max_m: self.range_max_m,
            ranges: &self.ranges,
        };
        as_measured.seen_from_above(self.upside_down)
    }
}

/// Returns the scans of a call: a Scan or a list of them in place of ranges, if there are no other
/// values of a scan, or else the one that `alone` makes of ranges and the other values.
pub(crate) fn scans_of(
    given: &Bound<'_, PyAny>,
    has_others: bool,
    alone: impl FnOnce() -> PyResult<GivenScan>,
) -> PyResult<Vec<Py<GivenScan>>> {
    let is_scan = |item: &Bound<'_, PyAny>| item.is_instance_of::<GivenScan>();
    let is_list = given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>();
    let scans = match is_scan(given) {
        true => vec![given.extract()?],
        false if is_list && given.get_item(0).is_ok_and(|first| is_scan(&first)) => {
            given.extract()?
        }
        false => return Ok(vec![Py::new(given.py(), alone()?)?]),
    };
    match has_others {
        false => Ok(scans),
        true => Err(PyTypeError::new_err(
            "angles, limits, mount and times are given with a Scan; allowed: those that are in it",
        )),
    }
}

/// Makes the error of a call without these values of a scan.
pub(crate) fn missing(names: &str) -> PyErr {
    PyTypeError::new_err(format!(
        "{names} is missing; allowed: all, or a Scan or a list of Scans in place of ranges"
    ))
}

/// Converts ranges to 32 bits, like those of messages; NaN and infinite ones stay what they are.
fn metres(given: &Bound<'_, PyAny>) -> PyResult<Vec<f32>> {
    let allowed = "allowed: numbers in a row, metres, best a 1-D numpy array of float32";
    let numpy = get_array_module(given.py())?;
    let array = match given.hasattr("mask")? {
        // Masked readings are no returns.
        true => given
            .call_method1("astype", ("float64",))
            .and_then(|array| array.call_method1("filled", (f64::NAN,))),
        false => numpy.call_method1("asarray", (given,)),
    };
    let array = array.map_err(|error| value(format!("ranges is no array ({error}); {allowed}")))?;
    let array = array.cast::<PyUntypedArray>()?;
    if array.ndim() != 1 {
        let dimensions = array.ndim();
        return Err(value(format!(
            "ranges has {dimensions} dimensions; {allowed}"
        )));
    }
    if !matches!(array.dtype().kind(), b'f' | b'i' | b'u') {
        let dtype = array.dtype();
        return Err(value(format!("ranges has dtype {dtype}; {allowed}")));
    }
    // A broadcast array repeats one number, and takes no memory before it is copied.
    if array.len() > MAX_RANGES {
        return Err(of_engine(EngineError::TooManyRanges(array.len())));
    }
    if let Ok(ranges) = array.extract::<PyReadonlyArray1<'_, f32>>() {
        return Ok(ranges.as_array().to_vec());
    }
    let doubles = array.call_method1("astype", ("float64",))?;
    let doubles: PyReadonlyArray1<'_, f64> = doubles.extract()?;
    Ok(doubles.as_array().iter().map(|&m| m as f32).collect())
}
