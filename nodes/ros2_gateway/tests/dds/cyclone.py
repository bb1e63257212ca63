"""Nodes of a ROS 2 robot by Cyclone DDS itself, with the names that ROS gives to topics and
types. They take orders as JSON, one a line, and say what they see in the same way.
"""

import json
import sys
import threading
import time
import types
from dataclasses import dataclass, fields, is_dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl import types as idl
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


def message(name, **members):
    """A message of ROS: its package, its name and its fields."""
    package, name = name.split("/")
    typename = f"{package}::msg::dds_::{name}_"

    def annotate(namespace):
        namespace["__annotations__"] = members

    return dataclass(types.new_class(name, (IdlStruct,), {"typename": typename}, annotate))


f32, f64, u32 = idl.float32, idl.float64, idl.uint32
Time = message("builtin_interfaces/Time", sec=idl.int32, nanosec=u32)
Header = message("std_msgs/Header", stamp=Time, frame_id=str)
Point = message("geometry_msgs/Point", x=f64, y=f64, z=f64)
Vector3 = message("geometry_msgs/Vector3", x=f64, y=f64, z=f64)
Quaternion = message("geometry_msgs/Quaternion", x=f64, y=f64, z=f64, w=f64)
Pose = message("geometry_msgs/Pose", position=Point, orientation=Quaternion)
Twist = message("geometry_msgs/Twist", linear=Vector3, angular=Vector3)
COVARIANCE = idl.array[f64, 36]
PoseWithCovariance = message("geometry_msgs/PoseWithCovariance", pose=Pose, covariance=COVARIANCE)
TwistWithCovariance = message(
    "geometry_msgs/TwistWithCovariance", twist=Twist, covariance=COVARIANCE
)
Transform = message("geometry_msgs/Transform", translation=Vector3, rotation=Quaternion)
TransformStamped = message(
    "geometry_msgs/TransformStamped", header=Header, child_frame_id=str, transform=Transform
)
TFMessage = message("tf2_msgs/TFMessage", transforms=idl.sequence[TransformStamped])
PoseStamped = message(
    "geometry_msgs/PoseWithCovarianceStamped", header=Header, pose=PoseWithCovariance
)
Odometry = message(
    "nav_msgs/Odometry",
    header=Header,
    child_frame_id=str,
    pose=PoseWithCovariance,
    twist=TwistWithCovariance,
)
LaserScan = message(
    "sensor_msgs/LaserScan",
    header=Header,
    angle_min=f32,
    angle_max=f32,
    angle_increment=f32,
    time_increment=f32,
    scan_time=f32,
    range_min=f32,
    range_max=f32,
    ranges=idl.sequence[f32],
    intensities=idl.sequence[f32],
)
MapMetaData = message(
    "nav_msgs/MapMetaData", map_load_time=Time, resolution=f32, width=u32, height=u32, origin=Pose
)
OccupancyGrid = message(
    "nav_msgs/OccupancyGrid", header=Header, info=MapMetaData, data=idl.sequence[idl.int8]
)
KINDS = {
    "scan": LaserScan,
    "odom": Odometry,
    "map": OccupancyGrid,
    "tf": TFMessage,
    "tf_static": TFMessage,
    "localization/vda5050": message("std_msgs/String", data=str),
    "amcl_pose": PoseStamped,
    "initialpose": PoseStamped,
}
RELIABLE = Policy.Reliability.Reliable(duration(seconds=1))
FRESH = Qos(Policy.Reliability.BestEffort, Policy.Durability.Volatile, Policy.History.KeepLast(5))
USUAL = Qos(RELIABLE, Policy.Durability.Volatile, Policy.History.KeepLast(10))
KEPT = Qos(RELIABLE, Policy.Durability.TransientLocal, Policy.History.KeepLast(1))
QUALITIES = {"scan": FRESH, "map": KEPT, "tf_static": KEPT, "amcl_pose": KEPT}
LEVEL = (0.0, 0.0, 0.0, 1.0)

lock = threading.Lock()


def say(**words):
    with lock:
        print(json.dumps(words), flush=True)


def header(ns, frame):
    return Header(Time(*divmod(ns, 10**9)), frame)


def pose(x, y=0.0):
    return PoseWithCovariance(Pose(Point(x, y, 0.0), Quaternion(*LEVEL)), [0.0] * 36)


def plain(value):
    """A message as JSON."""
    if is_dataclass(value):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    return [plain(one) for one in value] if isinstance(value, (list, tuple)) else value


class Robot:
    def __init__(self, domain, namespace):
        self.participant = DomainParticipant(domain)
        self.namespace = namespace
        self.writers = {}
        self.seen = [time.monotonic()]

    def topic(self, name):
        whole = name if name.startswith("/") else f"{self.namespace.rstrip('/')}/{name}"
        return Topic(self.participant, f"rt{whole}", KINDS[name.strip("/")])

    def put(self, name, sample):
        if name not in self.writers:
            quality = QUALITIES.get(name, USUAL)
            self.writers[name] = DataWriter(self.participant, self.topic(name), quality)
        self.writers[name].write(sample)

    def do_drive(self, ns, beams):
        ranges = [1.0 + 0.01 * index for index in range(beams)]
        scan = LaserScan(header(ns, "laser"), -3.0, 3.0, 6 / beams, 0.0, 0.0, 0.0, 30.0, ranges, [])
        self.put("scan", scan)
        still = TwistWithCovariance(
            Twist(Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)), [0.0] * 36
        )
        self.put("odom", Odometry(header(ns, "odom"), "base_link", pose(1.5), still))

    def do_map(self, width, height):
        cells = [100] * width + [0] * (width * (height - 1))
        info = MapMetaData(Time(0, 0), 0.05, width, height, pose(0.0).pose)
        self.put("map", OccupancyGrid(header(10**18, "map"), info, cells))

    def do_frames(self, topic, ns, frames):
        """Transforms: parent, child and x."""
        self.put(topic, TFMessage([
            TransformStamped(
                header(ns, parent), child, Transform(Vector3(x, 0.0, 0.0), Quaternion(*LEVEL))
            )
            for parent, child, x in frames
        ]))

    def read(self, topic, take):
        reader = DataReader(self.participant, self.topic(topic), QUALITIES.get(topic, USUAL))

        def run():
            for sample in reader.take_iter(timeout=duration(infinite=True)):
                take(sample)

        threading.Thread(target=run, daemon=True).start()

    def do_carry_odometry(self):
        """Odometry as transforms, as the robot's own filter sends it."""

        def carry(odometry):
            place, turn = odometry.pose.pose.position, odometry.pose.pose.orientation
            moved = Transform(Vector3(place.x, place.y, place.z), turn)
            child = odometry.child_frame_id
            self.put("tf", TFMessage([TransformStamped(odometry.header, child, moved)]))

        self.read("odom", carry)

    def do_watch(self):
        """Notes when the transform to the odometry comes."""

        def note(message):
            if message.transforms[0].header.frame_id == "map":
                self.seen.append(time.monotonic())

        self.read("tf", note)

    def do_gap(self):
        """The longest time without the transform since the last call, seconds."""
        now = time.monotonic()
        seen, self.seen = [*self.seen, now], [now]
        say(event="gap", seconds=max(after - before for before, after in zip(seen, seen[1:])))

    def do_click(self, ns, x, y):
        self.put("initialpose", PoseStamped(header(ns, "map"), pose(x, y)))

    def do_subscribe(self, topic):
        self.read(topic, lambda message: say(event=topic, message=plain(message)))


def main():
    domain, namespace = sys.argv[1:]
    robot = Robot(int(domain), namespace)
    say(event="there")
    for line in sys.stdin:
        order = json.loads(line)
        try:
            getattr(robot, "do_" + order.pop("do"))(**order)
        except Exception as error:  # pylint: disable=broad-except
            say(event="failed", reason=repr(error))


main()
