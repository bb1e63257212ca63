#!/usr/bin/env python3
"""Prints where a robot is, each time that its bridge says it.

    pip install eclipse-zenoh
    python3 docs/zenoh/pose.py tcp/192.168.0.7:7447 r2
"""

import json
import sys

import zenoh

endpoint, robot = sys.argv[1:]
config = zenoh.Config()
config.insert_json5("mode", '"client"')
config.insert_json5("connect/endpoints", json.dumps([endpoint]))
with zenoh.open(config) as session:
    poses = session.declare_subscriber(f"backcast/{robot}/pose/json")
    for sample in poses:
        pose = json.loads(sample.payload.to_bytes())
        print(pose["state"], pose["base"] or pose["laser"], pose["says"], flush=True)
