# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Starts an axis.

ros2 launch stickslip_sim sim.launch.py scene:=paper_fig7 rate:=2000 namespace:=press record:=true
ros2 launch stickslip_sim sim.launch.py parameters:='drive.velocity:=0.005 axis.mass:=200.0'

What is left empty is as the scene has it.
"""

import shlex

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from stickslip_sim.ros.launch_arguments import check_arguments

ARGUMENTS = {
    'scene': ('paper_fig8', 'shipped scene, or a parameter file'),
    'namespace': ('', 'namespace of the node and its topics'),
    'mode': ('', 'time mode: realtime, lockstep or free_run'),
    'rate': ('', 'steps per second of simulation time'),
    'record': ('', 'true: record a bag from the start; false: none'),
    'folder': ('', 'new folder of the bag, which must not exist; empty: one below runs/'),
    'parameters': ('', "further parameters, like 'drive.velocity:=0.005 seed:=3'"),
    'joint_states': ('joint_states', 'topic of the joint states; with a leading slash, axes in several namespaces share'
                     ' it and need prefixes'),
    'clock': ('/clock', 'topic of the clock in lockstep and free_run; in the namespace without a leading slash'),
}
PARAMETERS = {'scene': 'scene', 'mode': 'time.mode', 'rate': 'time.rate', 'record': 'record.enabled',
              'folder': 'record.folder'}


def generate_launch_description() -> LaunchDescription:
    """Return the node with its arguments."""
    return LaunchDescription([
        OpaqueFunction(function=lambda _: check_arguments(__file__, ARGUMENTS)),
        *(DeclareLaunchArgument(name, default_value=value, description=text)
          for name, (value, text) in ARGUMENTS.items()),
        OpaqueFunction(function=axis),
    ])


def axis(context: LaunchContext) -> list[Node]:
    """Return the node for the arguments that are given."""
    given = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    words = [f'{parameter}:={given[name]}' for name, parameter in PARAMETERS.items() if given[name]]
    words += further(given['parameters'])
    return [Node(
        package='stickslip_sim',
        executable='sim_node',
        name='feed_axis',
        namespace=given['namespace'],
        # Not as `parameters`: launch makes a file of those, and in a file `scene` is no file.
        arguments=['--ros-args', *(argument for word in words for argument in ('-p', word))],
        remappings=[('/clock', given['clock']), ('joint_states', given['joint_states'])],
        output='screen',
    )]


def further(text: str) -> list[str]:
    """Return the words of `parameters`; raises ValueError for what is no list of NAME:=VALUE."""
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise ValueError(f'parameters: {text}: {error}; close each quote') from error
    for word in words:
        if ':=' not in word:
            raise ValueError(f'parameters: {word}: give each as NAME:=VALUE, like seed:=3, without blanks around :=')
    return words
