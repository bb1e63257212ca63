"""Where on a map was this laser scan taken? Global localization with no initial guess.

    import backcast

    map = backcast.Map.from_yaml("map.yaml")
    localizer = backcast.Localizer(map)
    result = localizer.locate(ranges, angle_min, angle_increment, range_max=30.0)
    if result.verdict == "Unique":
        x, y, yaw = result.pose

All lengths are metres, all angles radians counter-clockwise, all stamps nanoseconds. A pose
is (x, y, yaw) in the map. Answers are those of the command `backcast locate`, to the bit.
"""

from ._backcast import (
    LaserScans,
    Localizer,
    Map,
    Recording,
    Result,
    Scan,
    TrackedPose,
    Tracker,
    __version__,
    read,
)
from .settings import Settings, TrackerSettings

__all__ = [
    "LaserScans",
    "Localizer",
    "Map",
    "Recording",
    "Result",
    "Scan",
    "Settings",
    "TrackedPose",
    "Tracker",
    "TrackerSettings",
    "__version__",
    "read",
]
