# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Plays a recorded run back onto its topics.

ros2 launch stickslip_sim replay.launch.py bag:=runs/paper_fig8_20260101T120000Z rate:=0.5 clock:=100.0
"""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from stickslip_sim.ros.launch_arguments import check_arguments

ARGUMENTS = {
    'bag': (None, 'folder of the run, or its .mcap file'),
    'mode': ('states', 'states: every recorded topic; commands: the recorded commands, into a live axis'),
    'rate': ('1.0', 'speed: seconds of the recording per second'),
    'loop': ('false', 'true: start again at the end'),
    'start_offset': ('0.0', 'seconds of the recording to skip at its start'),
    'playback_duration': ('-1.0', 'seconds of the recording to play; -1: to its end'),
    'delay': ('0.0', 'seconds to wait before it plays, each time'),
    'start_paused': ('false', 'true: wait for ~/resume at the start'),
    'clock': ('0.0', 'rate of /clock, Hz; 0: not published'),
    'topics': ('', "topics to play, like '[slider_state, mode_event]'; empty: all"),
    'axis': ('', 'with mode:=commands: the node that takes them; empty: feed_axis, in the namespace of the commands'),
}
CHOICES = {'mode': ['states', 'commands']}


def generate_launch_description() -> LaunchDescription:
    """Return the node with its arguments."""
    return LaunchDescription([
        OpaqueFunction(function=lambda _: check_arguments(__file__, ARGUMENTS)),
        *(DeclareLaunchArgument(name, default_value=value, description=text, choices=CHOICES.get(name))
          for name, (value, text) in ARGUMENTS.items()),
        OpaqueFunction(function=replay),
    ])


def replay(context: LaunchContext) -> list[Node]:
    """Return the node for the arguments that are given."""
    given = {name: LaunchConfiguration(name).perform(context) for name in ARGUMENTS}
    return [Node(
        package='stickslip_sim',
        executable='replay_node',
        name='replay',
        arguments=['--ros-args', *(word for name, value in given.items() if value
                                   for word in ('-p', f'{name}:={value}'))],
        output='screen',
    )]
