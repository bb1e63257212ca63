"""The graph that stands in the place of nav2_amcl, as a descriptor for `backcast run`."""

import json
import shlex

_GRAPH = """\
nodes:
  - id: ros2_gateway
    path: ros2_gateway
    args: {arguments}
    inputs:
      hypotheses: peak_extractor/hypotheses
      pose: tracker/pose
    outputs: [scan, odometry, map, initial_pose]
    restart_policy: on-failure
  - id: boundary_extractor
    path: boundary_extractor
    inputs:
      map: ros2_gateway/map
    outputs: [boundary]
    restart_policy: on-failure
  - id: accumulator
    path: accumulator
    inputs:
      scan: ros2_gateway/scan
      map: ros2_gateway/map
      boundary: boundary_extractor/boundary
      odometry: ros2_gateway/odometry
      attention: tracker/attention
    outputs: [votes]
    restart_policy: on-failure
  - id: peak_extractor
    path: peak_extractor
    inputs:
      votes: accumulator/votes
      scan: ros2_gateway/scan
      map: ros2_gateway/map
    outputs: [hypotheses]
    restart_policy: on-failure
  - id: tracker
    path: tracker
    inputs:
      scan: ros2_gateway/scan
      odometry: ros2_gateway/odometry
      map: ros2_gateway/map
      hypotheses: peak_extractor/hypotheses
      initial_pose: ros2_gateway/initial_pose
    outputs: [pose, attention]
    restart_policy: on-failure
"""


def descriptor(namespace='', params_file='', use_sim_time=False, log_level='info'):
    """The descriptor's text; the robot's map comes from its map server, on topic `map`."""
    arguments = ['--as', 'amcl', '--ros-args', '--log-level', log_level]
    if namespace:
        arguments += ['-r', '__ns:=/' + namespace.strip('/')]
    # As nav2_bringup has it: the transforms of each robot are in its namespace.
    arguments += ['-r', '/tf:=tf', '-r', '/tf_static:=tf_static']
    if params_file:
        arguments += ['--params-file', params_file]
    arguments += ['-p', 'use_sim_time:=' + ('true' if use_sim_time else 'false')]
    # A string of JSON is one of YAML.
    return _GRAPH.format(arguments=json.dumps(shlex.join(arguments)))
