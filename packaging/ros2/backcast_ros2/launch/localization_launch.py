"""Localization for Nav2 by Backcast: leave nav2_bringup's localization_launch.py out, include this.

It has the arguments of that file. The map server and the lifecycle manager are Nav2's own; in the
place of nav2_amcl a graph of `backcast run` is the managed node `amcl`. The graph is processes of its
own, so that `use_composition` and `container_name` change nothing for it.
"""

import os
import tempfile

from backcast_ros2.graph import descriptor
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.descriptions import ParameterFile
from nav2_common.launch import RewrittenYaml

ARGUMENTS = [
    ('namespace', '', 'Namespace of all nodes'),
    ('map', '', 'The map, a YAML file; empty: that of the parameters of map_server'),
    ('use_sim_time', 'false', 'Take the time from /clock'),
    ('params_file', '', 'Parameters of map_server, amcl and the lifecycle manager'),
    ('autostart', 'true', 'Configure and activate the nodes at the start'),
    ('use_composition', 'False', 'Changes nothing: all are processes of their own'),
    ('container_name', 'nav2_container', 'Changes nothing'),
    ('use_respawn', 'False', 'Start again what ends; nodes of the graph are anyway'),
    ('log_level', 'info', 'debug, info, warn, error or fatal'),
    ('graph', '', 'A descriptor of your own for backcast run; empty: the usual graph'),
]


def is_true(text):
    return text.lower() in ('true', '1')


def start(context):
    value = {name: LaunchConfiguration(name).perform(context) for name, *_ in ARGUMENTS}
    namespace, params_file = value['namespace'], value['params_file']
    use_sim_time, respawn = is_true(value['use_sim_time']), is_true(value['use_respawn'])
    parameters = []
    if params_file:
        rewritten = RewrittenYaml(
            source_file=params_file, root_key=namespace, param_rewrites={}, convert_types=True
        )
        params_file = rewritten.perform(context)
        parameters = [ParameterFile(params_file, allow_substs=True)]
    graph = value['graph']
    if not graph:
        text = descriptor(namespace, params_file, use_sim_time, value['log_level'])
        graph = os.path.join(tempfile.mkdtemp(prefix='backcast_'), 'localization.yaml')
        with open(graph, 'w') as file:
            file.write(text)
    clock = {'use_sim_time': use_sim_time}
    shared = {
        'namespace': namespace,
        'output': 'screen',
        'respawn': respawn,
        'respawn_delay': 2.0,
        'arguments': ['--ros-args', '--log-level', value['log_level']],
        'remappings': [('/tf', 'tf'), ('/tf_static', 'tf_static')],
    }
    map_file = [{'yaml_filename': value['map']}] if value['map'] else []
    return [
        Node(
            package='nav2_map_server',
            executable='map_server',
            name='map_server',
            parameters=[*parameters, clock, *map_file],
            **shared,
        ),
        ExecuteProcess(
            cmd=['backcast', 'run', graph], output='screen', respawn=respawn, respawn_delay=2.0
        ),
        Node(
            package='nav2_lifecycle_manager',
            executable='lifecycle_manager',
            name='lifecycle_manager_localization',
            parameters=[
                clock,
                {'autostart': is_true(value['autostart']), 'node_names': ['map_server', 'amcl']},
            ],
            **shared,
        ),
    ]


def generate_launch_description():
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, default, description in ARGUMENTS
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
