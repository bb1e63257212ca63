"""What a recording holds, as plain values."""

import functools
import math
from dataclasses import dataclass, field

from conftest import RECORDINGS
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory


@dataclass
class Scan:
    """The arguments of `locate` for a recorded scan."""

    stamp_ns: int
    ranges: list
    angles: tuple
    limits: dict
    time_increment: float


@dataclass
class Recorded:
    scans: list = field(default_factory=list)
    odometry: list = field(default_factory=list)
    mount: tuple = None
    occupancy: object = None


def stamp_ns(header):
    return header.stamp.sec * 1_000_000_000 + header.stamp.nanosec


def planar(position, orientation):
    """(x, y, yaw), by the command's formula for yaw."""
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    yaw = math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)
    return position.x, position.y, yaw


@functools.cache
def read(name):
    """Reads a recording of the repository."""
    return read_file(RECORDINGS / name / "recording.mcap")


def read_file(path):
    recorded = Recorded()
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, _, message in reader.iter_decoded_messages():
            take(recorded, channel.topic, message)
    return recorded


def take(recorded, topic, said):
    if topic == "/scan":
        limits = {"range_min": said.range_min, "range_max": said.range_max}
        angles = (said.angle_min, said.angle_increment)
        stamp, time = stamp_ns(said.header), said.time_increment
        recorded.scans.append(Scan(stamp, said.ranges, angles, limits, time))
    elif topic == "/odom":
        pose = said.pose.pose
        at = planar(pose.position, pose.orientation)
        recorded.odometry.append((stamp_ns(said.header), at))
    elif topic == "/tf_static":
        (transform,) = said.transforms
        assert (transform.header.frame_id, transform.child_frame_id) == ("base_link", "laser")
        transform = transform.transform
        recorded.mount = planar(transform.translation, transform.rotation)
    elif topic == "/map":
        recorded.occupancy = said
