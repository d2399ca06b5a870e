# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Starts the axis and ros2_control with a controller on it.

ros2 launch stickslip_sim ros2_control.launch.py scene:=positioning controller:=position_controller record:=true

The arguments of sim.launch.py are there too.  Needs controller_manager, robot_state_publisher, xacro,
joint_state_topic_hardware_interface and the controllers of ros2_control/controllers.yaml (docs/ros2_control.md).
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from stickslip_sim.ros.launch_arguments import check_arguments

ARGUMENTS = {
    'scene': ('positioning', 'shipped scene, or a parameter file'),
    'namespace': ('machine', 'namespace of the axis and its topics'),
    'controller': ('velocity_controller', 'controller of the axis'),
    'parameters': ('', "further parameters of the axis, like 'seed:=3'"),
}
CHOICES = {'controller': ['velocity_controller', 'position_controller']}
FOLDER = [FindPackageShare('stickslip_sim'), 'ros2_control']


def generate_launch_description() -> LaunchDescription:
    """Return the axis in a namespace of its own, so that its joint_states are not those of the broadcaster."""
    controllers = PathJoinSubstitution([*FOLDER, 'controllers.yaml'])
    return LaunchDescription([
        OpaqueFunction(function=lambda _: check_arguments(__file__, ARGUMENTS, 'sim.launch.py')),
        *(DeclareLaunchArgument(name, default_value=value, description=text, choices=CHOICES.get(name))
          for name, (value, text) in ARGUMENTS.items()),
        Node(package='robot_state_publisher', executable='robot_state_publisher', output='screen',
             parameters=[{'robot_description': ParameterValue(description(), value_type=str)}]),
        Node(package='controller_manager', executable='ros2_control_node', output='screen', parameters=[controllers],
             remappings=[('~/robot_description', '/robot_description')]),
        *(Node(package='controller_manager', executable='spawner', output='screen',
               arguments=[name, '--param-file', controllers])
          for name in ('joint_state_broadcaster', LaunchConfiguration('controller'))),
        axis(),   # last: where one of the packages is missing, nothing has been started
    ])


def axis() -> IncludeLaunchDescription:
    """Return the simulated axis, with its joints."""
    sim = PathJoinSubstitution([FindPackageShare('stickslip_sim'), 'launch', 'sim.launch.py'])
    return IncludeLaunchDescription(PythonLaunchDescriptionSource(sim), launch_arguments={
        'parameters': ['joint_interface.enabled:=true ', LaunchConfiguration('parameters')]}.items())


def description() -> Command:
    """Return the robot description, on the topics of the axis; its words are quoted, for a path may have blanks."""
    file = PathJoinSubstitution([*FOLDER, 'feed_axis.ros2_control.xacro'])
    topics = (word for name in ('joint_states', 'joint_commands')
              for word in (f"' '{name}_topic:=", PathJoinSubstitution(['/', LaunchConfiguration('namespace'), name])))
    return Command(["xacro '", file, *topics, "'"])
