"""What is read of a recording is what the command reads of it."""

import json

import numpy as np
import pytest
from conftest import NAMES, RECORDINGS
from mcap.reader import make_reader
from mcap.writer import Writer
from recorded import read
from test_same_as_command import check, map_of

import backcast


def file_of(name):
    return RECORDINGS / name / "recording.mcap"


@pytest.mark.parametrize("name", NAMES)
def test_a_recording_is_what_another_reader_reads(command, name):
    recording, other = backcast.read(file_of(name)), read(name)
    channels = json.loads(command("info", file_of(name), "--json"))["channels"]
    counts = {channel["topic"]: channel["messages"] for channel in channels}
    (scans,) = recording.scans.values()
    assert (scans.topic, scans.frame, scans.upside_down) == ("/scan", "laser", False)
    assert len(scans) == counts["/scan"] == len(other.scans)
    assert scans.stamps_ns.dtype == np.int64
    assert scans.stamps_ns.tolist() == [scan.stamp_ns for scan in other.scans]
    expected = np.array([scan.ranges for scan in other.scans], np.float32)
    assert scans.ranges.dtype == np.float32 and np.isinf(expected).any()
    assert (scans.ranges == expected).all()
    angles = np.column_stack([scans.angle_min, scans.angle_increment])
    assert angles.tolist() == [list(scan.angles) for scan in other.scans]
    assert scans.mount == other.mount
    stamps_ns, poses = recording.odometry
    assert len(stamps_ns) == counts["/odom"] and poses.shape == (len(stamps_ns), 3)
    assert stamps_ns.tolist() == [stamp_ns for stamp_ns, _ in other.odometry]
    assert poses.tolist() == [list(pose) for _, pose in other.odometry]
    stamps_ns, poses = recording.truth
    assert len(stamps_ns) == len(poses) == counts["/ground_truth"]
    assert recording.map.id == map_of(name).id


@pytest.mark.parametrize("name", NAMES)
def test_each_scan_is_located_as_by_the_command(located, name):
    recording, lines = backcast.read(file_of(name)), located(name)
    localizer, scans = backcast.Localizer(map_of(name)), recording.scans["/scan"]
    for scan, line in zip(scans, lines, strict=True):
        check(scan, localizer.locate(scan), line)
    assert scans[-1].stamp_ns == scan.stamp_ns
    for beyond in (len(scans), -len(scans) - 1):
        with pytest.raises(IndexError, match=f"index {beyond} of {len(scans)} scans"):
            scans[beyond]


def test_two_lasers_are_located_as_by_the_command(command, tmp_path):
    """Their scans take 0.1 s, and the robot moves and turns."""
    file = tmp_path / "two.mcap"
    lasers = ["--laser=front=0.49,0,0", "--laser=rear=-0.43,0,180,180"]
    drive = ["--path=3.5,-10.4 5.5,-10.9 5.5,-10.4", "--rate=5", "--scan-duration=0.1"]
    map = RECORDINGS / "malaga_corridor/map.yaml"
    command("simulate", "--map", map, "--out", file, *drive, *lasers)
    topics = ["--scan-topic=/front/scan", "--scan-topic=/rear/scan"]
    lines = [json.loads(line) for line in command("locate", file, "--json", *topics).splitlines()]
    recording = backcast.read(file)
    localizer = backcast.Localizer(recording.map)
    front, rear = recording.scans["/front/scan"], recording.scans["/rear/scan"]
    assert (front.upside_down, rear.upside_down) == (False, True)
    assert len(lines) == len(front) > 20
    # The first comes before any of the rear laser, and odometry ends before the last.
    pairs = zip(front, [None, *rear], lines, strict=False)
    for scan, before, line in list(pairs)[1:-1]:
        assert before.stamp_ns < scan.stamp_ns
        check(scan, localizer.locate([scan, before], odometry=recording.odometry), line)


def test_odometry_that_cannot_be_decoded_is_an_error_only_where_it_is_asked_for(tmp_path):
    sound, broken = file_of("malaga_corridor"), tmp_path / "broken.mcap"
    with open(sound, "rb") as file, open(broken, "wb") as out:
        writer, channels = Writer(out), {}
        writer.start()
        for schema, channel, message in make_reader(file).iter_messages():
            if channel.id not in channels:
                of_schema = writer.register_schema(schema.name, schema.encoding, schema.data)
                cdr = channel.message_encoding
                channels[channel.id] = writer.register_channel(channel.topic, cdr, of_schema)
                if channel.topic == "/odom":
                    wheels = writer.register_channel("/wheels", cdr, of_schema)
                    writer.add_message(wheels, message.log_time, b"\0\1\0\0", message.log_time)
            stamps = (message.log_time, message.data, message.publish_time)
            writer.add_message(channels[channel.id], *stamps)
        writer.finish()
    for read_again, expected in zip(
        backcast.read(broken).odometry, backcast.read(sound).odometry, strict=True
    ):
        assert np.array_equal(read_again, expected)
    with pytest.raises(ValueError, match="the message of /wheels .* is not a nav_msgs/"):
        backcast.read(broken, odom_topic="/wheels")


def test_files_that_cannot_be_read_are_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="cannot read the recording .*none.mcap"):
        backcast.read(tmp_path / "none.mcap")
    sound = file_of("malaga_corridor").read_bytes()
    for content in (b"", b"no recording", sound[:-2000], sound[:2000], sound[::-1]):
        (tmp_path / "r.mcap").write_bytes(content)
        with pytest.raises(ValueError, match="r.mcap"):
            backcast.read(tmp_path / "r.mcap")
    with pytest.raises(ValueError, match="has no nav_msgs/msg/Odometry on /wheels; it has /odom"):
        backcast.read(file_of("malaga_corridor"), odom_topic="/wheels")
