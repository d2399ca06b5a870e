# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Starts several axes on one machine, each in a namespace of its own.

ros2 launch stickslip_sim axes.launch.py axes:='x:positioning y:cutting_force' record:=true
ros2 launch stickslip_sim axes.launch.py axes:='x:positioning y:positioning' joints:=/joint_states

All but the first argument are for all of them.
"""

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare

from stickslip_sim.ros.launch_arguments import check_arguments

# Those of sim.launch.py that are not of one axis alone: it declares them too, but --show-args cannot see that.
ARGUMENTS = {
    'axes': ('x:positioning y:positioning', 'NAMESPACE:SCENE of each axis; a scene is a shipped one or a file'),
    'mode': ('', 'time mode of all axes: realtime, lockstep or free_run; empty: as in the scene'),
    'rate': ('', 'steps per second of simulation time; empty: as in the scene'),
    'record': ('', 'true: record a bag of each axis from the start, below runs/; false: none; empty: as in the scene'),
    'joints': ('', 'common topic of the joint states, such as /joint_states, for one robot description; the namespace'
               ' of each axis becomes its prefix (x_axis_slider); empty: no joints'),
    'parameters': ('', "further parameters of all axes, like 'drive.velocity:=0.005 seed:=3'"),
}


def generate_launch_description() -> LaunchDescription:
    """Return the axes that are asked for."""
    return LaunchDescription([
        OpaqueFunction(function=lambda _: check_arguments(__file__, ARGUMENTS)),
        *(DeclareLaunchArgument(name, default_value=value, description=text)
          for name, (value, text) in ARGUMENTS.items()),
        OpaqueFunction(function=axes),
    ])


def axes(context: LaunchContext) -> list[IncludeLaunchDescription]:
    """Return an axis for each word; raises ValueError for one that is no NAMESPACE:SCENE, and for a second one."""
    words = LaunchConfiguration('axes').perform(context).split()
    scenes = {namespace.strip('/'): scene for namespace, _, scene in (word.partition(':') for word in words)}
    if not scenes or not all([*scenes, *scenes.values()]) or len(scenes) < len(words):
        raise ValueError(f'axes: {words}: give each as NAMESPACE:SCENE, like x:positioning, in a namespace of its own')
    joints, parameters = (LaunchConfiguration(name).perform(context) for name in ('joints', 'parameters'))
    sim = PathJoinSubstitution([FindPackageShare('stickslip_sim'), 'launch', 'sim.launch.py'])
    # Each has its own clock: two times on one /clock would be none.
    return [IncludeLaunchDescription(PythonLaunchDescriptionSource(sim), launch_arguments={
        'namespace': namespace, 'scene': scene, 'folder': '', 'clock': 'clock',
        'joint_states': joints or 'joint_states',
        'parameters': (joints_of(namespace) if joints else '') + parameters}.items())
        for namespace, scene in scenes.items()]


def joints_of(namespace: str) -> str:
    """Return the parameters of the joints of an axis, quoted twice: YAML takes a prefix like y for a truth value."""
    return f"""joint_interface.enabled:=true joint_interface.prefix:="'{namespace}_'" """
