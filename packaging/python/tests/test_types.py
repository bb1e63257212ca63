"""What type checkers and editors are told is what is there."""

import ast
import inspect
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import backcast

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

STUBS = Path(backcast.__file__).parent / "_backcast.pyi"



def run(*arguments, **others):
    return subprocess.run(
        [sys.executable, "-m", *arguments], capture_output=True, text=True, **others
    )


def test_the_stubs_say_what_is_there():
    done = run("mypy.stubtest", "backcast")
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_package_says_that_it_has_types():
    assert (STUBS.parent / "py.typed").is_file()


SOUND = """
import backcast

map = backcast.Map.from_yaml("map.yaml")
localizer = backcast.Localizer(map, taper="box", max_beams=90)
result = localizer.locate([1.0, 2.0], 0.0, 0.1, mount=(0.1, 0.0, 0.0))
scan = backcast.Scan([1.0, 2.0], 0.0, 0.1)
print(localizer.locate([scan, scan], heading=0.5), localizer.locate(scan))
if result.pose is not None:
    x, y, yaw = result.pose
    print(x + y + yaw, result.poses.shape)
tracker = backcast.Tracker(map, sure=0.9)
tracked = tracker.update([1.0], 0.0, 0.1, 5)
print(tracked.pose, tracker.update([scan, scan], odometry=(0.0, 0.0, 0.0)).left_out)
"""


MISTAKES = {
    "taper": ('taper="box"', 'taper="round"'),
    "beams": ("max_beams=90", "beams=90"),
    "None": ("if result.pose is not None", "if True"),
    "deskew": ("sure=0.9", "deskew=3"),
}


def test_a_type_checker_sees_mistakes(tmp_path):
    (tmp_path / "sound.py").write_text(SOUND)
    for name, change in MISTAKES.items():
        (tmp_path / f"wrong_{name}.py").write_text(SOUND.replace(*change))
    done = run("mypy", "--strict", "--no-incremental", ".", cwd=tmp_path)
    errors = [line for line in done.stdout.splitlines() if ": error: " in line]
    assert [line for line in errors if line.startswith("sound.py")] == []
    for name in MISTAKES:
        of_file = [line for line in errors if line.startswith(f"wrong_{name}.py")]
        assert any(name in line.split(": error: ")[1] for line in of_file), done.stdout


def test_docstrings_are_in_the_stubs_too():
    """Editors show those of the stubs, for they do not import the module."""
    found = 0
    for of in ast.parse(STUBS.read_text()).body:
        if not isinstance(of, ast.ClassDef):
            continue
        kind, documented = getattr(backcast, of.name), set()
        check_doc(of, kind)
        for member in of.body:
            if isinstance(member, ast.FunctionDef) and not member.name.startswith("__"):
                if member.name in documented and member.decorator_list:
                    continue  # Editors show what the first overload says.
                check_doc(member, getattr(kind, member.name))
                documented.add(member.name)
                found += 1
    assert found > 40


def check_doc(node, there):
    assert ast.get_docstring(node) == inspect.cleandoc(there.__doc__), node.name


def test_each_option_of_the_command_is_a_setting(command):
    text = command("locate", "--help")
    engine = text[text.index("\nEngine:\n") :]
    options = set(re.findall(r"^ +--([a-z0-9-]+)", engine, re.MULTILINE))
    settings = {key.replace("_", "-") for key in backcast.Settings.__annotations__}
    assert settings == options


def test_each_setting_is_one_of_the_engine():
    cells = np.array([[0, 100]], np.int8)
    map = backcast.Map.from_array(cells, 0.1)
    for of, settings in (
        (backcast.Localizer, backcast.Settings),
        (backcast.Tracker, backcast.TrackerSettings),
    ):
        keys = {key for base in settings.__mro__ for key in getattr(base, "__annotations__", {})}
        of(map, **dict.fromkeys(keys))
        with pytest.raises(TypeError, match="none is no setting") as error:
            of(map, none=1)
        allowed = str(error.value).split("allowed: ")[1].split(", ")
        assert set(allowed) == keys


def test_what_is_linked_is_what_the_command_links():
    """Another version of a library may round otherwise."""

    def versions(lock):
        packages = tomllib.loads(lock.read_text())["package"]
        return {(package["name"], package["version"]) for package in packages}

    here, there = versions(ROOT / "packaging/python/Cargo.lock"), versions(ROOT / "Cargo.lock")
    names = {name for name, _ in there}
    assert {(name, version) for name, version in here - there if name in names} == set()
    assert len(here & there) > 50


def test_the_release_profile_is_the_workspaces():
    def profile(folder):
        text = tomllib.loads((folder / "Cargo.toml").read_text())
        return {k: v for k, v in text["profile"]["release"].items() if k != "package"}

    assert profile(ROOT / "packaging/python") == profile(ROOT)


def test_the_version_is_the_workspaces():
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["package"]
    package = tomllib.loads((ROOT / "packaging/python/Cargo.toml").read_text())["package"]
    assert backcast.__version__ == workspace["version"] == package["version"]
    for key in ("edition", "rust-version", "license"):
        assert package[key] == workspace[key]
