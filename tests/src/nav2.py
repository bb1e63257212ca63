

# A robot with Nav2: its lifecycle manager and its tools, and the loop that takes orders as
# JSON, one a line.
#
#     robot.py nav2.py ENDPOINT RECORDING NAMESPACE

import dataclasses
import re

import numpy
from rosbags.interfaces import Nodetype
from rosbags.typesys import get_types_from_msg
from zenoh_ros2_sdk import utils

# What rosbags does not bring.
DEFINITIONS = {
    "nav2_msgs/msg/Particle": "geometry_msgs/Pose pose\nfloat64 weight\n",
    "nav2_msgs/msg/ParticleCloud": "std_msgs/Header header\nnav2_msgs/Particle[] particles\n",
    "bond/msg/Status": (
        "std_msgs/Header header\nstring id\nstring instance_id\nbool active\n"
        "float32 heartbeat_timeout\nfloat32 heartbeat_period\n"
    ),
    "backcast_msgs/msg/Localization": (
        "uint8 SEARCHING=0\nuint8 UNIQUE=1\nuint8 DOUBTFUL=2\nuint8 LOST=3\n"
        "std_msgs/Header header\nuint8 state\nfloat64 probability\n"
        "builtin_interfaces/Time since\nuint32 alternatives\nstring map_id\nbool pose_known\n"
        "geometry_msgs/PoseWithCovariance pose\nstring reason\n"
    ),
}
# Of these, all that they hold is said.
WHOLE = ["bond", "amcl/transition_event", "localization", "/parameter_events", "/rosout"]
TYPES |= {
    "particle_cloud": "nav2_msgs/msg/ParticleCloud",
    "bond": "bond/msg/Status",
    "amcl/transition_event": "lifecycle_msgs/msg/TransitionEvent",
    "localization": "backcast_msgs/msg/Localization",
}
NAMES, VALUES = "string[] names\n", "rcl_interfaces/Parameter[] parameters\n"
RESULT = "rcl_interfaces/SetParametersResult"
TRANSITIONS = "lifecycle_msgs/TransitionDescription[] available_transitions\n"
POSE = "geometry_msgs/PoseWithCovarianceStamped pose\n"
# By name: the type, and what request and response are made of.
SERVICES = {
    "amcl/change_state": (
        "lifecycle_msgs/srv/ChangeState",
        "lifecycle_msgs/Transition transition\n",
        "bool success\n",
    ),
    "amcl/get_state": (
        "lifecycle_msgs/srv/GetState",
        EMPTY,
        "lifecycle_msgs/State current_state\n",
    ),
    "amcl/get_available_states": (
        "lifecycle_msgs/srv/GetAvailableStates",
        EMPTY,
        "lifecycle_msgs/State[] available_states\n",
    ),
    "amcl/get_available_transitions": (
        "lifecycle_msgs/srv/GetAvailableTransitions",
        EMPTY,
        TRANSITIONS,
    ),
    "amcl/get_transition_graph": (
        "lifecycle_msgs/srv/GetAvailableTransitions",
        EMPTY,
        TRANSITIONS,
    ),
    "amcl/get_parameters": (
        "rcl_interfaces/srv/GetParameters",
        NAMES,
        "rcl_interfaces/ParameterValue[] values\n",
    ),
    "amcl/get_parameter_types": (
        "rcl_interfaces/srv/GetParameterTypes",
        NAMES,
        "uint8[] types\n",
    ),
    "amcl/set_parameters": (
        "rcl_interfaces/srv/SetParameters",
        VALUES,
        f"{RESULT}[] results\n",
    ),
    "amcl/set_parameters_atomically": (
        "rcl_interfaces/srv/SetParametersAtomically",
        VALUES,
        f"{RESULT} result\n",
    ),
    "amcl/list_parameters": (
        "rcl_interfaces/srv/ListParameters",
        "string[] prefixes\nuint64 depth\n",
        "rcl_interfaces/ListParametersResult result\n",
    ),
    "amcl/describe_parameters": (
        "rcl_interfaces/srv/DescribeParameters",
        NAMES,
        "rcl_interfaces/ParameterDescriptor[] descriptors\n",
    ),
    "amcl/get_type_description": (
        "type_description_interfaces/srv/GetTypeDescription",
        "string type_name\nstring type_hash\nbool include_type_sources true\n",
        "bool successful\nstring failure_reason\n"
        "type_description_interfaces/TypeDescription type_description\n"
        "type_description_interfaces/TypeSource[] type_sources\n"
        "type_description_interfaces/KeyValue[] extra_information\n",
    ),
    "set_initial_pose": ("nav2_msgs/srv/SetInitialPose", POSE, EMPTY),
    "request_nomotion_update": (SERVICE, EMPTY, EMPTY),
    "reinitialize_global_localization": (SERVICE, EMPTY, EMPTY),
}


def parse(text, unbounded=utils._parse_msg_definition):
    """Fields with bounded lists of any type; the library reads those of texts alone."""
    bounds = {name: int(most) for most, name in re.findall(r"\[<=(\d+)\]\s+(\w+)", text)}
    fields = unbounded(re.sub(r"\[<=\d+\]", "[]", text))
    for field in fields:
        if most := bounds.get(field["name"]):
            field |= {"is_bounded": True, "array_size": most}
    return fields


utils._parse_msg_definition = parse


def register():
    texts = dict(DEFINITIONS)
    for name, request, response in SERVICES.values():
        for part, text in [("Request", request), ("Response", response)]:
            texts[f"{name.replace('/srv/', '/msg/')}_{part}"] = text
    types = {}
    for name, text in texts.items():
        if name not in STORE.types:
            types |= get_types_from_msg(text, name)
    STORE.register(types)


register()


def part_of(service, part):
    return f"{SERVICES[service][0].replace('/srv/', '/msg/')}_{part}"


def service_hash(service):
    """As a client has it in its keys."""
    name, request, response = SERVICES[service]
    parts = dict(TIME)
    for part in ["Request", "Response"]:
        text, _ = STORE.generate_msgdef(part_of(service, part), ros_version=2)
        for below in text.split("=" * 80)[1:]:
            first, fields = below.strip().removeprefix("MSG: ").split("\n", 1)
            package, kind = first.split("/")
            parts[f"{package}/msg/{kind}"] = fields
    return compute_service_type_hash(name, request, response, parts)


NUMBERS = {"string": "", "bool": False, "float64": 0.0, "float32": 0.0}


def build(kind, value):
    """A message or a part of one from JSON; what is not there is nothing."""
    node, of = kind
    if node == Nodetype.BASE:
        return NUMBERS.get(of[0], 0) if value is None else value
    if node == Nodetype.NAME:
        value = value or {}
        fields = STORE.fielddefs[of][1]
        return STORE.types[of](**{name: build(kind, value.get(name)) for name, kind in fields})
    inner, length = of
    nothing = [None] * (length if node == Nodetype.ARRAY else 0)
    values = [build(inner, one) for one in value or nothing]
    if inner[0] == Nodetype.BASE and inner[1][0] != "string":
        return numpy.array(values, dtype={"octet": "uint8"}.get(inner[1][0], inner[1][0]))
    return values


def plain(value):
    """JSON of a message."""
    if dataclasses.is_dataclass(value):
        names = [field.name for field in dataclasses.fields(value)]
        # Constants stand there, too.
        names = [name for name in names if not name.startswith("__") and not name.isupper()]
        return {name: plain(getattr(value, name)) for name in names}
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    return value.tolist() if hasattr(value, "tolist") else value


class Nav2(Robot):
    def take(self, topic, msgtype, sample):
        if topic not in ["amcl_pose", "particle_cloud", *WHOLE]:
            return super().take(topic, msgtype, sample)
        data = sample.payload.to_bytes()
        message = STORE.deserialize_cdr(data, msgtype)
        words = {"same": bytes(STORE.serialize_cdr(message, msgtype)) == data}
        if topic == "amcl_pose":
            words |= {
                "stamp": seconds(message.header.stamp),
                "frame": message.header.frame_id,
                "pose": planar(message.pose.pose),
            }
        elif topic == "particle_cloud":
            words |= {
                "stamp": seconds(message.header.stamp),
                "poses": [planar(particle.pose) for particle in message.particles],
                "weight": sum(particle.weight for particle in message.particles),
            }
        else:
            words |= plain(message)
        say(event=topic, **words)

    def follow(self):
        """What others of Nav2 subscribe to."""
        self.nav = self.node("bt_navigator")
        self.subscribe(self.nav, "particle_cloud", SENSOR)
        self.subscribe(self.nav, "bond")
        self.subscribe(self.nav, "amcl/transition_event")
        self.subscribe(self.nav, "tf")
        self.subscribe(self.nav, "/parameter_events")
        self.join("rviz")

    def hear(self, topic):
        self.subscribe(self.node("listener"), topic)

    def fleet(self):
        """A master control that takes where robots are."""

        def take(sample):
            position = json.loads(sample.payload.to_bytes())
            say(
                event="vda5050",
                key=str(sample.key_expr),
                encoding=str(sample.encoding),
                position=position,
            )

        handler = zenoh.handlers.Callback(take, indirect=False)
        self.alive.append(self.session.declare_subscriber("vda5050/**", handler))

    def join(self, name, topic="amcl_pose"):
        """Somebody who wants the last message, too."""
        node = self.node(name)
        msgtype = TYPES[topic]
        kind = EntityKind.SUBSCRIPTION
        key, token = self.endpoint(
            node, kind, topic, msgtype, STORE.hash_rihs01(msgtype), KEPT
        )

        def take(sample):
            try:
                self.take(topic, msgtype, sample)
            except Exception as error:
                say(event="failed", topic=topic, error=repr(error))

        subscriber = zenoh.ext.declare_advanced_subscriber(
            self.session,
            key,
            zenoh.handlers.Callback(take, indirect=False),
            history=zenoh.ext.HistoryConfig(detect_late_publishers=True, max_samples=1),
        )
        self.alive.append(subscriber)
        self.token(token)

    def drive(self, index, time=None, odom=None):
        """A recorded scan, and the odometry as a transform, as AMCL takes it; at the time of
        another scan, and with another odometry: x, y and yaw."""
        time = index if time is None else time
        odometry = STORE.deserialize_cdr(self.recorded["odom"][time], TYPES["odom"])
        pose = STORE.deserialize_cdr(self.recorded["odom"][index], TYPES["odom"]).pose.pose
        position, orientation = plain(pose.position), plain(pose.orientation)
        if odom is not None:
            x, y, yaw = odom
            position = {"x": x, "y": y}
            orientation = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
        transform = {
            "header": plain(odometry.header),
            "child_frame_id": odometry.child_frame_id,
            "transform": {"translation": position, "rotation": orientation},
        }
        message = build((Nodetype.NAME, TYPES["tf"]), {"transforms": [transform]})
        self.put("tf", bytes(STORE.serialize_cdr(message, TYPES["tf"])))
        scan = STORE.deserialize_cdr(self.recorded["scan"][index], TYPES["scan"])
        scan.header.stamp = STORE.deserialize_cdr(
            self.recorded["scan"][time], TYPES["scan"]
        ).header.stamp
        self.put("scan", bytes(STORE.serialize_cdr(scan, TYPES["scan"])), SENSOR)

    def clock(self, ns):
        """A simulation's time."""
        stamp = {"clock": {"sec": ns // 10**9, "nanosec": ns % 10**9}}
        message = build((Nodetype.NAME, TYPES["/clock"]), stamp)
        self.put("/clock", bytes(STORE.serialize_cdr(message, TYPES["/clock"])))

    def other_map(self, cell):
        """The map, but for one cell."""
        message = STORE.deserialize_cdr(self.recorded["map"][0], TYPES["map"])
        message.data = message.data.copy()
        message.data[cell] = 0 if message.data[cell] == 100 else 100
        self.put("map", bytes(STORE.serialize_cdr(message, TYPES["map"])), KEPT)

    def humble(self, topic):
        """A node of ROS 2 Humble publishes that: its types have no hashes."""
        kind, node = EntityKind.PUBLISHER, self.node("old_lidar")
        _, token = self.endpoint(node, kind, topic, TYPES[topic], "TypeHashNotSupported", SENSOR)
        self.token(token)

    def point(self, frame, x, y, yaw=0.0):
        """As "2D Pose Estimate" does."""
        msgtype = TYPES["initialpose"]
        message = build((Nodetype.NAME, msgtype), self.pointed(frame, x, y, yaw))
        self.put("initialpose", bytes(STORE.serialize_cdr(message, msgtype)))

    @staticmethod
    def pointed(frame, x, y, yaw):
        turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
        pose = {"position": {"x": x, "y": y}, "orientation": turn}
        return {"header": {"frame_id": frame}, "pose": {"pose": pose}}

    def ask(self, service, request):
        """As a client of a service of ROS does."""
        name = SERVICES[service][0]
        asked, answered = part_of(service, "Request"), part_of(service, "Response")
        message = build((Nodetype.NAME, asked), request)
        type_hash = self.type_hash(service_hash(service))
        key = topic_keyexpr(DOMAIN, self.name(service), ros2_to_dds_type(name), type_hash)
        self.sequence[service] = self.sequence.get(service, 0) + 1
        attachment = Attachment(self.sequence[service], time.time_ns(), b"0123456789abcdef")
        querier = self.session.declare_querier(
            key,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
        )
        # Clients of ROS wait for their service, too.
        while not querier.matching_status.matching:
            time.sleep(0.01)
        replies = querier.get(
            payload=bytes(STORE.serialize_cdr(message, asked)),
            attachment=attachment.to_bytes(),
        )
        response = None
        for reply in replies:
            if reply.ok is None:
                say(event="failed", error=reply.err.payload.to_bytes().decode())
                continue
            data = reply.ok.payload.to_bytes()
            response = STORE.deserialize_cdr(data, answered)
            same = bytes(STORE.serialize_cdr(response, answered)) == data
            say(event="answer", service=service, same=same, response=plain(response))
        querier.undeclare()
        if response is None:
            say(event="failed", error=f"nobody answers {key}")

    def endpoints(self, node):
        """What others see of a node, and whether types and hashes are those of ROS."""
        found, wrong = [], []
        for reply in self.session.liveliness().get(f"@ros2_lv/{DOMAIN}/**"):
            parts = str(reply.ok.key_expr).split("/")
            if parts[8] != node or parts[5] == "NN":
                continue
            topic = parts[9].replace("%", "/")
            found.append(f"{parts[5]} {topic} {parts[12]}")
            names = {self.name(name): name for name in [*TYPES, *SERVICES]}
            name = names.get(topic)
            if name in SERVICES:
                expected = [ros2_to_dds_type(SERVICES[name][0]), service_hash(name)]
            elif name in TYPES:
                expected = [ros2_to_dds_type(TYPES[name]), STORE.hash_rihs01(TYPES[name])]
            else:
                expected = [None, None]
            if parts[10] != expected[0] or expected[1] != parts[11]:
                wrong.append(parts)
        say(event="endpoints", found=sorted(found), wrong=wrong)

    def mark(self):
        """All that came before is said."""
        say(event="mark")


def main():
    robot = Nav2(*sys.argv[1:])
    say(event="there")
    for line in sys.stdin:
        order = json.loads(line)
        getattr(robot, order.pop("do"))(**order)
    robot.session.close()


main()
