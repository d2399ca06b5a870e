# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Starts an axis, a controller and a recording; ends with the first of both nodes that ends.

ros2 launch stickslip_sim controlled.launch.py controller:=compensating_controller feed:=0.0005

The arguments of sim.launch.py are there too.
"""

from launch import LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    IncludeLaunchDescription,
    OpaqueFunction,
    RegisterEventHandler,
    Shutdown,
)
from launch.event_handlers import OnProcessExit
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

from stickslip_sim.ros.launch_arguments import check_arguments

ARGUMENTS = {
    'scene': ('positioning', 'shipped scene of the axis, or a parameter file'),
    'controller': ('cascade_controller', 'controller that moves the axis'),
    'namespace': ('', 'namespace of both nodes and their topics'),
    'prefix': ('', 'prefix of the joint names, joint_interface.prefix of both nodes'),
    'feed': ('0.0005', 'feed of the moves, m/s'),
    'travel': ('0.002', 'travel of a move, m'),
    'record': ('true', 'true: record a bag from the start; false: none'),
    'parameters': ('', "further parameters of the axis, like 'encoder.resolution:=1.0e-6 seed:=3'"),
}
CHOICES = {'controller': ['cascade_controller', 'compensating_controller']}
# The axis stands until the controller moves it.
OF_THE_AXIS = 'joint_interface.enabled:=true drive.course:=constant drive.velocity:=0.0 joint_interface.prefix:='


def generate_launch_description() -> LaunchDescription:
    """Return both nodes with their arguments; when one ends, the other does."""
    given = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    sim = PathJoinSubstitution([FindPackageShare('stickslip_sim'), 'launch', 'sim.launch.py'])
    return LaunchDescription([
        OpaqueFunction(function=lambda _: check_arguments(__file__, ARGUMENTS, 'sim.launch.py')),
        *(DeclareLaunchArgument(name, default_value=value, description=text, choices=CHOICES.get(name))
          for name, (value, text) in ARGUMENTS.items()),
        RegisterEventHandler(OnProcessExit(on_exit=[Shutdown()])),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(sim), launch_arguments={
            'parameters': [OF_THE_AXIS, '"\'', given['prefix'], '\'" ', given['parameters']]}.items()),
        Node(
            package='stickslip_sim',
            executable=given['controller'],
            namespace=given['namespace'],
            arguments=['--ros-args', '-p', ['moves.feed:=', given['feed']], '-p', ['moves.travel:=', given['travel']],
                       '-p', ["joint_interface.prefix:='", given['prefix'], "'"]],
            output='screen',
        ),
    ])
