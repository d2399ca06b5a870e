"""Starts the axis.

ros2 launch stickslip_sim sim.launch.py scene:=paper_fig7 namespace:=press record:=true
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description() -> LaunchDescription:
    """Return the node with its arguments."""
    return LaunchDescription([
        DeclareLaunchArgument('scene', default_value='paper_fig8', description='shipped scene, or a parameter file'),
        DeclareLaunchArgument('namespace', default_value='', description='namespace of the node and its topics'),
        DeclareLaunchArgument('record', default_value='false', description='whether to record a bag from the start'),
        Node(
            package='stickslip_sim',
            executable='sim_node',
            name='feed_axis',
            namespace=LaunchConfiguration('namespace'),
            # Not as `parameters`: launch makes a file of those, and in a file `scene` is no file.
            arguments=['--ros-args', '-p', ['scene:=', LaunchConfiguration('scene')],
                       '-p', ['record.enabled:=', LaunchConfiguration('record')]],
            output='screen',
        ),
    ])
