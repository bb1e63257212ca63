"""Errors of a trajectory by evo: trajectory_errors.py TRUTH FOUND, both in the TUM format."""

import json
import sys

import numpy as np
from evo.core import metrics, sync
from evo.core.trajectory import PoseTrajectory3D


def read(path):
    rows = np.loadtxt(path)
    return PoseTrajectory3D(
        positions_xyz=rows[:, 1:4],
        orientations_quat_wxyz=rows[:, [7, 4, 5, 6]],
        timestamps=rows[:, 0],
    )


def spread(metric, pair):
    metric.process_data(pair)
    kinds = metrics.StatisticsType
    names = {"rmse": kinds.rmse, "median": kinds.median, "max": kinds.max}
    return {name: metric.get_statistic(kind) for name, kind in names.items()}


def main():
    pair = sync.associate_trajectories(*map(read, sys.argv[1:]))
    relation = metrics.PoseRelation
    step = {"delta": 1, "delta_unit": metrics.Unit.frames}
    print(
        json.dumps(
            {
                "poses": pair[0].num_poses,
                "ape_m": spread(metrics.APE(relation.translation_part), pair),
                "rpe_m": spread(metrics.RPE(relation.translation_part, **step), pair),
                "rpe_deg": spread(metrics.RPE(relation.rotation_angle_deg, **step), pair),
            }
        )
    )


main()
