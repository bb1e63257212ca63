"""A ROS 2 robot on DDS by ROS's own rclpy. It takes orders as JSON, one a line, and says what
it sees in the same way.
"""

import itertools
import json
import math
import struct
import sys
import threading
import time
from pathlib import Path

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from lifecycle_msgs.srv import ChangeState, GetState
from nav_msgs.msg import OccupancyGrid, Odometry
from rcl_interfaces.msg import Parameter, ParameterValue
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from rosbags.highlevel import AnyReader
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Header
from std_srvs.srv import Empty

KEPT = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
TAKEN = {
    "initialpose": (PoseWithCovarianceStamped, 10),
    "amcl_pose": (PoseWithCovarianceStamped, KEPT),
    "hypotheses": (PoseArray, 10),
    "/diagnostics": (DiagnosticArray, 10),
}

lock = threading.Lock()


def say(**words):
    with lock:
        print(json.dumps(words), flush=True)


def header(ns, frame):
    message = Header(frame_id=frame)
    message.stamp.sec, message.stamp.nanosec = divmod(ns, 10**9)
    return message


def planar(pose):
    q = pose.orientation
    return [pose.position.x, pose.position.y, q.z, q.w]


def yaw_of(turn):
    return 2 * math.atan2(turn.z, turn.w)


def stamp_of(message):
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def stamped(cdr, ns):
    """The bytes of a message that begins with a header, with another stamp."""
    return cdr[:4] + struct.pack("<iI", *divmod(ns, 10**9)) + cdr[12:]


def content(message):
    """What a test compares of a message."""
    if isinstance(message, DiagnosticArray):
        return {"names": [status.name for status in message.status]}
    poses = message.poses if isinstance(message, PoseArray) else [message.pose.pose]
    return {
        "stamp": stamp_of(message),
        "frame": message.header.frame_id,
        "poses": [planar(pose) for pose in poses],
    }


class Robot(Node):
    def __init__(self, namespace, beams):
        super().__init__("robot", namespace=namespace)
        self.beams = beams
        self.publishers_by_topic = {}
        self.clients_by_service = {}
        self.kept = []
        # The true pose of the base now, and by the stamps of scans.
        self.here = None
        self.truths = {}
        self.is_localized = threading.Event()
        self.step = 0

    def put(self, kind, topic, quality, message):
        if topic not in self.publishers_by_topic:
            self.publishers_by_topic[topic] = self.create_publisher(kind, topic, quality)
        self.publishers_by_topic[topic].publish(message)

    def scan(self, ns):
        scan = LaserScan(header=header(ns, "laser"), range_max=30.0)
        scan.angle_min, scan.angle_increment = -3.0, 6.0 / self.beams
        scan.angle_max = scan.angle_min + scan.angle_increment * (self.beams - 1)
        scan.ranges = [1.0 + 0.01 * index for index in range(self.beams)]
        self.put(LaserScan, "scan", qos_profile_sensor_data, scan)

    def odometry(self, ns, quality):
        odometry = Odometry(header=header(ns, "odom"), child_frame_id="base_link")
        odometry.pose.pose.position.x = 1.5
        self.put(Odometry, "odom", quality, odometry)

    def do_drive(self, ns, best_effort=False):
        self.scan(ns)
        self.odometry(ns, BEST_EFFORT if best_effort else 10)

    def do_play(self, rate, seconds):
        """Scans and odometry of now, as a robot sends them."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.do_drive(time.time_ns())
            time.sleep(1 / rate)
        say(event="played")

    def do_replay(self, file, mount, start=0):
        """A recorded robot drives there and back again and again, by the clock of now; its laser
        is `mount` metres ahead of its base.
        """
        recorded, truths = {}, {}
        with AnyReader([Path(file)]) as reader:
            for connection, ns, cdr in reader.messages():
                recorded.setdefault(connection.topic, {})[ns] = bytes(cdr)
                if connection.topic == "/ground_truth":
                    laser = reader.deserialize(cdr, connection.msgtype).pose
                    at, yaw = laser.position, yaw_of(laser.orientation)
                    back = [mount * math.cos(yaw), mount * math.sin(yaw)]
                    truths[ns] = (at.x - back[0], at.y - back[1], yaw)
        scans, odometry = recorded["/scan"], recorded["/odom"]
        steps = [(ns, scan, odometry[ns], truths.get(ns)) for ns, scan in scans.items()]
        steps += steps[-2:0:-1]
        self.put(OccupancyGrid, "map", KEPT, *recorded["/map"].values())
        threading.Thread(target=self.replay, args=[steps, start], daemon=True).start()

    def replay(self, steps, start):
        due = time.monotonic()
        for index in itertools.count(start):
            ns, scan, odometry, truth = steps[index % len(steps)]
            now = time.time_ns()
            self.here = truth or self.here
            self.truths[now] = truth
            self.step = index
            self.put(Odometry, "odom", 10, stamped(odometry, now))
            self.put(LaserScan, "scan", qos_profile_sensor_data, stamped(scan, now))
            due += abs(steps[(index + 1) % len(steps)][0] - ns) * 1e-9
            time.sleep(max(0.0, due - time.monotonic()))

    def do_step(self):
        say(event="step", step=self.step)

    def do_track(self):
        """Says of each pose how far it is from the true one, where that is known."""

        def take(message):
            self.is_localized.set()
            stamp = stamp_of(message)
            if truth := self.truths.get(stamp):
                x, y, turned = truth
                covariance = message.pose.covariance
                at, yaw = message.pose.pose.position, yaw_of(message.pose.pose.orientation)
                say(
                    event="pose",
                    at=time.monotonic_ns(),
                    stamp=stamp,
                    deviation=math.sqrt(covariance[0] + covariance[7]),
                    metres=math.hypot(at.x - x, at.y - y),
                    radians=abs(math.remainder(yaw - turned, math.tau)),
                )

        taken = self.create_subscription(PoseWithCovarianceStamped, "amcl_pose", take, KEPT)
        self.kept.append(taken)
        # There before the first click, as that of an operator's tool.
        kind, topic = PoseWithCovarianceStamped, "initialpose"
        self.publishers_by_topic[topic] = self.create_publisher(kind, topic, 10)

    def point(self, off):
        """A click so far from where the robot is, without a covariance."""
        while self.here is None:
            time.sleep(0.01)
        x, y, yaw = (here + more for here, more in zip(self.here, off))
        pose = PoseWithCovarianceStamped(header=header(time.time_ns(), "map"))
        pose.pose.pose.position.x, pose.pose.pose.position.y = x, y
        turn = pose.pose.pose.orientation
        turn.z, turn.w = math.sin(yaw / 2), math.cos(yaw / 2)
        self.put(PoseWithCovarianceStamped, "initialpose", 10, pose)

    def do_point(self, off, clicks, seconds):
        for _ in range(clicks):
            self.point(off)
            time.sleep(seconds / clicks)
        say(event="pointed")

    def do_bring_up(self):
        """As a lifecycle manager does it."""
        for label, transition in [("unconfigured", 1), ("inactive", 3)]:
            if self.state().label == label:
                self.change(transition)
        say(event="brought_up", label=self.state().label)

    def do_navigate(self, off):
        """As setInitialPose() and waitUntilNav2Active() of Simple Commander do it."""
        begin = time.monotonic()
        self.is_localized.clear()
        self.point(off)
        while True:
            is_active = self.state().label == "active"
            time.sleep(2)
            if is_active:
                break
        while not self.is_localized.is_set():
            self.point(off)
            self.is_localized.wait(1)
        say(event="navigating", seconds=time.monotonic() - begin)

    def do_map(self, width, height, kept=True):
        grid = OccupancyGrid(header=header(10**18, "map"))
        grid.info.width, grid.info.height, grid.info.resolution = width, height, 0.05
        grid.info.origin.orientation.w = 1.0
        cells = bytearray(width * height)
        cells[:width] = bytes([100]) * width
        grid.data.frombytes(bytes(cells))
        self.put(OccupancyGrid, "map", KEPT if kept else 1, grid)

    def do_wrong_type(self, topic):
        self.put(PoseArray, topic, 10, PoseArray())

    def do_click(self, ns, x, y):
        pose = PoseWithCovarianceStamped(header=header(ns, "map"))
        pose.pose.pose.position.x, pose.pose.pose.position.y = x, y
        pose.pose.pose.orientation.w = 1.0
        pose.pose.covariance[0] = pose.pose.covariance[7] = 0.25
        pose.pose.covariance[35] = 0.07
        self.put(PoseWithCovarianceStamped, "initialpose", 10, pose)

    def do_subscribe(self, topic):
        kind, quality = TAKEN[topic]

        def take(message):
            say(event=topic, **content(message))

        self.kept.append(self.create_subscription(kind, topic, take, quality))

    def ask(self, kind, service, request):
        if service not in self.clients_by_service:
            self.clients_by_service[service] = self.create_client(kind, service)
        client = self.clients_by_service[service]
        if not client.wait_for_service(timeout_sec=60):
            raise TimeoutError(service)
        # Again and again: what is sent to a server that has just ended has no answer.
        for _ in range(30):
            done = threading.Event()
            future = client.call_async(request)
            future.add_done_callback(lambda _, done=done: done.set())
            if done.wait(2):
                return future.result()
        raise TimeoutError(f"no answer of {service}")

    def state(self):
        return self.ask(GetState, "amcl/get_state", GetState.Request()).current_state

    def change(self, transition):
        request = ChangeState.Request()
        request.transition.id = transition
        return self.ask(ChangeState, "amcl/change_state", request).success

    def do_state(self):
        state = self.state()
        say(event="state", id=state.id, label=state.label)

    def do_change(self, id):
        say(event="change", success=self.change(id))

    def do_parameters(self, name, value):
        listed = self.ask(ListParameters, "amcl/list_parameters", ListParameters.Request())
        parameter = Parameter(name=name, value=ParameterValue(type=3, double_value=value))
        request = SetParameters.Request(parameters=[parameter])
        results = self.ask(SetParameters, "amcl/set_parameters", request).results
        request = GetParameters.Request(names=[name])
        values = self.ask(GetParameters, "amcl/get_parameters", request).values
        say(
            event="parameters",
            listed=list(listed.result.names),
            successful=results[0].successful,
            value=values[0].double_value,
        )

    def do_reinitialize(self, clients):
        """Many clients at once, each with a call."""
        for index in range(clients):
            client = self.create_client(Empty, "reinitialize_global_localization")
            self.kept.append(client)
        answered = threading.Semaphore(0)
        for client in self.kept[-clients:]:
            if not client.wait_for_service(timeout_sec=60):
                raise TimeoutError("reinitialize_global_localization")
            client.call_async(Empty.Request()).add_done_callback(lambda _: answered.release())
        missing = sum(not answered.acquire(timeout=60) for _ in range(clients))
        say(event="reinitialized", missing=missing)

    def do_nodes(self, topic):
        publishers = self.get_publishers_info_by_topic(self.resolve_topic_name(topic))
        say(
            event="nodes",
            nodes=[f"{ns.rstrip('/')}/{name}" for name, ns in self.get_node_names_and_namespaces()],
            publishers=[publisher.node_name for publisher in publishers],
        )


def obey(robot):
    for line in sys.stdin:
        order = json.loads(line)
        try:
            getattr(robot, "do_" + order.pop("do"))(**order)
        except Exception as error:  # pylint: disable=broad-except
            say(event="failed", reason=repr(error))
    rclpy.try_shutdown()


def main():
    namespace, beams = sys.argv[1:]
    rclpy.init()
    robot = Robot(namespace, int(beams))
    threading.Thread(target=obey, args=[robot], daemon=True).start()
    say(event="there")
    executor = SingleThreadedExecutor()
    executor.add_node(robot)
    try:
        executor.spin()
    except ExternalShutdownException:
        pass


main()
