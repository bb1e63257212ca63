"""Answers are those of the command, to the bit."""

import json
import math

import numpy as np
import pytest
from conftest import NAMES, RECORDINGS
from recorded import read

import backcast


def map_of(name):
    return backcast.Map.from_yaml(RECORDINGS / name / "map.yaml")


def check(scan, result, line):
    """A result with a mount against a line of the command; == on floats, no tolerance."""
    assert line["stamp_ns"] == scan.stamp_ns
    assert result.verdict == line["verdict"]
    assert result.why == line["says"]
    assert result.confidence == line["probability"]
    assert result.alternatives == line["alternatives"]
    assert result.beams_used == line["votes"]["beams_used"]
    places = line["hypotheses"]
    for frame, poses, covariances in [
        ("laser", result.laser_poses, result.laser_covariances),
        ("base", result.poses, result.covariances),
    ]:
        expected = [[p[frame][axis] for axis in ("x", "y", "yaw")] for p in places]
        assert poses.tolist() == expected
        flat = covariances.reshape(-1, 9).tolist()
        assert flat == [p[f"{frame}_covariance"] for p in places]
    assert result.scores.tolist() == [p["score"] for p in places]
    assert result.probabilities.tolist() == [p["probability"] for p in places]
    assert result.votes.tolist() == [p["intensity"] for p in places]
    assert result.frame == "base"
    assert result.pose == tuple(result.poses[0])


@pytest.mark.parametrize("name", NAMES)
def test_every_scan_of_a_recording(located, name):
    recorded, lines = read(name), located(name)
    localizer = backcast.Localizer(map_of(name))
    assert len(lines) == len(recorded.scans)
    for scan, line in zip(recorded.scans, lines, strict=True):
        ranges = np.array(scan.ranges, np.float32)
        result = localizer.locate(ranges, *scan.angles, **scan.limits, mount=recorded.mount)
        check(scan, result, line)
        assert localizer.map.id == line["map_id"]


SETTINGS = [
    (
        {"taper": "gaussian", "max_beams": 90, "headings": 720},
        ["--taper=gaussian", "--max-beams=90", "--headings=720"],
    ),
    (
        {"threads": 2, "floor_share": 0.9, "candidates": 16},
        ["--threads=2", "--floor-share=0.9", "--candidates=16"],
    ),
    ({"least_score": 0.9, "unknown_blocks": True}, ["--least-score=0.9", "--unknown-blocks"]),
    ({"region": [(-20.0, -14.5), (20.25, 3)]}, ["--region=-20,-14.5 20.25,3"]),
    ({"headings_within": (math.radians(-90), math.radians(45))}, ["--headings-within=-90,45"]),
]


@pytest.mark.parametrize(("settings", "options"), SETTINGS)
def test_settings_are_the_options_of_the_command(located, settings, options):
    name = "malaga_corridor"
    lines = located(name, "--every", "6", *options)
    recorded = read(name)
    localizer = backcast.Localizer(map_of(name), **settings)
    for scan, line in zip(recorded.scans[::6], lines, strict=True):
        result = localizer.locate(scan.ranges, *scan.angles, **scan.limits, mount=recorded.mount)
        check(scan, result, line)


def test_a_known_heading(located):
    name = "malaga_corridor"
    lines = located(name, "--every", "6", "--heading", "-27.5")
    recorded = read(name)
    assert recorded.mount[2] == 0.0, "the heading of the base is the laser's"
    localizer = backcast.Localizer(map_of(name), heading_known=True)
    for scan, line in zip(recorded.scans[::6], lines, strict=True):
        result = localizer.locate(
            scan.ranges,
            *scan.angles,
            **scan.limits,
            mount=recorded.mount,
            heading=math.radians(-27.5),
        )
        check(scan, result, line)


def test_a_map_from_an_array_is_that_of_a_recording(command):
    name = "malaga_courtyard"
    file = RECORDINGS / name / "recording.mcap"
    text = command("locate", file, "--json", "--every", "30")
    lines = [json.loads(line) for line in text.splitlines()]
    recorded = read(name)
    info = recorded.occupancy.info
    cells = np.array(recorded.occupancy.data, np.int8).reshape(info.height, info.width)
    # A message has the resolution in 32 bits; the command takes the decimal that was meant.
    resolution = float(str(np.float32(info.resolution)))
    origin = (info.origin.position.x, info.origin.position.y, 0.0)
    map = backcast.Map.from_array(cells, resolution, origin)
    localizer = backcast.Localizer(map)
    for scan, line in zip(recorded.scans[::30], lines, strict=True):
        assert map.id == line["map_id"]
        result = localizer.locate(scan.ranges, *scan.angles, **scan.limits, mount=recorded.mount)
        check(scan, result, line)
