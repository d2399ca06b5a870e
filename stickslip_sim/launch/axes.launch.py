# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Starts several axes on one machine, each in a namespace of its own.

ros2 launch stickslip_sim axes.launch.py axes:='x:positioning y:cutting_force' record:=true

The arguments of sim.launch.py but scene, namespace, folder and clock are there too, and are for all of them.
"""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description() -> LaunchDescription:
    """Return the axes that are asked for."""
    return LaunchDescription([
        DeclareLaunchArgument('axes', default_value='x:positioning y:positioning',
                              description='NAMESPACE:SCENE of each, the scene shipped or a parameter file'),
        OpaqueFunction(function=axes),
    ])


def axes(context: LaunchContext) -> list[IncludeLaunchDescription]:
    """Return an axis for each word; raises ValueError for one that is no NAMESPACE:SCENE, and for a second one."""
    words = LaunchConfiguration('axes').perform(context).split()
    scenes = {namespace: scene for namespace, _, scene in (word.partition(':') for word in words)}
    if not all([*scenes, *scenes.values()]) or len(scenes) < len(words):
        raise ValueError(f'axes: {words}: give each as NAMESPACE:SCENE, like x:positioning, in a namespace of its own')
    sim = PathJoinSubstitution([FindPackageShare('stickslip_sim'), 'launch', 'sim.launch.py'])
    # Each has its own clock: two times on one /clock would be none.
    return [IncludeLaunchDescription(PythonLaunchDescriptionSource(sim), launch_arguments={
        'namespace': namespace, 'scene': scene, 'folder': '', 'clock': 'clock'}.items())
        for namespace, scene in scenes.items()]
