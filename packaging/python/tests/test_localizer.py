"""Locating scans of a drawn hall, and what is refused."""

import copy
import math
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from drawn import ANGLES, hall, hall_map, ranges_at

import backcast

TRUTH = (3.0, 2.5, 1.0)


@pytest.fixture(scope="module")
def localizer():
    return backcast.Localizer(hall_map())


@pytest.fixture(scope="module")
def ranges():
    return ranges_at(*TRUTH)


def test_a_scan_is_found(localizer, ranges):
    result = localizer.locate(ranges, *ANGLES)
    assert result.verdict == "Unique" and result.alternatives == 0
    assert "one place, fit" in result.why
    assert result.frame == "laser"
    # A cell, and a degree.
    assert np.allclose(result.pose, TRUTH, atol=[0.1, 0.1, 0.02])
    n = len(result.scores)
    assert n >= 1
    shapes = (result.poses.shape, result.covariances.shape, result.probabilities.shape)
    assert shapes == ((n, 3), (n, 3, 3), (n,))
    assert result.poses.dtype == result.covariances.dtype == np.float64
    assert result.pose == tuple(result.poses[0])
    assert (result.covariance == result.covariances[0]).all()
    assert (result.poses == result.laser_poses).all()
    assert 0.9 < result.probabilities.sum() <= 1.0
    assert repr(result).startswith("<backcast.Result Unique: laser at x ")


def test_ranges_may_be_any_row_of_numbers(localizer, ranges):
    first = localizer.locate(ranges, *ANGLES)
    twice = np.repeat(ranges, 2)[::2]
    for same in (list(map(float, ranges)), ranges.astype(np.float64), twice, tuple(ranges)):
        assert localizer.locate(same, *ANGLES).poses.tolist() == first.poses.tolist()


def test_what_did_not_come_back_says_nothing(localizer, ranges):
    lost = ranges.copy()
    lost[::5] = np.inf
    without = localizer.locate(lost, *ANGLES)
    assert without.verdict == "Unique"
    for nothing in (np.nan, -np.inf, -1.0, 0.0, 60.0, 1e300):
        other = lost.astype(np.float64)
        other[::5] = nothing
        found = localizer.locate(other, *ANGLES, range_max=60.0)
        assert found.poses.tolist() == without.poses.tolist(), nothing
    silent = localizer.locate(np.full(360, np.inf), *ANGLES)
    assert (silent.verdict, silent.pose, silent.covariance) == ("NoScan", None, None)
    assert silent.poses.shape == (0, 3) and silent.covariances.shape == (0, 3, 3)
    assert repr(silent).startswith("<backcast.Result NoScan: ")


def test_a_laser_that_turns_clockwise_or_hangs_upside_down(localizer, ranges):
    first = localizer.locate(ranges, *ANGLES)
    last = 359 * ANGLES[1]
    clockwise = localizer.locate(ranges[::-1], last, -ANGLES[1])
    assert np.allclose(clockwise.pose, first.pose, atol=1e-6)
    upside_down = localizer.locate(ranges[::-1], -last, ANGLES[1], upside_down=True)
    assert upside_down.poses.tolist() == clockwise.poses.tolist()


def test_a_mount_makes_it_the_pose_of_the_base(localizer, ranges):
    laser = localizer.locate(ranges, *ANGLES)
    mount = (0.4, -0.1, math.pi / 2)
    base = localizer.locate(ranges, *ANGLES, mount=np.array(mount))
    assert base.frame == "base"
    assert base.laser_poses.tolist() == laser.poses.tolist()
    assert base.laser_covariances.tolist() == laser.covariances.tolist()
    x, y, yaw = base.pose
    back = (
        x + 0.4 * math.cos(yaw) + 0.1 * math.sin(yaw),
        y + 0.4 * math.sin(yaw) - 0.1 * math.cos(yaw),
        yaw + math.pi / 2,
    )
    # A rotation and a sum: a few units in the last place.
    assert np.allclose(back, laser.pose, atol=1e-9)
    assert base.covariance[0, 0] != laser.covariance[0, 0]


def test_a_known_heading(ranges):
    localizer = backcast.Localizer(hall_map(), heading_known=True)
    assert localizer.heading_known
    result = localizer.locate(ranges, *ANGLES, heading=TRUTH[2])
    assert np.allclose(result.pose, TRUTH, atol=[0.1, 0.1, 0.02])
    mount = (0.0, 0.0, math.pi / 2)
    mounted = localizer.locate(ranges, *ANGLES, mount=mount, heading=TRUTH[2] - math.pi / 2)
    assert np.allclose(mounted.laser_poses[0], TRUTH, atol=[0.1, 0.1, 0.02])
    with pytest.raises(ValueError, match="heading is None; allowed: radians"):
        localizer.locate(ranges, *ANGLES)
    with pytest.raises(ValueError, match="the known heading is NaN"):
        localizer.locate(ranges, *ANGLES, heading=math.nan)


def test_a_heading_needs_a_localizer_for_it(localizer, ranges):
    with pytest.raises(ValueError, match="allowed: None, unless .* heading_known=True"):
        localizer.locate(ranges, *ANGLES, heading=1.0)


RANGES = np.full(360, 2.0, np.float32)
STEP = ANGLES[1]
WRONG = [
    (([], 0.0, STEP), {}, "the scan is empty"),
    ((np.ones(70_000), 0.0, 1e-5), {}, "70000 ranges: at most 65536"),
    ((np.broadcast_to(1.0, 10**10), 0.0, 1e-12), {}, "10000000000 ranges: at most 65536"),
    ((np.ones((2, 3)), 0.0, STEP), {}, "ranges has 2 dimensions; allowed"),
    ((np.ones(3, complex), 0.0, STEP), {}, "ranges has dtype complex128; allowed"),
    ((np.ones(3, bool), 0.0, STEP), {}, "ranges has dtype bool; allowed"),
    ((["near", "far"], 0.0, STEP), {}, "ranges has dtype <U4; allowed"),
    (([[1.0], [1.0, 2.0]], 0.0, STEP), {}, "ranges is no array"),
    ((None, 0.0, STEP), {}, "ranges has 0 dimensions"),
    ((RANGES, math.nan, STEP), {}, "angle_min is NaN: it must be finite"),
    ((RANGES, 0.0, 0.0), {}, "angle_increment is 0: it must be finite and not zero"),
    ((RANGES, 0.0, math.inf), {}, "angle_increment is inf"),
    ((RANGES, 0.0, 0.1), {}, "cover 5.71 turns: at most one is allowed"),
    ((RANGES, 0.0, -0.1), {}, "cover 5.71 turns: at most one is allowed"),
    ((RANGES, 0.0, STEP), {"range_min": 5, "range_max": 1}, "0 <= range_min < range_max"),
    ((RANGES, 0.0, STEP), {"range_min": -1}, "range_min -1"),
    ((RANGES, 0.0, STEP), {"range_max": math.nan}, "range_max NaN"),
    ((RANGES, 0.0, STEP), {"mount": (1, 2)}, "mount has 2 numbers; allowed: three"),
    ((RANGES, 0.0, STEP), {"mount": (1, 2, math.inf)}, "mount is .*; allowed: three finite"),
    ((RANGES, 0.0, STEP), {"mount": "front"}, "mount is front; allowed"),
]


@pytest.mark.parametrize(("given", "others", "reason"), WRONG)
def test_scans_that_are_refused(localizer, given, others, reason):
    with pytest.raises(ValueError, match=reason):
        localizer.locate(*given, **others)


SETTINGS = [
    ({"max_beams": 0}, ValueError, "max_beams: 0 is not in 1..=65535"),
    ({"max_beams": 2.5}, ValueError, "max_beams"),
    ({"max_beams": "many"}, ValueError, "max_beams: invalid digit"),
    ({"headings": 361}, ValueError, "361 headings a turn: it must be a multiple of 8"),
    ({"sigma_m": math.nan}, ValueError, "sigma_m: NaN is not within 0 to 2 metres"),
    ({"sigma_m": -1}, ValueError, "sigma_m: -1 is not within 0 to 2 metres"),
    ({"taper": "round"}, ValueError, "round.*possible values: gaussian, linear"),
    ({"unknown_blocks": 1}, TypeError, "unknown_blocks is 1, a int; allowed: True or False"),
    ({"threads": True}, TypeError, "threads is True, a bool; allowed: a number"),
    ({"threads": [1]}, TypeError, "threads is .*, a list; allowed: a number"),
    ({"beams": 5}, TypeError, "beams is no setting; allowed: occupied_from, free_to"),
    ({"doubt_fall": 5}, TypeError, "doubt_fall is no setting"),
    ({"region": (1, 2)}, ValueError, "region is .*; allowed: two corners"),
    ({"region": [(1, 2, 3), (4, 5)]}, ValueError, "region is .*; allowed: two corners"),
    ({"region": [(1, 2)]}, ValueError, "region: 1 corners; allowed are 2"),
    ({"headings_within": (0, 7)}, ValueError, "headings_within is .*; allowed: .from, to"),
    ({"headings_within": 1}, ValueError, "headings_within is 1; allowed: .from, to"),
    ({"region": [(90, 90), (91, 91)]}, ValueError, "no open cell of the map lies in the region"),
    ({"memory_limit": 1}, MemoryError, "memory_limit allows 1: larger cells .search_cell"),
]


@pytest.mark.parametrize(("settings", "kind", "reason"), SETTINGS)
def test_settings_that_are_refused(settings, kind, reason):
    with pytest.raises(kind, match=reason):
        backcast.Localizer(hall_map(), **settings)


def test_none_is_the_default(localizer, ranges):
    same = backcast.Localizer(
        hall_map(), max_beams=None, region=None, taper=None, unknown_blocks=False, work_limit=None
    )
    found = same.locate(ranges, *ANGLES)
    assert found.poses.tolist() == localizer.locate(ranges, *ANGLES).poses.tolist()


def test_maps_that_cannot_be_used():
    for cells, reason in [(0, "no occupied cell"), (100, "no free cell"), (-1, "no occupied")]:
        map = backcast.Map.from_array(np.full((20, 20), cells, np.int8), 0.1)
        with pytest.raises(ValueError, match=reason):
            backcast.Localizer(map)
    with pytest.raises(TypeError, match="Map"):
        backcast.Localizer(hall())


def test_threads_ask_at_once_and_get_the_same(localizer, ranges):
    """One localizer, asked by eight threads."""
    expected = localizer.locate(ranges, *ANGLES).poses.tolist()
    found = []

    def ask():
        for _ in range(5):
            found.append(localizer.locate(ranges, *ANGLES).poses.tolist())

    threads = [threading.Thread(target=ask) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 40


@pytest.fixture(scope="module")
def clutter():
    """A map of single cells all over, and a scan that fits nowhere: a search of seconds."""
    rng = np.random.default_rng(5)
    cells = np.where(rng.random((600, 600)) < 0.01, 100, 0).astype(np.int8)
    return backcast.Map.from_array(cells, 0.05), rng.uniform(0.3, 3.0, 360)


def test_the_lock_is_released_while_a_map_is_prepared_and_searched(clutter):
    """Another thread goes on while one is in a call that lasts.

    Without that, whoever waits gets the lock at the earliest when the call ends, so that no
    stamp of the counting thread lies within the call.
    """
    map, ranges = clutter
    stamps, ends = [], threading.Event()

    def count():
        while not ends.is_set():
            stamps.append(time.perf_counter())
            time.sleep(0.0005)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        begun = time.perf_counter()
        localizer = backcast.Localizer(map)
        prepared = time.perf_counter()
        localizer.locate(ranges, *ANGLES)
        done = time.perf_counter()
    finally:
        ends.set()
        thread.join()
    # The ends of a call are left out: arguments are read and results made with the lock.
    for start, end in ((begun, prepared), (prepared, done)):
        quarter = 0.25 * (end - start)
        assert any(start + quarter < stamp < end - quarter for stamp in stamps), end - start


def stop_by_signal(search):
    came_back = False

    class Stopped(Exception):
        pass

    def stop(_number, _frame):
        raise Stopped

    before = signal.signal(signal.SIGALRM, stop)
    try:
        with pytest.raises(Stopped):
            signal.setitimer(signal.ITIMER_REAL, 0.05)
            search()
            came_back = True
    finally:
        signal.signal(signal.SIGALRM, before)
    assert not came_back


def test_a_signal_ends_a_search(clutter):
    map, ranges = clutter
    localizer = backcast.Localizer(map)
    stop_by_signal(lambda: localizer.locate(ranges, *ANGLES))
    # What it was searching with serves again.
    again = localizer.locate(ranges, *ANGLES)
    assert again == backcast.Localizer(map).locate(ranges, *ANGLES)


def test_a_signal_ends_the_search_of_a_tracker(clutter):
    map, ranges = clutter
    tracker = backcast.Tracker(map)
    stop_by_signal(lambda: tracker.update(ranges, *ANGLES, stamp_ns=1_000_000_000))
    # The scan counts as one whose search has no answer, and the next one is searched.
    assert tracker.update(ranges, *ANGLES, stamp_ns=2_000_000_000).searched


PREPARES_UNTIL_A_SIGNAL = """
import os, signal, sys, tempfile

import numpy as np

import backcast


def prepare(folder):
    backcast.Localizer(map, index_cache=folder)


def on_interrupt(number, frame):
    # Python handles signals on the first line of a function, in calls and after them.
    if frame.f_code is prepare.__code__ and frame.f_lineno > frame.f_code.co_firstlineno:
        signal.default_int_handler(number, frame)
    print("early", flush=True)


cells = np.where(np.random.default_rng(5).random((2000, 2000)) < 0.01, 100, 0)
map = backcast.Map.from_array(cells.astype(np.int8), 0.05)
signal.signal(signal.SIGINT, on_interrupt)
for _ in range(5):
    folder = tempfile.mkdtemp(dir=sys.argv[1])
    print("prepares", flush=True)
    try:
        prepare(folder)
        print("unheard", flush=True)
    except KeyboardInterrupt:
        if not os.listdir(folder):
            signal.signal(signal.SIGINT, signal.SIG_IGN)
            print("interrupted", flush=True)
            break
        print("late", flush=True)
"""


def test_a_signal_ends_the_preparing_of_a_map(tmp_path):
    """What is prepared is kept in the folder before the call ends: a folder without a file
    means that the exception came first. A signal that comes too early or too late is sent
    again, so that the speed of the machine does not matter."""
    child = [sys.executable, "-c", PREPARES_UNTIL_A_SIGNAL, tmp_path]
    with subprocess.Popen(child, stdout=subprocess.PIPE, text=True) as process:
        said = []
        for line in process.stdout:
            said.append(line.strip())
            if said[-1] in ("prepares", "early"):
                process.send_signal(signal.SIGINT)
    assert said[-1] == "interrupted", said
    assert process.returncode == 0


def test_masked_ranges_are_no_returns(localizer, ranges):
    hidden = np.arange(len(ranges)) % 3 == 0
    masked = np.ma.masked_array(ranges, hidden)
    found = localizer.locate(masked, *ANGLES)
    assert found == localizer.locate(np.where(hidden, np.nan, ranges), *ANGLES)
    assert found != localizer.locate(ranges, *ANGLES)
    masked = np.ma.masked_array(np.full(360, 2), np.ones(360, bool))
    assert localizer.locate(masked, *ANGLES).verdict == "NoScan"


@pytest.mark.parametrize("mount", [(780.0, 0.0, 0.0), (9.0, 9.0, 0.0), (0.78, 0.0, 90.0)])
def test_a_mount_in_other_units_is_refused(localizer, ranges, mount):
    with pytest.raises(ValueError, match="within 10 m and a turn, in metres and radians"):
        localizer.locate(ranges, *ANGLES, mount=mount)


def test_ranges_in_millimetres_are_refused(localizer, ranges):
    with pytest.raises(ValueError, match="allowed: metres.*are they millimetres"):
        localizer.locate(1000 * ranges, *ANGLES)
    nothing = localizer.locate(np.full(360, 120.0), *ANGLES, range_max=100.0)
    assert nothing.verdict == "NoScan", "readings at range_max are no returns, however long"


def test_a_result_can_be_pickled_copied_and_compared(localizer, ranges):
    result = localizer.locate(ranges, *ANGLES, mount=(0.2, 0.0, 0.0))
    for same in (pickle.loads(pickle.dumps(result)), copy.copy(result), copy.deepcopy(result)):
        assert same == result and same.why == result.why
        assert (same.covariances == result.covariances).all()
    assert result != localizer.locate(ranges, *ANGLES) and result != result.verdict


def test_the_matrix_takes_points_of_the_laser_into_the_map(localizer, ranges):
    result = localizer.locate(ranges, *ANGLES)
    ahead = result.matrix() @ [2.0, 0.0, 1.0]
    x, y, yaw = result.pose
    assert np.allclose(ahead, [x + 2 * math.cos(yaw), y + 2 * math.sin(yaw), 1.0])
    assert localizer.locate(np.full(360, np.inf), *ANGLES).matrix() is None


def test_a_prepared_map_is_kept_and_read(tmp_path, ranges):
    folder = tmp_path / "maps"
    first = backcast.Localizer(hall_map(), index_cache=str(folder))
    (kept,) = folder.iterdir()
    written = kept.stat().st_ino
    again = backcast.Localizer(hall_map(), index_cache=str(folder))
    assert [file.stat().st_ino for file in folder.iterdir()] == [written], "it was read"
    assert first.locate(ranges, *ANGLES) == again.locate(ranges, *ANGLES)
    with pytest.raises(OSError, match="maps"):
        backcast.Localizer(hall_map(), index_cache=str(kept))
