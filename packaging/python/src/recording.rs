//! A recording as arrays: scans, odometry, true poses and the map, read by `common/recording`.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use geometry::Pose;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyMemoryError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use recording::{Kind, Message, Mount, RecordingError};
use ros::LaserScan;

use crate::error::{interruptible, of_recording, value};
use crate::map::Map;
use crate::numbers::{self, PoseTuple};
use crate::scan::GivenScan;

/// Largest size of an array of ranges, in readings that were recorded: scans of very different
/// lengths would fill memory with NaN.
const MOST_PADDED: usize = 8;

/// A recording of a drive: scans by topic, odometry, true poses and the map. Made by
/// backcast.read.
#[pyclass(frozen, get_all, module = "backcast")]
pub(crate) struct Recording {
    /// Scans by topic, a dict of LaserScans: one for each laser.
    scans: Py<PyDict>,
    /// Odometry as (stamps_ns, poses): N of int64, nanoseconds, and N × 3, (x, y, yaw) in
    /// metres and radians of the base since the odometry's start; None if there is none.
    odometry: Option<Poses>,
    /// True poses as (stamps_ns, poses): N of int64, nanoseconds, and N × 3, (x, y, yaw) in
    /// metres and radians of the laser in the map; None if there are none.
    truth: Option<Poses>,
    /// The newest map; None if there is none.
    map: Option<Py<Map>>,
}

type Poses = (Py<PyArray1<i64>>, Py<PyArray2<f64>>);

#[pymethods]
impl Recording {
    fn __repr__(&self, py: Python<'_>) -> String {
        let topics = self.scans.bind(py).keys();
        format!("<backcast.Recording with scans of {topics}>")
    }
}

/// The scans of one laser, in the order of their recording; scans[i] is a Scan.
#[pyclass(frozen, module = "backcast")]
pub(crate) struct LaserScans {
    /// Topic of the scans.
    #[pyo3(get)]
    topic: String,
    /// Name of the laser's frame.
    #[pyo3(get)]
    frame: String,
    mount: Option<Mount>,
    messages: Vec<LaserScan>,
}

#[pymethods]
impl LaserScans {
    /// Pose of the laser on the robot, (x, y, yaw) in the base's frame, metres and radians;
    /// None if the recording does not say it.
    #[getter]
    fn mount(&self) -> Option<PoseTuple> {
        let mount = self.mount.as_ref();
        mount.map(|mount| numbers::tuple(mount.base_from_laser))
    }

    /// True if the laser is mounted upside down.
    #[getter]
    fn upside_down(&self) -> bool {
        self.mount.as_ref().is_some_and(|mount| mount.upside_down)
    }

    /// Stamps of the scans, (n,) of int64, nanoseconds since 1970.
    #[getter]
    fn stamps_ns<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i64>> {
        self.of_each(py, |message| message.header.stamp.as_ns())
    }

    /// Ranges, (n, beams) of float32, metres, as they were recorded: NaN and infinite ones
    /// included. A scan with fewer beams than the longest ends with NaN.
    #[getter]
    fn ranges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let lengths = || self.messages.iter().map(|message| message.ranges.len());
        let (scans, beams) = (self.messages.len(), lengths().max().unwrap_or(0));
        let recorded: usize = lengths().sum();
        if scans.saturating_mul(beams) > recorded.saturating_mul(MOST_PADDED) {
            return Err(PyMemoryError::new_err(format!(
                "{scans} scans of up to {beams} ranges, of which {recorded} are recorded; \
                 allowed: one in {MOST_PADDED}: scans[i].ranges has those of one scan"
            )));
        }
        let mut all = Vec::new();
        for message in &self.messages {
            all.extend_from_slice(&message.ranges);
            all.extend(std::iter::repeat_n(f32::NAN, beams - message.ranges.len()));
        }
        PyArray1::from_vec(py, all).reshape([scans, beams])
    }

    /// Bearing of the first range of each scan, (n,), radians.
    #[getter]
    fn angle_min<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_each(py, |message| message.angle_min.into())
    }

    /// Angle from one range to the next, (n,), radians.
    #[getter]
    fn angle_increment<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_each(py, |message| message.angle_increment.into())
    }

    /// Smallest range, (n,), metres.
    #[getter]
    fn range_min<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_each(py, |message| message.range_min.into())
    }

    /// Range from which readings are no returns, (n,), metres.
    #[getter]
    fn range_max<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_each(py, |message| message.range_max.into())
    }

    /// Time from one range to the next, (n,), seconds.
    #[getter]
    fn time_increment<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.of_each(py, |message| message.time_increment.into())
    }

    fn __len__(&self) -> usize {
        self.messages.len()
    }

    /// Raises ValueError if the scan is invalid.
    fn __getitem__(&self, index: isize) -> PyResult<GivenScan> {
        let from_end = self.messages.len().wrapping_add_signed(index);
        let at = usize::try_from(index).unwrap_or(from_end);
        let Some(message) = self.messages.get(at) else {
            let scans = self.messages.len();
            return Err(PyIndexError::new_err(format!(
                "index {index} of {scans} scans"
            )));
        };
        GivenScan::recorded(message, self.mount.as_ref())
    }

    fn __repr__(&self) -> String {
        let (scans, topic) = (self.messages.len(), &self.topic);
        format!("<backcast.LaserScans: {scans} on {topic}>")
    }
}

impl LaserScans {
    fn of_each<'py, T: numpy::Element>(
        &self,
        py: Python<'py>,
        read: impl Fn(&LaserScan) -> T,
    ) -> Bound<'py, PyArray1<T>> {
        PyArray1::from_vec(py, self.messages.iter().map(read).collect())
    }
}

/// Reads a recording: an MCAP file with messages of ROS 2, or a folder of them as rosbag2
/// writes it.
///
/// Scans are those of sensor_msgs/LaserScan on any topic, with the mounts that the
/// transforms of the recording say. Odometry is nav_msgs/Odometry on the only topic or
/// /odom, true poses geometry_msgs/PoseStamped on /ground_truth, the map
/// nav_msgs/OccupancyGrid on the only topic or /map; odom_topic and map_topic name others.
///
/// Raises OSError if the file cannot be read, ValueError if it is no recording, is damaged,
/// or has messages that cannot be used.
#[pyfunction]
#[pyo3(signature = (path, *, odom_topic=None, map_topic=None))]
pub(crate) fn read(
    py: Python<'_>,
    path: PathBuf,
    odom_topic: Option<String>,
    map_topic: Option<String>,
) -> PyResult<Recording> {
    let contents = interruptible(py, move || Contents::read(&path, odom_topic, map_topic))?;
    let scans = PyDict::new(py);
    for (topic, laser) in contents.lasers {
        scans.set_item(&*topic, Py::new(py, laser)?)?;
    }
    let poses = |of: Vec<(i64, Pose)>| -> PyResult<Option<Poses>> {
        let (stamps, poses): (Vec<i64>, Vec<Pose>) = of.into_iter().unzip();
        let stamps_ns = PyArray1::from_vec(py, stamps).unbind();
        Ok((!poses.is_empty()).then_some((stamps_ns, numbers::poses(py, &poses)?)))
    };
    Ok(Recording {
        scans: scans.unbind(),
        odometry: poses(contents.odometry)?,
        truth: poses(contents.truth)?,
        map: contents.map.map(|map| Py::new(py, map)).transpose()?,
    })
}

/// Contents of a recording, before Python's lock is taken.
#[derive(Default)]
struct Contents {
    lasers: BTreeMap<Arc<str>, LaserScans>,
    odometry: Vec<(i64, Pose)>,
    truth: Vec<(i64, Pose)>,
    map: Option<Map>,
}

impl Contents {
    fn read(path: &Path, odom_topic: Option<String>, map_topic: Option<String>) -> PyResult<Self> {
        let failed = |error| of_recording(&error);
        let mut recording = recording::Recording::open(path).map_err(failed)?;
        for (kind, topic) in [(Kind::Odometry, odom_topic), (Kind::Map, map_topic)] {
            if let Some(topic) = topic {
                recording.prefer(kind, &topic).map_err(failed)?;
            }
        }
        let truths = recording.ground_truths().map_err(failed)?.into_iter();
        let mut contents = Contents {
            map: recording.map().map_err(failed)?.map(Map::of),
            truth: truths
                .map(|(stamp_ns, truth)| (stamp_ns, truth.pose))
                .collect(),
            ..Contents::default()
        };
        let odom_topic = recording.topic(Kind::Odometry).map_err(failed)?;
        for record in recording.records_of(&[Kind::Scan, Kind::Odometry]) {
            let record = match record {
                Err(RecordingError::Message { topic, kind, .. })
                    if kind == Kind::Odometry && odom_topic.as_deref() != Some(&*topic) =>
                {
                    continue;
                }
                record => record.map_err(failed)?,
            };
            match record.message {
                Message::Scan(scan) => contents.take(&recording, &record.topic, scan)?,
                Message::Odometry(message) if Some(&record.topic) == odom_topic.as_ref() => {
                    let unusable =
                        |source| recording.unusable(&record.topic, record.log_time_ns, source);
                    let pose = message.pose.pose.planar().map_err(unusable);
                    let pose = pose.map_err(failed)?;
                    contents.odometry.push((message.header.stamp.as_ns(), pose));
                }
                _ => {}
            }
        }
        Ok(contents)
    }

    fn take(
        &mut self,
        recording: &recording::Recording,
        topic: &Arc<str>,
        scan: LaserScan,
    ) -> PyResult<()> {
        let frame = &scan.header.frame_id;
        let laser = match self.lasers.entry(topic.clone()) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                let mount = recording.base_from_laser(frame);
                new.insert(LaserScans {
                    topic: topic.to_string(),
                    frame: frame.clone(),
                    mount: mount.map_err(|error| of_recording(&error))?,
                    messages: Vec::new(),
                })
            }
        };
        if laser.frame != *frame {
            return Err(value(format!(
                "{}: the scans on {topic} have the frames {} and {frame}; allowed: one",
                recording.path().display(),
                laser.frame
            )));
        }
        laser.messages.push(scan);
        Ok(())
    }
}
