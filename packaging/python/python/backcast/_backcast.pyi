from os import PathLike
from typing import Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

from .settings import Settings, TrackerSettings

__all__ = ["Localizer", "Map", "Result", "TrackedPose", "Tracker", "__version__"]

__version__: str

@final
class Map:
    """A map of square cells: where obstacles are.

    Made by `Map.from_yaml` or `Map.from_array`; it does not change.
    """

    @staticmethod
    def from_yaml(path: str | PathLike[str]) -> Map:
        """Reads a map as ROS' map_server does: a YAML file, and the image that it names, a
        PGM, PNG or BMP.

        A key of the YAML file that is not known is a warning. OSError if a file cannot be
        read, ValueError if one is not sound.
        """
    @staticmethod
    def from_array(
        cells: NDArray[np.int8] | NDArray[np.uint8],
        resolution: float,
        origin: ArrayLike | None = None,
    ) -> Map:
        """A map from its cells, as in nav_msgs/OccupancyGrid: a 2-D array of int8 with 0 for
        free to 100 for occupied, per cent, and -1 for unknown; in uint8, 255 is unknown.

        Row 0 has the lowest y, column 0 the lowest x, so that cells[row, column] is the
        cell at x = (column + 0.5) · resolution and y = (row + 0.5) · resolution from the
        origin. An image has its rows the other way round: numpy.flipud turns them.

        resolution is the side of a cell in metres. origin is the pose of the outer corner
        of cell (0, 0) in the map, (x, y, yaw) in metres and radians.
        """
    @property
    def resolution(self) -> float:
        """The side of a cell, metres."""
    @property
    def width(self) -> int:
        """Cells along x."""
    @property
    def height(self) -> int:
        """Cells along y."""
    @property
    def origin(self) -> tuple[float, float, float]:
        """The pose of the outer corner of cell (0, 0) in the map: (x, y, yaw) in metres and
        radians.
        """
    @property
    def cells(self) -> NDArray[np.int8]:
        """A copy of the cells, height × width of int8: row 0 has the lowest y; 0 free to 100
        occupied, per cent, -1 unknown.
        """
    @property
    def id(self) -> str:
        """What tells maps apart, by geometry and cells; the command prints it as map_id."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class Localizer:
    """A map that is ready to be asked where scans were taken, each by itself.

    Preparing takes from milliseconds to seconds. With heading_known=True only x and y are
    searched, and each scan comes with its heading. The other keywords are the engine's
    settings, those of `backcast locate`, with the same defaults: see backcast.Settings.

    Any number of threads may ask at once: Python's lock is released while the map is
    prepared and while it is searched. Ctrl-C ends a search.
    """

    def __new__(
        cls, map: Map, *, heading_known: bool = False, **settings: Unpack[Settings]
    ) -> Localizer: ...
    def locate(
        self,
        ranges: ArrayLike,
        angle_min: float,
        angle_increment: float,
        *,
        range_min: float = 0.0,
        range_max: float = ...,
        mount: ArrayLike | None = None,
        upside_down: bool = False,
        heading: float | None = None,
    ) -> Result:
        """Finds the places at which a scan may have been taken.

        ranges are metres, in the order in which they were measured; NaN, infinite, zero and
        negative ones are no returns, as are those below range_min and those at or above
        range_max (metres). Range i has the bearing angle_min + i · angle_increment, radians
        counter-clockwise from the laser's x axis; the increment is below zero where the
        laser turns clockwise.

        mount is where the laser sits on the robot, (x, y, yaw) of the laser in the base's
        frame, metres and radians: then the poses that are found are the base's, else the
        laser's. upside_down says that the laser hangs there rolled by half a turn about its
        x axis.

        heading is that of the base or, without a mount, of the laser in the map, radians:
        it is given if and only if the localizer was made with heading_known=True.

        ValueError if the scan is not sound, with what was found and what is allowed.
        """
    @property
    def map(self) -> Map:
        """The map."""
    @property
    def heading_known(self) -> bool:
        """Whether each scan comes with its heading."""
    @property
    def index_bytes(self) -> int:
        """Bytes of what is kept of the map for searches, beside its cells."""

@final
class Result:
    """Where a scan may have been taken: places, best first, and whether one stands alone."""

    @property
    def verdict(self) -> Literal["Unique", "Ambiguous", "PoorFit", "NoScan"]:
        """What the places allow to say: "Unique", one place fits and no other comes near it;
        "Ambiguous", several fit about as well; "PoorFit", even the best fits badly, perhaps
        it is another map; "NoScan", the scan says nothing.
        """
    @property
    def why(self) -> str:
        """The verdict in words."""
    @property
    def confidence(self) -> float:
        """The best place's probability, 0 to 1."""
    @property
    def alternatives(self) -> int:
        """How many other places fit about as well as the best."""
    @property
    def frame(self) -> Literal["base", "laser"]:
        """Whose poses they are: "base" where a mount was given, else "laser"."""
    @property
    def pose(self) -> tuple[float, float, float] | None:
        """The best place: (x, y, yaw) in the map, metres and radians; None if there is none.
        It is the base's pose where a mount was given, else the laser's.
        """
    @property
    def covariance(self) -> NDArray[np.float64] | None:
        """The covariance of pose, 3 × 3 over x, y and yaw in m², m·rad and rad²; None if there
        is no place.
        """
    @property
    def poses(self) -> NDArray[np.float64]:
        """N × 3: x, y and yaw of each place in the map, metres and radians, best first; of the
        base where a mount was given, else of the laser.
        """
    @property
    def covariances(self) -> NDArray[np.float64]:
        """N × 3 × 3: of each of poses, over x, y and yaw in m², m·rad and rad²."""
    @property
    def probabilities(self) -> NDArray[np.float64]:
        """N: how likely the robot is at each place, 0 to 1. What they leave of 1 is that it is
        at none.
        """
    @property
    def scores(self) -> NDArray[np.float64]:
        """N: how well the scan fits the map at each place, at most 1."""
    @property
    def votes(self) -> NDArray[np.uint16]:
        """N: votes of the best pose that led to each place."""
    @property
    def laser_poses(self) -> NDArray[np.float64]:
        """N × 3: as poses, of the laser in any case."""
    @property
    def laser_covariances(self) -> NDArray[np.float64]:
        """N × 3 × 3: as covariances, of the laser in any case."""
    @property
    def beams_used(self) -> int:
        """Beams that voted."""

@final
class Tracker:
    """Finds the robot, and keeps its pose from scan to scan: one scan alone may not tell where
    it was taken, or tell wrong.

    The keywords are the engine's settings and the tracker's, with the same defaults as the
    command's: see backcast.TrackerSettings.

    Python's lock is released while the map is prepared and while a scan is followed. A
    tracker follows one robot: calls from several threads wait for each other.
    """

    def __new__(cls, map: Map, **settings: Unpack[TrackerSettings]) -> Tracker: ...
    def add_odometry(self, stamp_ns: int, pose: ArrayLike) -> None:
        """Takes odometry: the base's pose, (x, y, yaw) since the odometry's start in metres and
        radians, at a time in nanoseconds.

        It comes in the order of its time, and before the scans that it tells of: up to the
        middle of a scan, or to its end where the motion within the scan is to be taken out.
        """
    def update(
        self,
        ranges: ArrayLike,
        angle_min: float,
        angle_increment: float,
        stamp_ns: int,
        *,
        odometry: ArrayLike | None = None,
        range_min: float = 0.0,
        range_max: float = ...,
        mount: ArrayLike | None = None,
        upside_down: bool = False,
        time_increment: float = 0.0,
    ) -> TrackedPose:
        """Follows the robot to a scan.

        stamp_ns is when its first range was measured, nanoseconds, and time_increment the
        seconds from one range to the next: where odometry tells it, the motion between them
        is taken out. odometry is the base's pose at that time, as add_odometry takes it;
        whoever calls that needs it not. Without any, scans are matched to each other.

        The others are those of Localizer.locate: metres and radians, and the mount, with
        which poses are the base's.

        ValueError if the scan is not sound; the tracker then stays as it was.
        """
    def expect(self, pose: ArrayLike, covariance: ArrayLike | None = None) -> None:
        """Forgets all but where the robot should be at the next scan: the base's pose, or the
        laser's without a mount, (x, y, yaw) in the map, metres and radians. It is tried
        first, and not believed before scans confirm it.

        covariance is 3 × 3 over x, y and yaw in m², m·rad and rad²; by default it is that of
        0.5 m and 0.26 rad.
        """
    def reset(self) -> None:
        """Forgets all: the next scan is the first."""
    @property
    def map(self) -> Map:
        """The map."""

@final
class TrackedPose:
    """Where the robot is, how sure that is, and why."""

    @property
    def stamp_ns(self) -> int:
        """Of the scan, nanoseconds."""
    @property
    def state(self) -> Literal["Searching", "Unique", "Doubtful", "Lost"]:
        """What is known: "Searching", the robot has not been found yet; "Unique", one place is
        left, and the scans fit there; "Doubtful", the pose is kept, but something speaks
        against it; "Lost", the robot is not there any more.
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
    ]:
        """Why, in a word: "NoScan", "OnePlace", "SeveralPlaces", "TooEarly", "PoorFit",
        "OdometryJump", "AnotherPlace" or "NoPlace".
        """
    @property
    def why(self) -> str:
        """Why, in words, and what to do."""
    @property
    def frame(self) -> Literal["base", "laser"]:
        """Whose pose it is: "base" where a mount was given, else "laser"."""
    @property
    def pose(self) -> tuple[float, float, float] | None:
        """(x, y, yaw) in the map, metres and radians: the place that is believed, else the one
        that leads; None if there is none.
        """
    @property
    def covariance(self) -> NDArray[np.float64] | None:
        """The covariance of pose, 3 × 3 over x, y and yaw in m², m·rad and rad²; where no place
        is believed, it spans all that are kept. None if there is no pose.
        """
    @property
    def laser_pose(self) -> tuple[float, float, float] | None:
        """As pose, of the laser in any case."""
    @property
    def laser_covariance(self) -> NDArray[np.float64] | None:
        """As covariance, of the laser in any case."""
    @property
    def map_from_odom(self) -> tuple[float, float, float] | None:
        """Where the odometry's origin lies in the map, (x, y, yaw) in metres and radians; None
        without a pose or without odometry.
        """
    @property
    def probability(self) -> float:
        """How likely the robot is there, 0 to 1."""
    @property
    def score(self) -> float:
        """How well the scan fits there, at most 1."""
    @property
    def lead(self) -> float:
        """Natural logarithm of the odds of that probability."""
    @property
    def places(self) -> int:
        """Places that come near the best, itself included."""
    @property
    def since_ns(self) -> int:
        """When the state began, nanoseconds."""
    @property
    def since_m(self) -> float:
        """Metres gone since."""
    @property
    def searched(self) -> bool:
        """Whether the whole map was searched for this scan, which takes longer."""
