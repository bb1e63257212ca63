"""Scans of several lasers of one robot, in a drawn hall."""

import math

import numpy as np
import pytest
from drawn import ANGLES, hall_map, ranges_at

import backcast

TRUTH = (3.0, 2.5, 1.0)
FRONT, REAR = (0.3, 0.0, 0.0), (-0.3, 0.0, math.pi)
SECOND = 1_000_000_000


@pytest.fixture(scope="module")
def localizer():
    return backcast.Localizer(hall_map())


def scan_at(base, mount, stamp_ns=0, **others):
    """What a laser with this mount sees in the half turn ahead of it."""
    x, y, yaw = base
    ahead, left, turn = mount
    x += ahead * math.cos(yaw) - left * math.sin(yaw)
    y += ahead * math.sin(yaw) + left * math.cos(yaw)
    ranges = ranges_at(x, y, yaw + turn - math.pi / 2, beams=181)
    return backcast.Scan(
        ranges, -math.pi / 2, ANGLES[1], mount=mount, stamp_ns=stamp_ns, **others
    )


def check_near(pose, truth):
    # A cell, and a degree.
    assert np.allclose(pose, truth, atol=[0.1, 0.1, 0.02])


def test_two_lasers_find_the_base(localizer):
    front, rear = scan_at(TRUTH, FRONT), scan_at(TRUTH, REAR)
    both = localizer.locate([front, rear])
    assert (both.verdict, both.frame) == ("Unique", "base")
    check_near(both.pose, TRUTH)
    x, y, yaw = both.pose
    first = (x + 0.3 * math.cos(yaw), y + 0.3 * math.sin(yaw), yaw)
    # A rotation and a sum: a few units in the last place.
    assert np.allclose(both.laser_poses[0], first, atol=1e-9)
    assert both == localizer.locate((front, rear))
    check_near(localizer.locate([rear, front]).pose, TRUTH)


def test_one_scan_is_the_same_in_all_forms(localizer):
    scan = scan_at(TRUTH, FRONT)
    limits = {"range_min": scan.range_min, "range_max": scan.range_max}
    angles = (scan.angle_min, scan.angle_increment)
    expected = localizer.locate(scan.ranges, *angles, **limits, mount=scan.mount)
    assert localizer.locate(scan) == localizer.locate([scan]) == expected


def test_a_known_heading_of_the_base():
    localizer = backcast.Localizer(hall_map(), heading_known=True)
    scans = [scan_at(TRUTH, REAR), scan_at(TRUTH, FRONT)]
    check_near(localizer.locate(scans, heading=TRUTH[2]).pose, TRUTH)
    with pytest.raises(ValueError, match="heading is None"):
        localizer.locate(scans)


def test_odometry_takes_the_motion_between_scans_out(localizer):
    x, y, yaw = TRUTH
    before = (x - 0.8 * math.cos(yaw), y - 0.8 * math.sin(yaw), yaw)
    scans = [scan_at(TRUTH, FRONT, SECOND), scan_at(before, REAR, SECOND // 2)]
    # In a frame of its own: half a metre, then 0.8 m more within half a second.
    stamps = np.array([0, SECOND // 2, SECOND])
    poses = [(0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (1.3, 0.0, 0.0)]
    moved = localizer.locate(scans, odometry=(stamps, poses))
    still = localizer.locate(scans)
    assert moved.scores[0] > still.scores[0]
    check_near(moved.pose, TRUTH)
    at_once = localizer.locate([scan_at(TRUTH, FRONT), scan_at(TRUTH, REAR)])
    check_near(moved.pose, at_once.pose)
    short = [(stamps[:2], poses), (stamps, [(0.0, 0.0)] * 3)]
    for wrong in [*short, (0.0, poses), (stamps + 0.5, poses), (stamps, [math.nan] * 3), 5]:
        with pytest.raises(ValueError, match=r"(?s)odometry .*allowed: \(stamps_ns, poses\)"):
            localizer.locate(scans, odometry=wrong)
    with pytest.raises(ValueError, match="laser 1: no odometry for the robot's motion"):
        localizer.locate(scans, odometry=(stamps[:2] + SECOND, poses[:2]))


def test_scans_that_do_not_go_together_are_refused(localizer):
    front = scan_at(TRUTH, FRONT)
    with pytest.raises(ValueError, match="the pose of laser 1 on the base is unknown"):
        localizer.locate([front, backcast.Scan(front.ranges, 0.0, ANGLES[1])])
    for later in (1_000_000_001, -1_000_000_001):
        with pytest.raises(ValueError, match=f"{later} ns after that of laser 0: within"):
            localizer.locate([front, scan_at(TRUTH, REAR, later)])
    with pytest.raises(TypeError, match="Scan"):
        localizer.locate([front, 5])
    for others in ({"mount": FRONT}, {"range_max": 5.0}, {"upside_down": True}):
        with pytest.raises(TypeError, match="are given with a Scan; allowed"):
            localizer.locate(front, **others)
    with pytest.raises(TypeError, match="angle_min or angle_increment is missing; allowed: all"):
        localizer.locate(front.ranges, 0.0)
    with pytest.raises(ValueError, match="time_increment is NaN: it must be finite"):
        scan_at(TRUTH, FRONT, time_increment=math.nan)


def test_a_scan_says_what_it_is_made_of():
    scan = scan_at(TRUTH, FRONT, 7, range_min=0.1, upside_down=True, time_increment=1e-4)
    assert scan.ranges.dtype == np.float32 and scan.ranges.shape == (181,)
    assert scan.range_min == np.float32(0.1) and scan.range_max == math.inf
    assert (scan.stamp_ns, scan.mount, scan.upside_down) == (7, FRONT, True)
    assert (scan.angle_increment, scan.time_increment) == (ANGLES[1], 1e-4)
    assert repr(scan) == "<backcast.Scan of 181 ranges at 7 ns>"
