"""The recordings of the repository, and the command that answers must be equal to."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
RECORDINGS = ROOT / "recordings"
NAMES = ["malaga_corridor", "malaga_courtyard", "malaga_campus"]


@pytest.fixture(scope="session")
def command():
    """Runs backcast; a test is left out only where nobody says that it must be there, and
    never where CI is set."""
    given = os.environ.get("BACKCAST")
    path = Path(given or ROOT / "target/release/backcast")
    if not path.is_file():
        assert given is None, f"BACKCAST is {path}, which is no file"
        assert not os.environ.get("CI"), f"{path} is not there, and CI is set"
        pytest.skip(f"{path} is not there: cargo build --release makes it, or BACKCAST names it")

    def run(*arguments):
        done = subprocess.run([path, *map(str, arguments)], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def located(command):
    """The lines that the command prints for a recording, once for each set of options."""
    known = {}

    def run(name, *options):
        key = (name, *options)
        if key not in known:
            folder = RECORDINGS / name
            text = command(
                "locate",
                folder / "recording.mcap",
                "--map",
                folder / "map.yaml",
                "--json",
                *options,
            )
            known[key] = [json.loads(line) for line in text.splitlines()]
        return known[key]

    return run
