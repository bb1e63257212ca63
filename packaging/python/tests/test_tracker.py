"""The tracker: what the command's says of a recording, and a drive through a drawn hall."""

import functools
import math
import pickle

import numpy as np
import pytest
from conftest import NAMES, RECORDINGS
from drawn import ANGLES, hall_map, ranges_at
from recorded import read, read_file

import backcast


def follow(command, recording, map, out, *options):
    """Where the command has the laser where it believes a place, by stamps."""
    command(
        *("evaluate", recording, "--map", map, "--sequence"),
        *("--starts", "1", "--kidnaps", "0", "--trajectories", out, *options),
    )
    poses = {}
    for line in (out / f"{recording.stem}.tum").read_text().splitlines():
        stamp, x, y, _, _, _, sin, cos = line.split()
        poses[int(stamp.replace(".", ""))] = (float(x), float(y), float(sin), float(cos))
    return poses


def believed(tracked):
    """The same of the tracker, by its stamp; nothing where it believes no place."""
    if tracked.state not in ("Unique", "Doubtful"):
        return {}
    x, y, yaw = tracked.laser_pose
    return {tracked.stamp_ns: (x, y, math.sin(0.5 * yaw), math.cos(0.5 * yaw))}


@pytest.fixture(scope="module")
def followed(command, tmp_path_factory):
    @functools.cache
    def of(name):
        folder = RECORDINGS / name
        out = tmp_path_factory.mktemp(name)
        return follow(command, folder / "recording.mcap", folder / "map.yaml", out)

    return of


@pytest.mark.parametrize(
    ("name", "by_stream"),
    [(NAMES[0], False), (NAMES[0], True), (NAMES[1], True), (NAMES[2], False)],
)
def test_a_drive_is_followed_as_the_command_does(followed, name, by_stream):
    folder, expected = RECORDINGS / name, followed(name)
    recorded = read(name)
    odometry = dict(recorded.odometry)
    tracker = backcast.Tracker(backcast.Map.from_yaml(folder / "map.yaml"))
    found = {}
    for scan in recorded.scans:
        given = {}
        if by_stream:
            tracker.add_odometry(scan.stamp_ns, odometry[scan.stamp_ns])
        else:
            given["odometry"] = odometry[scan.stamp_ns]
        tracked = tracker.update(
            scan.ranges, *scan.angles, scan.stamp_ns, **scan.limits, mount=recorded.mount, **given
        )
        assert tracked.stamp_ns == scan.stamp_ns
        found |= believed(tracked)
    assert found == expected
    assert len(found) > 0.5 * len(recorded.scans)


def test_motion_within_scans_is_taken_out_as_the_command_does(command, tmp_path):
    """A laser that hangs upside down and takes 0.15 s for a scan, and odometry at its times.

    The mount has no yaw: the command takes that from a quaternion, which rounds.
    """
    map, recording = RECORDINGS / "malaga_corridor/map.yaml", tmp_path / "moving.mcap"
    command(
        *("simulate", "--map", map, "--path=-14,-11 10,-11.2 2,-10.5", "--out", recording),
        *("--scan-duration", "0.15", "--mount", "0.4,0.05,0,180"),
        *("--field-of-view", "270", "--beams", "271"),
    )
    expected = follow(command, recording, map, tmp_path)
    recorded = read_file(recording)
    odometry = iter(recorded.odometry)
    trackers = {
        deskew: backcast.Tracker(backcast.Map.from_yaml(map), deskew=deskew)
        for deskew in (True, False)
    }
    found = {True: {}, False: {}}
    taken = -1
    for scan in recorded.scans:
        assert scan.time_increment > 0.0
        # Of the time up to a second later, so that it tells of the last beam.
        while taken < scan.stamp_ns + 1_000_000_000 and (sample := next(odometry, None)):
            taken = sample[0]
            for tracker in trackers.values():
                tracker.add_odometry(*sample)
        for deskew, tracker in trackers.items():
            tracked = tracker.update(
                scan.ranges,
                *scan.angles,
                scan.stamp_ns,
                **scan.limits,
                mount=recorded.mount,
                upside_down=True,
                time_increment=scan.time_increment,
            )
            found[deskew] |= believed(tracked)
    assert found[True] == expected
    assert len(expected) > 0.5 * len(recorded.scans)
    assert found[False] != expected


def test_two_lasers_are_followed_as_the_command_does(command, tmp_path):
    """Their scans take 0.1 s. The front laser's is recorded before that of the rear one, which
    hangs upside down and is the main one."""
    map, file = RECORDINGS / "malaga_corridor/map.yaml", tmp_path / "two.mcap"
    lasers = ["--laser=front=0.49,0,0", "--laser=rear=-0.43,0,180,180", "--scan-duration=0.1"]
    drive = ["--path=-14,-11 10,-11.2 2,-10.5", "--rate=5"]
    command("simulate", "--map", map, "--out", file, *drive, *lasers)
    topics = ["--scan-topic=/rear/scan", "--scan-topic=/front/scan"]
    expected = follow(command, file, map, tmp_path, *topics)
    recording = backcast.read(file)
    odometry = zip(*recording.odometry, strict=True)
    tracker = backcast.Tracker(recording.map)
    found, taken = {}, -1
    rear, front = recording.scans["/rear/scan"], recording.scans["/front/scan"]
    for scans in zip(rear, front, strict=False):
        assert scans[1].stamp_ns == scans[0].stamp_ns
        while taken < scans[0].stamp_ns + 1_000_000_000 and (sample := next(odometry, None)):
            taken = sample[0]
            tracker.add_odometry(*sample)
        tracked = tracker.update(scans)
        assert tracked.frame == "base" and not tracked.left_out
        found |= believed(tracked)
    assert found == expected
    assert len(found) > 0.5 * len(rear)


def drive(tracker, steps, first_ns=0, **given):
    """Straight on along y = 2.5 m by 0.3 m a scan, with odometry of the base."""
    for step in range(steps):
        at = (2.0 + 0.3 * step, 2.5, 0.0)
        odometry = (0.3 * step, 0.0, 0.0)
        tracked = tracker.update(
            ranges_at(*at), *ANGLES, first_ns + step * 100_000_000, odometry=odometry, **given
        )
    return at, odometry, tracked


def check_near(pose, truth):
    # A cell, and two degrees: scans of the drawn hall are rounded to 2 cm.
    assert np.hypot(pose[0] - truth[0], pose[1] - truth[1]) < 0.1
    assert abs(pose[2] - truth[2]) < 0.035


def test_the_pose_stays():
    tracker = backcast.Tracker(hall_map())
    at, odometry, tracked = drive(tracker, 12)
    assert tracked.state == "Unique" and tracked.reason == "OnePlace", tracked
    assert tracked.frame == "laser"
    check_near(tracked.pose, at)
    assert tracked.pose == tracked.laser_pose
    check_near(tracked.map_from_odom, (2.0, 2.5, 0.0))
    assert tracked.covariance.shape == (3, 3)
    assert 0.9 < tracked.probability <= 1.0 and tracked.places == 1
    tracker.reset()
    _, _, tracked = drive(tracker, 1)
    assert tracked.state == "Searching" and tracked.searched


def test_an_odd_stamp_is_as_good_as_an_even_one():
    poses = []
    for first_ns in (0, 1):
        _, _, tracked = drive(backcast.Tracker(hall_map()), 12, first_ns)
        poses.append((tracked.pose, tracked.map_from_odom))
    # The way is interpolated at times that differ by a nanosecond.
    assert np.allclose(poses[0], poses[1], atol=1e-6)


def test_without_odometry_scans_are_matched():
    tracker = backcast.Tracker(hall_map())
    for step in range(20):
        at = (2.0 + 0.15 * step, 2.5, 0.0)
        tracked = tracker.update(ranges_at(*at), *ANGLES, step * 100_000_000)
    assert tracked.state == "Unique", tracked
    assert tracked.map_from_odom is None
    check_near(tracked.pose, at)


def test_a_mount_makes_it_the_pose_of_the_base():
    tracker = backcast.Tracker(hall_map())
    at, odometry, tracked = drive(tracker, 12, mount=(0.5, 0.0, 0.0))
    assert tracked.frame == "base"
    check_near(tracked.pose, (at[0] - 0.5, at[1], 0.0))
    check_near(tracked.laser_pose, at)
    # A turn about the laser moves the base: it is known less well across.
    assert tracked.covariance[1, 1] > tracked.laser_covariance[1, 1]


def test_a_pose_that_is_expected_is_tried_first():
    tracker = backcast.Tracker(hall_map())
    tracker.expect((2.0, 2.5, 0.0))
    _, _, tracked = drive(tracker, 1)
    check_near(tracked.pose, (2.0, 2.5, 0.0))
    tracker.expect((2.0, 2.5, 0.0), np.diag([0.01, 0.01, 0.001]))
    with pytest.raises(ValueError, match="(?s)covariance is .*; allowed: 3 × 3"):
        tracker.expect((2.0, 2.5, 0.0), np.zeros((3, 3)))
    with pytest.raises(ValueError, match="pose has 2 numbers; allowed: three"):
        tracker.expect((2.0, 2.5))


def test_a_scan_that_is_refused_changes_nothing():
    tracker = backcast.Tracker(hall_map())
    at, odometry, _ = drive(tracker, 12)
    with pytest.raises(ValueError, match="the scan is empty"):
        tracker.update([], *ANGLES, 1)
    with pytest.raises(ValueError, match="time_increment is NaN: it must be finite"):
        tracker.update(ranges_at(*at), *ANGLES, 1, time_increment=math.nan)
    with pytest.raises(ValueError, match="odometry is .*; allowed: three finite"):
        tracker.update(ranges_at(*at), *ANGLES, 1, odometry=(math.nan, 0, 0))
    tracked = tracker.update(ranges_at(*at), *ANGLES, 1_200_000_000, odometry=odometry)
    assert tracked.state == "Unique"


def test_a_scan_is_the_same_in_all_forms():
    trackers = [backcast.Tracker(hall_map()) for _ in range(3)]
    mount, at = (0.5, 0.0, 0.0), (2.0, 2.5, 0.0)
    ranges = ranges_at(*at)
    scan = backcast.Scan(ranges, *ANGLES, mount=mount, stamp_ns=7)
    expected = trackers[0].update(ranges, *ANGLES, 7, mount=mount, odometry=at)
    assert trackers[1].update(scan, odometry=at) == expected
    assert trackers[2].update([scan], odometry=at) == expected
    with pytest.raises(ValueError, match="scans given: 2; lasers of the robot: 1"):
        trackers[2].update([scan, scan])
    with pytest.raises(TypeError, match="times are given with a Scan; allowed"):
        trackers[1].update(scan, stamp_ns=8)
    with pytest.raises(TypeError, match="or stamp_ns is missing; allowed: all"):
        trackers[1].update(ranges, *ANGLES)


def test_settings_of_the_tracker_are_read():
    tracker = backcast.Tracker(hall_map(), sure=1.0, scan_cap=0.1, deskew=False)
    _, _, tracked = drive(tracker, 12)
    assert tracked.state == "Searching"
    with pytest.raises(ValueError, match="scan_cap: 101 is not within 0 to 100"):
        backcast.Tracker(hall_map(), scan_cap=101)
    with pytest.raises(TypeError, match="deskew is 1, a int; allowed: True or False"):
        backcast.Tracker(hall_map(), deskew=1)
    with pytest.raises(ValueError, match="scan-stamp"):
        backcast.Tracker(hall_map(), scan_stamp="none")


@pytest.mark.parametrize("later", [0, -100_000_000, 1, 100_000])
def test_stamps_that_do_not_rise_by_nanoseconds_are_refused(later):
    tracker = backcast.Tracker(hall_map())
    at, odometry, before = drive(tracker, 12)
    with pytest.raises(ValueError, match=f"{later} ns after that of the last one: at least"):
        tracker.update(ranges_at(*at), *ANGLES, before.stamp_ns + later, odometry=odometry)
    tracker.reset()
    tracker.update(ranges_at(*at), *ANGLES, before.stamp_ns + later, odometry=odometry)


def test_an_expected_pose_off_the_map_is_refused():
    tracker = backcast.Tracker(hall_map())
    for pose in ((-0.1, 2.5, 0.0), (2.0, 8.1, 0.0), (2000.0, 2500.0, 0.0)):
        with pytest.raises(ValueError, match="it must be on map 0"):
            tracker.expect(pose)


def test_a_tracked_pose_can_be_pickled_and_compared():
    _, _, tracked = drive(backcast.Tracker(hall_map()), 12)
    same = pickle.loads(pickle.dumps(tracked))
    assert same == tracked and same.why == tracked.why
    assert np.allclose(tracked.matrix()[:2, 2], tracked.pose[:2])
