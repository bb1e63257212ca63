from collections.abc import Sequence
from os import PathLike
from typing import ClassVar, Literal, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

from .settings import Settings, TrackerSettings

__all__ = [
    "LaserScans",
    "Localizer",
    "Map",
    "Recording",
    "Result",
    "Scan",
    "TrackedPose",
    "Tracker",
    "__version__",
    "read",
]

__version__: str

@final
class Map:
    """An occupancy grid: a map of square cells.

    Made by `Map.from_yaml` or `Map.from_array`; it does not change.
    """

    @staticmethod
    def from_yaml(path: str | PathLike[str]) -> Map:
        """Reads a map in the format of ROS' map_server: a YAML file, and the image that it
        names, a PGM, PNG or BMP.

        An unknown key of the YAML file causes a warning. Raises OSError if a file cannot be
        read, ValueError if one is invalid.
        """
    @staticmethod
    def from_array(
        cells: NDArray[np.int8] | NDArray[np.uint8],
        resolution: float,
        origin: ArrayLike | None = None,
    ) -> Map:
        """Makes a map from cells in the form of nav_msgs/OccupancyGrid: a 2-D array of int8
        with 0 for free to 100 for occupied, per cent, and -1 for unknown; in uint8, 255 is
        unknown.

        Row 0 has the lowest y, column 0 the lowest x, so that cells[row, column] is the
        cell at x = (column + 0.5) · resolution and y = (row + 0.5) · resolution from the
        origin. An image has its rows in the opposite order: numpy.flipud reverses them.

        resolution is the side of a cell in metres. origin is the pose of the outer corner
        of cell (0, 0) in the map, (x, y, yaw) in metres and radians.
        """
    @property
    def resolution(self) -> float:
        """Side of a cell, metres."""
    @property
    def width(self) -> int:
        """Number of cells along x."""
    @property
    def height(self) -> int:
        """Number of cells along y."""
    @property
    def origin(self) -> tuple[float, float, float]:
        """Pose of the outer corner of cell (0, 0) in the map: (x, y, yaw) in metres and
        radians.
        """
    @property
    def cells(self) -> NDArray[np.int8]:
        """A copy of the cells, height × width of int8. Row 0 has the lowest y; 0 is free, 100
        occupied, per cent, and -1 unknown.
        """
    @property
    def id(self) -> str:
        """Identifier of the map by geometry and cells; the command prints it as map_id."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class Localizer:
    """A map that is prepared for locating scans, each by itself.

    Preparing takes from milliseconds to seconds. With heading_known=True only x and y
    are searched, and each scan comes with its heading. The other keywords are the
    engine's settings, those of `backcast locate`, with the same defaults: see
    backcast.Settings.

    Any number of threads may call it at the same time: Python's lock is released while
    the map is prepared and while it is searched. Ctrl-C ends a search at once; while a map
    is prepared, it raises KeyboardInterrupt at once, and the preparing ends in the
    background.
    """

    def __new__(
        cls, map: Map, *, heading_known: bool = False, **settings: Unpack[Settings]
    ) -> Localizer: ...
    @overload
    def locate(
        self,
        ranges: ArrayLike,
        angle_min: float,
        angle_increment: float,
        *,
        range_min: float = 0.0,
        range_max: float | None = None,
        mount: ArrayLike | None = None,
        upside_down: bool = False,
        heading: float | None = None,
    ) -> Result:
        """Finds the places at which a scan may have been taken.

        ranges are metres, in the order in which they were measured; NaN, infinite, zero and
        negative ones, and masked ones, are no returns, as are those below range_min and those at
        or above range_max (metres; None for no limit). Range i has the bearing
        angle_min + i · angle_increment, radians counter-clockwise from the laser's x axis; the
        increment is negative if the laser turns clockwise.

        mount is the pose of the laser on the robot, (x, y, yaw) in the base's frame, metres
        and radians. With it the poses of the result are the base's, otherwise the laser's.
        upside_down means that the laser is mounted rolled by half a turn about its x axis.

        heading is the heading in the map of the base or, without a mount, of the laser,
        radians: it is given if and only if the localizer was made with heading_known=True.

        In place of ranges and what belongs to them, a Scan may be given, or a list of Scans of
        several lasers of one robot, the main one first. Several need mounts on the same base,
        and stamps within a second of the first's. odometry is (stamps_ns, poses) around the
        scans, nanoseconds and N × 3 poses of the base: with it, the motion between the scans
        and within each is removed; without it, the robot counts as standing.

        Raises ValueError if a scan is invalid, with the value found and the values
        allowed.
        """
    @overload
    def locate(
        self,
        ranges: Scan | Sequence[Scan],
        angle_min: None = None,
        angle_increment: None = None,
        *,
        heading: float | None = None,
        odometry: tuple[ArrayLike, ArrayLike] | None = None,
    ) -> Result: ...
    @property
    def map(self) -> Map:
        """The map."""
    @property
    def heading_known(self) -> bool:
        """True if each scan comes with its heading."""
    @property
    def index_bytes(self) -> int:
        """Size of the search index in bytes, in addition to the map's cells."""

@final
class Result:
    """Places at which a scan may have been taken, best first, with a verdict."""

    @property
    def verdict(self) -> Literal["Unique", "Ambiguous", "PoorFit", "NoScan"]:
        """Verdict on the places: "Unique", one place fits and no other comes near it;
        "Ambiguous", several fit about as well; "PoorFit", even the best fits badly, perhaps
        because it is another map; "NoScan", the scan has no usable information.
        """
    @property
    def why(self) -> str:
        """Explanation of the verdict."""
    @property
    def confidence(self) -> float:
        """Probability of the best place, 0 to 1."""
    @property
    def alternatives(self) -> int:
        """Number of other places that fit about as well as the best."""
    @property
    def frame(self) -> Literal["base", "laser"]:
        """Frame of the poses: "base" if a mount was given, otherwise "laser"."""
    @property
    def pose(self) -> tuple[float, float, float] | None:
        """Pose of the best place, (x, y, yaw) in the map, metres and radians; None if there is
        no place. It is the base's pose if a mount was given, otherwise the laser's.
        """
    @property
    def covariance(self) -> NDArray[np.float64] | None:
        """Covariance of pose, 3 × 3 over x, y and yaw in m², m·rad and rad²; None if there is
        no place.
        """
    @property
    def poses(self) -> NDArray[np.float64]:
        """N × 3: x, y and yaw of each place in the map, metres and radians, best first; of the
        base if a mount was given, otherwise of the laser.
        """
    @property
    def covariances(self) -> NDArray[np.float64]:
        """N × 3 × 3: covariance of each pose, over x, y and yaw in m², m·rad and rad²."""
    @property
    def probabilities(self) -> NDArray[np.float64]:
        """N: probability of each place, 0 to 1. The remainder to 1 is the probability that the
        robot is at none of them.
        """
    @property
    def scores(self) -> NDArray[np.float64]:
        """N: score of each place, at most 1: how well the scan fits the map there."""
    @property
    def votes(self) -> NDArray[np.uint16]:
        """N: votes of the best pose that led to each place."""
    @property
    def laser_poses(self) -> NDArray[np.float64]:
        """N × 3: poses, always of the laser."""
    @property
    def laser_covariances(self) -> NDArray[np.float64]:
        """N × 3 × 3: covariances, always of the laser."""
    @property
    def beams_used(self) -> int:
        """Number of beams that voted."""
    def matrix(self) -> NDArray[np.float64] | None:
        """Homogeneous matrix of pose, 3 × 3: map coordinates (x, y, 1) of a point in the frame
        of the pose; None if there is no pose.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

@final
class LaserScans:
    """The scans of one laser, in the order of their recording; scans[i] is a Scan."""

    @property
    def topic(self) -> str:
        """Topic of the scans."""
    @property
    def frame(self) -> str:
        """Name of the laser's frame."""
    @property
    def mount(self) -> tuple[float, float, float] | None:
        """Pose of the laser on the robot, (x, y, yaw) in the base's frame, metres and radians;
        None if the recording does not say it.
        """
    @property
    def upside_down(self) -> bool:
        """True if the laser is mounted upside down."""
    @property
    def stamps_ns(self) -> NDArray[np.int64]:
        """Stamps of the scans, (n,) of int64, nanoseconds since 1970."""
    @property
    def ranges(self) -> NDArray[np.float32]:
        """Ranges, (n, beams) of float32, metres, as they were recorded: NaN and infinite ones
        included. A scan with fewer beams than the longest ends with NaN.
        """
    @property
    def angle_min(self) -> NDArray[np.float64]:
        """Bearing of the first range of each scan, (n,), radians."""
    @property
    def angle_increment(self) -> NDArray[np.float64]:
        """Angle from one range to the next, (n,), radians."""
    @property
    def range_min(self) -> NDArray[np.float64]:
        """Smallest range, (n,), metres."""
    @property
    def range_max(self) -> NDArray[np.float64]:
        """Range from which readings are no returns, (n,), metres."""
    @property
    def time_increment(self) -> NDArray[np.float64]:
        """Time from one range to the next, (n,), seconds."""
    def __len__(self, /) -> int: ...
    def __getitem__(self, index: int, /) -> Scan: ...

@final
class Recording:
    """A recording of a drive: scans by topic, odometry, true poses and the map. Made by
    backcast.read.
    """

    @property
    def scans(self) -> dict[str, LaserScans]:
        """Scans by topic, a dict of LaserScans: one for each laser."""
    @property
    def odometry(self) -> tuple[NDArray[np.int64], NDArray[np.float64]] | None:
        """Odometry as (stamps_ns, poses): N of int64, nanoseconds, and N × 3, (x, y, yaw) in
        metres and radians of the base since the odometry's start; None if there is none.
        """
    @property
    def truth(self) -> tuple[NDArray[np.int64], NDArray[np.float64]] | None:
        """True poses as (stamps_ns, poses): N of int64, nanoseconds, and N × 3, (x, y, yaw) in
        metres and radians of the laser in the map; None if there are none.
        """
    @property
    def map(self) -> Map | None:
        """The newest map; None if there is none."""

def read(
    path: str | PathLike[str], *, odom_topic: str | None = None, map_topic: str | None = None
) -> Recording:
    """Reads a recording: an MCAP file with messages of ROS 2, or a folder of them as rosbag2
    writes it.

    Scans are those of sensor_msgs/LaserScan on any topic, with the mounts that the
    transforms of the recording say. Odometry is nav_msgs/Odometry on the only topic or
    /odom, true poses geometry_msgs/PoseStamped on /ground_truth, the map
    nav_msgs/OccupancyGrid on the only topic or /map; odom_topic and map_topic name others.

    Raises OSError if the file cannot be read, ValueError if it is no recording, is damaged,
    or has messages that cannot be used.
    """

@final
class Scan:
    """A scan of a laser, with the laser's mount on the robot.

    The arguments are those of Localizer.locate. stamp_ns is the time of the first range,
    nanoseconds, and time_increment the seconds from one range to the next: with odometry,
    the motion between them is removed.

    Raises ValueError if the scan is invalid, with the value found and the values allowed.
    """

    def __new__(
        cls,
        ranges: ArrayLike,
        angle_min: float,
        angle_increment: float,
        *,
        range_min: float = 0.0,
        range_max: float | None = None,
        mount: ArrayLike | None = None,
        upside_down: bool = False,
        stamp_ns: int = 0,
        time_increment: float = 0.0,
    ) -> Scan: ...
    @property
    def ranges(self) -> NDArray[np.float32]:
        """A copy of the ranges, metres, (beams,) of float32, in the order in which they were
        measured.
        """
    @property
    def angle_min(self) -> float:
        """Bearing of the first range, radians."""
    @property
    def angle_increment(self) -> float:
        """Angle from one range to the next, radians."""
    @property
    def range_min(self) -> float:
        """Smallest range, metres."""
    @property
    def range_max(self) -> float:
        """Range from which readings are no returns, metres; infinite for no limit."""
    @property
    def mount(self) -> tuple[float, float, float] | None:
        """Pose of the laser on the robot, (x, y, yaw) in the base's frame, metres and radians;
        None if it is not known.
        """
    @property
    def upside_down(self) -> bool:
        """True if the laser is mounted upside down."""
    @property
    def stamp_ns(self) -> int:
        """Time of the first range, nanoseconds."""
    @property
    def time_increment(self) -> float:
        """Time from one range to the next, seconds."""

@final
class Tracker:
    """Finds the robot, and keeps its pose from scan to scan: a single scan may be
    ambiguous or misleading.

    The keywords are the engine's settings and the tracker's, with the same defaults as
    the command's: see backcast.TrackerSettings.

    Python's lock is released while the map is prepared and while a scan is processed. A
    tracker follows one robot: calls from several threads wait for each other.
    """

    def __new__(cls, map: Map, **settings: Unpack[TrackerSettings]) -> Tracker: ...
    def add_odometry(self, stamp_ns: int, pose: ArrayLike) -> None:
        """Takes odometry: the base's pose, (x, y, yaw) since the odometry's start in metres
        and radians, at a time in nanoseconds.

        Odometry must come in order of time, and before the scans that it covers: up to the
        middle of a scan, or to its end if the motion within the scan is to be removed.
        """
    @overload
    def update(
        self,
        ranges: ArrayLike,
        angle_min: float,
        angle_increment: float,
        stamp_ns: int,
        *,
        odometry: ArrayLike | None = None,
        range_min: float = 0.0,
        range_max: float | None = None,
        mount: ArrayLike | None = None,
        upside_down: bool = False,
        time_increment: float = 0.0,
    ) -> TrackedPose:
        """Follows the robot to a scan.

        stamp_ns is the time of the first range, nanoseconds, at least a millisecond after that
        of the last scan, and time_increment the seconds from one range to the next: if odometry
        covers the scan, the motion between them is removed. odometry is the base's pose at that
        time, in the form of add_odometry; it is not needed if that is called. Without any
        odometry, scans are matched to each other.

        The other arguments are those of Localizer.locate: metres and radians, and the
        mount, with which poses are the base's.

        In place of ranges and what belongs to them, a Scan may be given, or a list of Scans of
        several lasers of one robot, the main one first: its stamp is the time. Several need
        mounts on the same base, and stamps within a second of the first's. Each update has as
        many as the first, in the same order; a laser without a new scan repeats the last.

        Raises ValueError if a scan is invalid; the tracker then stays as it was.
        If a signal ends a search, as Ctrl-C does, the scan counts as one whose search has no answer.
        """
    @overload
    def update(
        self,
        ranges: Scan | Sequence[Scan],
        angle_min: None = None,
        angle_increment: None = None,
        stamp_ns: None = None,
        *,
        odometry: ArrayLike | None = None,
    ) -> TrackedPose: ...
    def expect(self, pose: ArrayLike, covariance: ArrayLike | None = None) -> None:
        """Expects the robot at this pose at the next scan: the base's pose, or the laser's without
        a mount, (x, y, yaw) in the map, metres and radians. It is tried first, and believed as
        soon as a scan fits there and no other place within the covariance fits as well. A
        believed pose is kept until then; if there is none, everything else is forgotten. Raises
        ValueError if it is off the map.

        covariance is 3 × 3 over x, y and yaw in m², m·rad and rad²; the default is that of
        standard deviations of 0.5 m and 0.26 rad.
        """
    def reset(self) -> None:
        """Forgets everything: the next scan is the first."""
    @property
    def map(self) -> Map:
        """The map."""

@final
class TrackedPose:
    """Pose of the robot, its certainty, and the reason."""

    @property
    def stamp_ns(self) -> int:
        """Time of the scan, nanoseconds."""
    @property
    def state(self) -> Literal["Searching", "Unique", "Doubtful", "Lost"]:
        """State of the tracker: "Searching", the robot has not been found yet; "Unique", one
        place is left, and the scans fit there; "Doubtful", the pose is kept, but there is
        evidence against it; "Lost", the robot is not there any more.
        """
    @property
    def reason(
        self,
    ) -> Literal[
        "NoScan",
        "OnePlace",
        "SeveralPlaces",
        "TooEarly",
        "PoorFit",
        "OdometryJump",
        "AnotherPlace",
        "NoPlace",
        "NoSearch",
    ]:
        """Reason for the state: "NoScan", "OnePlace", "SeveralPlaces", "TooEarly", "PoorFit",
        "OdometryJump", "AnotherPlace", "NoPlace" or "NoSearch".
        """
    @property
    def why(self) -> str:
        """Explanation of the reason, with what to do."""
    @property
    def frame(self) -> Literal["base", "laser"]:
        """Frame of the pose: "base" if a mount was given, otherwise "laser"."""
    @property
    def pose(self) -> tuple[float, float, float] | None:
        """Pose in the map, (x, y, yaw) in metres and radians: the believed place, otherwise
        the leading one; None if there is no place.
        """
    @property
    def covariance(self) -> NDArray[np.float64] | None:
        """Covariance of pose, 3 × 3 over x, y and yaw in m², m·rad and rad²; if no place is
        believed, it spans all that are kept. None if there is no pose.
        """
    @property
    def laser_pose(self) -> tuple[float, float, float] | None:
        """Pose of the laser in any case, like pose."""
    @property
    def laser_covariance(self) -> NDArray[np.float64] | None:
        """Covariance of the laser in any case, like covariance."""
    @property
    def map_from_odom(self) -> tuple[float, float, float] | None:
        """Pose of the odometry's origin in the map, (x, y, yaw) in metres and radians; None
        without a pose or without odometry.
        """
    @property
    def probability(self) -> float:
        """Probability that the robot is there, 0 to 1."""
    @property
    def score(self) -> float:
        """Score of the scan there, at most 1: how well it fits the map."""
    @property
    def lead(self) -> float:
        """Natural logarithm of the odds of that probability."""
    @property
    def places(self) -> int:
        """Number of places close to the best in weight, including it."""
    @property
    def since_ns(self) -> int:
        """Time at which the state began, nanoseconds."""
    @property
    def since_m(self) -> float:
        """Distance driven since then, metres."""
    @property
    def searched(self) -> bool:
        """True if the whole map was searched for this scan, which takes longer."""
    @property
    def left_out(self) -> list[str]:
        """Lasers whose scans were left out, with the reasons; empty if there are none."""
    def matrix(self) -> NDArray[np.float64] | None:
        """Homogeneous matrix of pose, 3 × 3: map coordinates (x, y, 1) of a point in the frame
        of the pose; None if there is no pose.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]
