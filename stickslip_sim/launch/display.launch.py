# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Shows the motion of an axis in RViz: the axis, its robot description as transforms, and RViz.

ros2 launch stickslip_sim display.launch.py scene:=positioning prefix:=x_
ros2 launch stickslip_sim display.launch.py axis:=false description:=cross_table.urdf.xacro

The arguments of sim.launch.py are there too.  Needs robot_state_publisher and xacro, and rviz2 unless rviz:=false.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

from stickslip_sim.ros.launch_arguments import check_arguments

ARGUMENTS = {
    'scene': ('paper_fig8', 'shipped scene of the axis, or a parameter file'),
    'prefix': ('', 'prefix of the joints, links and frames, as joint_interface.prefix'),
    'axis': ('true', 'false: start no axis, but show those that publish on joint_states already'),
    'rviz': ('true', 'false: start no RViz, for a viewer of your own'),
    'description': ('feed_axis.urdf.xacro', 'robot description: a file of share/stickslip_sim/urdf, or a path'),
    'rviz_config': ('feed_axis.rviz', 'settings of RViz: a file of share/stickslip_sim/rviz, or a path'),
    'joint_states': ('/joint_states', 'topic of the joint states, also with a namespace'),
    'use_sim_time': ('false', 'true: transforms and RViz follow /clock, as with mode:=free_run'),
    'parameters': ('', "further parameters of the axis, like 'drive.velocity:=0.005 seed:=3'"),
}
CHOICES = {name: ['true', 'false'] for name in ('axis', 'rviz', 'use_sim_time')}


def generate_launch_description() -> LaunchDescription:
    """Return the robot description, RViz and the axis."""
    given = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    sim = PathJoinSubstitution([FindPackageShare('stickslip_sim'), 'launch', 'sim.launch.py'])
    # Words are quoted: a path may have blanks, and YAML takes a prefix like y for a truth value.
    description = Command(["xacro '", shipped('urdf', 'description'), "' 'prefix:=", given['prefix'], "'"])
    sim_time = {'use_sim_time': ParameterValue(given['use_sim_time'], value_type=bool)}
    joints = ["joint_interface.enabled:=true joint_interface.prefix:=\"'", given['prefix'], "'\" "]
    return LaunchDescription([
        OpaqueFunction(function=lambda _: check_arguments(__file__, ARGUMENTS, 'sim.launch.py')),
        *(DeclareLaunchArgument(name, default_value=value, description=text, choices=CHOICES.get(name))
          for name, (value, text) in ARGUMENTS.items()),
        Node(package='robot_state_publisher', executable='robot_state_publisher', output='screen',
             parameters=[{'robot_description': ParameterValue(description, value_type=str)}, sim_time],
             remappings=[('joint_states', given['joint_states'])]),
        Node(package='rviz2', executable='rviz2', output='screen', arguments=['-d', shipped('rviz', 'rviz_config')],
             parameters=[sim_time], condition=IfCondition(given['rviz'])),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(sim), condition=IfCondition(given['axis']),
                                 launch_arguments={'parameters': [*joints, given['parameters']]}.items()),
    ])


def shipped(folder: str, argument: str) -> PathJoinSubstitution:
    """Return the path of a file of a folder of the package; a path that begins with / stays as it is."""
    return PathJoinSubstitution([FindPackageShare('stickslip_sim'), folder, LaunchConfiguration(argument)])
