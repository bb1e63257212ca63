"""The examples of the README run as they stand."""

import math
import re

from conftest import RECORDINGS, ROOT
from recorded import read

import backcast


def test_the_examples_run(monkeypatch, capsys):
    monkeypatch.chdir(RECORDINGS / "malaga_corridor")
    text = (ROOT / "packaging/python/README.md").read_text()
    examples = re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    assert len(examples) == 3
    recorded = read("malaga_corridor")
    odometry = dict(recorded.odometry)
    scans = backcast.read("recording.mcap").scans["/scan"]
    drive = [(scan, odometry[scan.stamp_ns]) for scan in scans]
    angles = dict(zip(("angle_min", "angle_increment"), recorded.scans[4].angles, strict=True))
    rear = {"ranges": scans[4].ranges, "rear_ranges": [math.inf] * 361}
    names = {"drive": drive, **angles, **rear}
    for example in examples:
        exec(example, names)
    assert names["result"].verdict == "Unique"
    assert names["tracked"].state == "Unique" and "Unique" in capsys.readouterr().out
