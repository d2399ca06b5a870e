"""Starts the axis, a controller and a recording.

ros2 launch stickslip_sim controlled.launch.py controller:=compensating_controller feed:=0.0005
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

ARGUMENTS = {
    'scene': ('positioning', 'shipped scene of the axis, or a parameter file'),
    'controller': ('cascade_controller', 'cascade_controller or compensating_controller'),
    'namespace': ('', 'namespace of both nodes and their topics'),
    'feed': ('0.0005', 'of the moves, m/s'),
    'travel': ('0.002', 'of a move, m'),
    'record': ('true', 'whether to record a bag from the start'),
}


def generate_launch_description() -> LaunchDescription:
    """Return both nodes with their arguments."""
    given = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    return LaunchDescription([
        *(DeclareLaunchArgument(name, default_value=value, description=text)
          for name, (value, text) in ARGUMENTS.items()),
        Node(
            package='stickslip_sim',
            executable='sim_node',
            name='feed_axis',
            namespace=given['namespace'],
            # Not as `parameters`: launch makes a file of those, and in a file `scene` is no file.
            arguments=['--ros-args', '-p', ['scene:=', given['scene']],
                       '-p', 'joint_interface.enabled:=true',
                       '-p', 'drive.course:=constant', '-p', 'drive.velocity:=0.0',    # until the controller moves it
                       '-p', ['record.enabled:=', given['record']]],
            output='screen',
        ),
        Node(
            package='stickslip_sim',
            executable=given['controller'],
            namespace=given['namespace'],
            arguments=['--ros-args', '-p', ['moves.feed:=', given['feed']], '-p', ['moves.travel:=', given['travel']]],
            output='screen',
        ),
    ])
