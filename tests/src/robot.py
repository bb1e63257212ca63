"""A ROS 2 robot as rmw_zenoh puts it on the network, by libraries that know nothing of
this project: zenoh_ros2_sdk for keys, tokens and attachments, rosbags for messages and
their hashes. It says what it sees as JSON, one event a line.
"""

import json
import math
import sys
import threading
import time
from pathlib import Path

import zenoh
import zenoh.ext
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore
from zenoh_ros2_sdk.attachment import Attachment
from zenoh_ros2_sdk.entity import EndpointEntity, EntityKind, NodeEntity
from zenoh_ros2_sdk.keyexpr import (
    endpoint_liveliness_keyexpr,
    node_liveliness_keyexpr,
    topic_keyexpr,
)
from zenoh_ros2_sdk.qos import (
    QosDurability,
    QosProfile,
    QosReliability,
)
from zenoh_ros2_sdk.utils import compute_service_type_hash, ros2_to_dds_type

DOMAIN = 0
STORE = get_typestore(Stores.ROS2_JAZZY)
TYPES = {
    "scan": "sensor_msgs/msg/LaserScan",
    "front/scan": "sensor_msgs/msg/LaserScan",
    "rear/scan": "sensor_msgs/msg/LaserScan",
    "odom": "nav_msgs/msg/Odometry",
    "map": "nav_msgs/msg/OccupancyGrid",
    "tf": "tf2_msgs/msg/TFMessage",
    "tf_static": "tf2_msgs/msg/TFMessage",
    "amcl_pose": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "initialpose": "geometry_msgs/msg/PoseWithCovarianceStamped",
    "hypotheses": "geometry_msgs/msg/PoseArray",
    "/diagnostics": "diagnostic_msgs/msg/DiagnosticArray",
    # Of all robots together.
    "/tf": "tf2_msgs/msg/TFMessage",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/clock": "rosgraph_msgs/msg/Clock",
    "/parameter_events": "rcl_interfaces/msg/ParameterEvent",
    "/rosout": "rcl_interfaces/msg/Log",
}
SERVICE = "std_srvs/srv/Empty"
# What ROS puts into a message without fields.
EMPTY = "uint8 structure_needs_at_least_one_member"
TIME = {"builtin_interfaces/msg/Time": "int32 sec\nuint32 nanosec\n"}

RELIABLE = QosProfile()
KEPT = QosProfile(durability=QosDurability.TRANSIENT_LOCAL, history_depth=1)
SENSOR = QosProfile(reliability=QosReliability.BEST_EFFORT, history_depth=5)

lock = threading.Lock()


def say(**words):
    with lock:
        print(json.dumps(words), flush=True)


def seconds(stamp):
    return stamp.sec * 10**9 + stamp.nanosec


def planar(pose):
    q = pose.orientation
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    return [pose.position.x, pose.position.y, yaw]


class Robot:
    def __init__(self, endpoint, recording, namespace):
        config = zenoh.Config()
        for key, value in {
            "mode": '"peer"',
            "connect/endpoints": json.dumps([endpoint]),
            "connect/timeout_ms": "-1",
            "listen/endpoints": "[]",
            "scouting/multicast/enabled": "false",
            # What is kept for late joiners is dated.
            "timestamping/enabled": "true",
        }.items():
            config.insert_json5(key, value)
        self.session = zenoh.open(config)
        self.namespace = namespace
        self.alive = []
        self.has_hashes = True
        self.ids = 0
        self.sequence = {}
        self.publishers = {}
        self.recorded = {}
        with AnyReader([Path(recording)]) as reader:
            for connection, _, data in reader.messages():
                name = connection.topic.removeprefix("/")
                self.recorded.setdefault(name, []).append(bytes(data))
        self.lidar = self.node("lidar")

    def name(self, topic):
        return topic if topic.startswith("/") else f"{self.namespace.rstrip('/')}/{topic}"

    def node(self, name):
        zid = str(self.session.info.zid())
        node = NodeEntity(DOMAIN, zid, self.next(), name, self.namespace)
        self.token(node_liveliness_keyexpr(node))
        return node

    def next(self):
        self.ids += 1
        return self.ids

    def token(self, key):
        self.alive.append(self.session.liveliness().declare_token(key))

    def know_no_hashes(self):
        """From now on, its nodes are of ROS 2 Humble."""
        self.has_hashes = False

    def type_hash(self, type_hash):
        return type_hash if self.has_hashes else "TypeHashNotSupported"

    def endpoint(self, node, kind, topic, msgtype, type_hash, qos):
        dds, type_hash = ros2_to_dds_type(msgtype), self.type_hash(type_hash)
        entity = EndpointEntity(
            node, self.next(), kind, self.name(topic), dds, type_hash, qos.encode()
        )
        return topic_keyexpr(DOMAIN, self.name(topic), dds, type_hash), (
            endpoint_liveliness_keyexpr(entity)
        )

    def publisher(self, topic, qos=RELIABLE):
        if topic in self.publishers:
            return self.publishers[topic]
        msgtype = TYPES[topic]
        type_hash = STORE.hash_rihs01(msgtype)
        kind = EntityKind.PUBLISHER
        key, token = self.endpoint(self.lidar, kind, topic, msgtype, type_hash, qos)
        if qos is KEPT:
            publisher = zenoh.ext.declare_advanced_publisher(
                self.session,
                key,
                congestion_control=zenoh.CongestionControl.BLOCK,
                cache=zenoh.ext.CacheConfig(max_samples=1),
                sample_miss_detection=zenoh.ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=0.5),
                publisher_detection=True,
            )
        else:
            publisher = self.session.declare_publisher(
                key, congestion_control=zenoh.CongestionControl.BLOCK
            )
            # What is not kept is lost until somebody is there.
            while not publisher.matching_status.matching:
                time.sleep(0.01)
        self.token(token)
        self.publishers[topic] = publisher
        return publisher

    def put(self, topic, data, qos=RELIABLE):
        publisher = self.publisher(topic, qos)
        number = self.sequence[topic] = self.sequence.get(topic, 0) + 1
        sender = topic.encode().ljust(16, b"\0")[:16]
        publisher.put(
            data, attachment=Attachment(number, time.time_ns(), sender).to_bytes()
        )

    def subscribe(self, node, topic, qos=RELIABLE):
        """The token comes last, as in rmw_zenoh."""
        msgtype = TYPES[topic]
        type_hash = STORE.hash_rihs01(msgtype)
        kind = EntityKind.SUBSCRIPTION
        key, token = self.endpoint(node, kind, topic, msgtype, type_hash, qos)

        def take(sample):
            try:
                self.take(topic, msgtype, sample)
            except Exception as error:
                say(event="failed", topic=topic, error=repr(error))

        # Called where it comes in: threads of their own would report topics out of order.
        handler = zenoh.handlers.Callback(take, indirect=False)
        self.alive.append(self.session.declare_subscriber(key, handler))
        self.token(token)

    def take(self, topic, msgtype, sample):
        data = sample.payload.to_bytes()
        message = STORE.deserialize_cdr(data, msgtype)
        attachment = Attachment.from_bytes(sample.attachment.to_bytes())
        words = {
            "event": topic,
            "same": bytes(STORE.serialize_cdr(message, msgtype)) == data,
            "sequence": attachment.sequence_id,
            "sender": attachment.gid.hex(),
            "attachment": len(sample.attachment.to_bytes()),
        }
        if topic == "initialpose":
            covariance = message.pose.covariance
            words |= {
                "stamp": seconds(message.header.stamp),
                "frame": message.header.frame_id,
                "pose": planar(message.pose.pose),
                "variances": [covariance[0], covariance[7], covariance[35]],
            }
        elif topic == "hypotheses":
            words |= {
                "stamp": seconds(message.header.stamp),
                "frame": message.header.frame_id,
                "poses": [planar(pose) for pose in message.poses],
            }
        elif topic in ["tf", "/tf"]:
            first = message.transforms[0]
            if first.header.frame_id != "map":
                return
            place, turn = first.transform.translation, first.transform.rotation
            words |= {
                "stamp": seconds(first.header.stamp),
                "child": first.child_frame_id,
                "pose": [place.x, place.y, 2 * math.atan2(turn.z, turn.w)],
            }
        else:
            words |= {
                "stamp": seconds(message.header.stamp),
                "status": [
                    [s.name, s.level, s.message, {v.key: v.value for v in s.values}]
                    for s in message.status
                ],
            }
        say(**words)

    # Orders

    def arrive(self):
        """What a robot has once: its map and its frames."""
        for topic in ["map", "tf_static"]:
            self.put(topic, self.recorded[topic][0], KEPT)
        self.watcher = self.node("watcher")
        self.subscribe(self.watcher, "hypotheses")
        self.subscribe(self.watcher, "/diagnostics")

    def filter(self):
        """The particle filter comes."""
        self.amcl = self.node("amcl")
        self.subscribe(self.amcl, "initialpose")

    def transforms(self):
        self.subscribe(self.watcher, "tf")

    def scan(self, index):
        for topic, qos in [("odom", RELIABLE), ("scan", SENSOR)]:
            self.put(topic, self.recorded[topic][index], qos)

    def mounts(self, lasers, topic="tf_static"):
        """The frames of lasers: name, x, and a quaternion's x, y, z, w."""
        self.frames(topic, [("base_link", f"{name}_laser", x, turn) for name, x, turn in lasers])

    def correct(self):
        """Another node says where the odometry begins on the map."""
        self.frames("tf", [("map", "odom", 1.0, (0.0, 0.0, 0.0, 1.0))])

    def frames(self, topic, frames):
        t = STORE.types
        stamp = t["builtin_interfaces/msg/Time"](0, 0)
        transforms = [
            t["geometry_msgs/msg/TransformStamped"](
                t["std_msgs/msg/Header"](stamp, parent),
                child,
                t["geometry_msgs/msg/Transform"](
                    t["geometry_msgs/msg/Vector3"](x, 0.0, 0.0),
                    t["geometry_msgs/msg/Quaternion"](*turn),
                ),
            )
            for parent, child, x, turn in frames
        ]
        message = t[TYPES[topic]](transforms)
        self.put(topic, bytes(STORE.serialize_cdr(message, TYPES[topic])), KEPT)

    def scan_of(self, laser, index):
        """A recorded scan, as if it were that laser's."""
        message = STORE.deserialize_cdr(self.recorded["scan"][index], TYPES["scan"])
        message.header.frame_id = f"{laser}_laser"
        self.put(f"{laser}/scan", bytes(STORE.serialize_cdr(message, TYPES["scan"])), SENSOR)

    def believe(self, index, x, y, yaw):
        msgtype = TYPES["amcl_pose"]
        header = STORE.deserialize_cdr(self.recorded["scan"][index], TYPES["scan"]).header
        header.frame_id = "map"
        t = STORE.types
        pose = t["geometry_msgs/msg/Pose"](
            t["geometry_msgs/msg/Point"](x, y, 0.0),
            t["geometry_msgs/msg/Quaternion"](0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)),
        )
        import numpy

        with_covariance = t["geometry_msgs/msg/PoseWithCovariance"](pose, numpy.zeros(36))
        message = t[msgtype](header, with_covariance)
        self.put("amcl_pose", bytes(STORE.serialize_cdr(message, msgtype)))

    def call(self):
        """As a client of the service does."""
        type_hash = compute_service_type_hash(SERVICE, EMPTY, EMPTY, TIME)
        node = self.node("caller")
        topic = "reinitialize_global_localization"
        key, token = self.endpoint(
            node, EntityKind.CLIENT, topic, SERVICE, type_hash, RELIABLE
        )
        self.token(token)
        replies = self.session.get(
            key,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            payload=b"\0\1\0\0\0",
            attachment=Attachment(7, time.time_ns(), b"0123456789abcdef").to_bytes(),
        )
        for reply in replies:
            if reply.ok is None:
                say(event="called", error=reply.err.payload.to_bytes().decode())
                continue
            attachment = Attachment.from_bytes(reply.ok.attachment.to_bytes())
            say(
                event="called",
                reply=reply.ok.payload.to_bytes().hex(),
                sequence=attachment.sequence_id,
                sender=attachment.gid.decode(),
            )

    def tokens(self):
        """Whether each token of the gateway is what the libraries here would write."""
        found, same = [], []
        for reply in self.session.liveliness().get(f"@ros2_lv/{DOMAIN}/**"):
            token = str(reply.ok.key_expr)
            parts = token.split("/")
            if parts[8] != "backcast":
                continue
            node = NodeEntity(DOMAIN, parts[2], int(parts[3]), "backcast", self.namespace)
            if parts[5] == "NN":
                found.append("NN")
                same.append(token == node_liveliness_keyexpr(node))
                continue
            name = parts[9].replace("%", "/")
            known = {self.name(topic): kind for topic, kind in TYPES.items()}
            if name in known:
                msgtype, type_hash = known[name], STORE.hash_rihs01(known[name])
            else:
                msgtype = SERVICE
                type_hash = compute_service_type_hash(SERVICE, EMPTY, EMPTY, TIME)
            entity = EndpointEntity(
                node,
                int(parts[4]),
                EntityKind(parts[5]),
                name,
                ros2_to_dds_type(msgtype),
                type_hash,
                QosProfile.decode(parts[12]).encode(),
            )
            found.append(f"{parts[5]} {name} {parts[12]}")
            same.append(token == endpoint_liveliness_keyexpr(entity))
        say(event="tokens", found=sorted(found), same=all(same))

    def strange(self, topic, payload, attachment):
        """Bytes of no meaning."""
        publisher = self.publisher(topic)
        extra = {} if attachment is None else {"attachment": bytes.fromhex(attachment)}
        publisher.put(bytes.fromhex(payload), **extra)
