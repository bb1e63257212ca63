"""Maps from files and arrays."""

import copy
import math
import pickle

import numpy as np
import pytest
from conftest import RECORDINGS

import backcast

CELLS = np.array([[0, 100, -1], [0, 50, 100]], np.int8)


def test_an_array_comes_back():
    map = backcast.Map.from_array(CELLS, 0.5, origin=(1.0, 2.0, math.pi / 2))
    assert (map.width, map.height, map.resolution) == (3, 2, 0.5)
    assert map.origin == (1.0, 2.0, math.pi / 2)
    assert map.cells.dtype == np.int8
    assert (map.cells == CELLS).all()
    assert repr(map).startswith("<backcast.Map of 3 x 2 cells of 0.5 m from (1, 2,")
    map.cells[:] = 0
    assert (map.cells == CELLS).all(), "a copy"


@pytest.mark.parametrize(
    "same",
    [
        CELLS.view(np.uint8),
        np.asfortranarray(CELLS),
        np.flipud(np.flipud(CELLS).copy()),
        np.repeat(CELLS, 2, axis=1)[:, ::2],
    ],
)
def test_any_layout_and_both_types_are_the_same_map(same):
    map, other = backcast.Map.from_array(CELLS, 0.5), backcast.Map.from_array(same, 0.5)
    assert map == other and map.id == other.id and hash(map) == hash(other)
    assert map != backcast.Map.from_array(CELLS, 0.25)


def test_a_map_of_a_file():
    map = backcast.Map.from_yaml(RECORDINGS / "malaga_corridor/map.yaml")
    assert (map.width, map.height, map.resolution) == (1908, 377, 0.05)
    assert map.origin == (-48.6, -15.6, 0.0)
    assert set(np.unique(map.cells)) == {-1, 0, 100}
    assert map == backcast.Map.from_yaml(str(RECORDINGS / "malaga_corridor/map.yaml"))


def test_a_key_that_is_not_known_is_a_warning(tmp_path):
    source = RECORDINGS / "malaga_corridor"
    (tmp_path / "map.png").write_bytes((source / "map.png").read_bytes())
    text = (source / "map.yaml").read_text()
    (tmp_path / "map.yaml").write_text(text + "\nresolutoin: 0.1\n")
    with pytest.warns(UserWarning, match="resolutoin"):
        backcast.Map.from_yaml(tmp_path / "map.yaml")


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(FileNotFoundError, match="none.yaml"):
        backcast.Map.from_yaml(tmp_path / "none.yaml")
    file = tmp_path / "map.yaml"
    sound = (RECORDINGS / "malaga_corridor/map.yaml").read_text()
    file.write_text(sound.replace("map.png", "none.png"))
    with pytest.raises(FileNotFoundError, match="none.png"):
        backcast.Map.from_yaml(file)
    file.write_text(sound.replace("0.05", "-1"))
    with pytest.raises(ValueError, match="resolution is -1.*; allowed"):
        backcast.Map.from_yaml(file)


WRONG = [
    (CELLS.astype(np.int64), "cells has dtype int64; allowed: a 2-D numpy array of int8 or uint8"),
    (CELLS.astype(float), "cells has dtype float64; allowed"),
    (CELLS == 0, "cells has dtype bool"),
    (CELLS[0], "cells has 1 dimensions; allowed: a 2-D"),
    (np.broadcast_to(np.int8(0), (10**5, 10**5)), "100000 x 100000 cells; at most 400000000"),
    (CELLS.tolist(), "cells is a list; allowed"),
    (None, "cells is a NoneType; allowed"),
    (np.array([[0, 0], [0, -2]], np.int8), r"cells\[1, 1\] is -2; allowed: 0 .* -1 for unknown"),
    (np.array([[0, 205]], np.uint8), r"cells\[0, 1\] is 205; allowed: 0 .* 255 for unknown"),
    (np.zeros((0, 3), np.int8), "0"),
    (np.zeros((1, 40_000), np.int8), "40000"),
]


@pytest.mark.parametrize(("cells", "reason"), WRONG)
def test_arrays_that_are_no_map(cells, reason):
    with pytest.raises(ValueError, match=reason):
        backcast.Map.from_array(cells, 0.05)


def test_places_that_are_none():
    for resolution in (0.0, -1.0, math.nan, math.inf, 11.0):
        with pytest.raises(ValueError, match="resolution"):
            backcast.Map.from_array(CELLS, resolution)
    for origin in [(0, 0), (0, 0, math.nan), "abc", 5, (0, 0, "x"), (1e9, 0, 0)]:
        with pytest.raises(ValueError, match="origin|x 1"):
            backcast.Map.from_array(CELLS, 0.05, origin)
    with pytest.raises(TypeError):
        backcast.Map.from_array(CELLS, "wide")


def test_a_map_can_be_pickled_and_copied():
    map = backcast.Map.from_array(CELLS, 0.5, origin=(1.0, 2.0, 0.3))
    for same in (pickle.loads(pickle.dumps(map)), copy.copy(map), copy.deepcopy(map)):
        assert same == map and same.origin == map.origin
