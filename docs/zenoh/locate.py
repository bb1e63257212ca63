#!/usr/bin/env python3
"""Asks a locate_server where a scan was taken.

    pip install eclipse-zenoh
    locate_server --map recordings/malaga_corridor/map.yaml --name corridor
    backcast ... or any other program writes scan.json:
        {"angle_min": -1.57, "angle_increment": 0.0087, "range_max": 30.0,
         "ranges": [1.2, null, 1.3, ...]}          metres; null: nothing came back
    python3 docs/zenoh/locate.py corridor scan.json

Prints the places as JSON. The request is JSON because any program can write it;
docs/locate_server.md explains the request and the reply.
"""

import argparse
import json
import sys
import time

import zenoh

SCAN = "application/json;backcast.Scan/v1"
REFUSED = "text/plain;backcast.Refused/v1"


def locate(session, map_name, scan, seconds=2.0):
    """The answer as a dictionary; asks again where a server died or all are busy."""
    due = time.monotonic() + seconds
    said = "no server answers for this map"
    while (left := due - time.monotonic()) > 0:
        replies = session.get(
            f"backcast/locate/{map_name}?deadline_ms={max(1, int(left * 1000))}",
            payload=json.dumps(scan, allow_nan=False),
            encoding=zenoh.Encoding(SCAN),
            timeout=left,
        )
        for reply in replies:
            if reply.ok is not None:
                return json.loads(reply.ok.payload.to_bytes())
            encoding = str(reply.err.encoding)
            # Zenoh itself only says that the time is over.
            if "backcast." in encoding:
                said = reply.err.payload.to_string()
            if encoding == REFUSED:
                raise ValueError(said)
        time.sleep(0.02)
    raise TimeoutError(said)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map", help="what the server calls the map")
    parser.add_argument("scan", help="the scan, a JSON file, or - for standard input")
    parser.add_argument("--connect", default="tcp/127.0.0.1:7447", help="a Zenoh endpoint")
    parser.add_argument("--seconds", type=float, default=2.0, help="how long it may take")
    arguments = parser.parse_args()
    with sys.stdin if arguments.scan == "-" else open(arguments.scan) as file:
        scan = json.load(file)
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", json.dumps([arguments.connect]))
    config.insert_json5("scouting/multicast/enabled", "false")
    with zenoh.open(config) as session:
        try:
            print(json.dumps(locate(session, arguments.map, scan, arguments.seconds), indent=1))
        except (ValueError, TimeoutError) as problem:
            sys.exit(f"{arguments.map}: {problem}")


if __name__ == "__main__":
    main()
