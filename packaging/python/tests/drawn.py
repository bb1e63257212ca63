"""A drawn hall, and what a laser sees in it."""

import math

import numpy as np

import backcast

RESOLUTION = 0.1


def hall():
    """12 m × 8 m with a store room in a corner; no turn and no mirror makes it look alike."""
    cells = np.zeros((80, 120), np.int8)
    cells[:2] = cells[-2:] = 100
    cells[:, :2] = cells[:, -2:] = 100
    cells[51:, 76:] = 100
    return cells


def hall_map():
    return backcast.Map.from_array(hall(), RESOLUTION)


def ranges_at(x, y, yaw, beams=360):
    """What a laser with a beam a degree reads at a pose, metres."""
    cells = hall()
    ranges = []
    for beam in range(beams):
        bearing = yaw + math.radians(beam)
        step = 0
        while True:
            r = 0.02 * step
            column = int((x + r * math.cos(bearing)) / RESOLUTION)
            row = int((y + r * math.sin(bearing)) / RESOLUTION)
            if cells[row, column]:
                break
            step += 1
        ranges.append(r)
    return np.array(ranges, np.float32)


ANGLES = (0.0, math.radians(1.0))
