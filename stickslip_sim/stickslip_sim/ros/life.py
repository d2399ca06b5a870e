"""The life of the process around the node, from its arguments to the exit code."""

import sys
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .parameters import FileParameters
    from .sim_node import Signals

_USAGE = """\
usage: sim_node [--help] [--ros-args [--params-file SCENE.yaml] [-p NAME:=VALUE]... [-r __ns:=/NAMESPACE]]

Simulates a feed axis with stick-slip friction in real time (node feed_axis).  Without a file it runs the scene
paper_fig8; -p scene:=NAME takes another shipped one, -p record.enabled:=true records a bag from the start.
"""
_POLL = 0.1                # s: how soon a signal is acted on
_SWITCH_INTERVAL = 2e-4    # s that a callback may keep the interpreter from the step loop (the default is 5 ms)


def live(args: Sequence[str], signals: 'Signals') -> int:
    """Bring the node up and down; return the exit code.  ROS and numba are imported in here, where errors are met."""
    from ..errors import StickslipError
    from .environment import check_environment

    sys.setswitchinterval(_SWITCH_INTERVAL)
    try:
        check_environment()
        return _with_ros(args, signals)
    except StickslipError as error:
        return _refuse(str(error), error.exit_code)


def _with_ros(args: Sequence[str], signals: 'Signals') -> int:
    import rclpy
    from rclpy.executors import ExternalShutdownException

    from .parameters import FileParameters

    files = FileParameters.read(list(params_files(args)))
    try:
        _init_ros(args)
        if _wants_help(args):
            sys.stdout.write(_USAGE)
            return 0
        return _spin(signals, files)
    except ExternalShutdownException:
        return 0
    finally:
        rclpy.try_shutdown()


def params_files(args: Sequence[str]) -> Iterator[str]:
    """Yield the parameter files among arguments, which stand between --ros-args and --."""
    is_of_ros = False
    for word, following in zip(args, [*args[1:], '']):
        if word in ('--ros-args', '--'):
            is_of_ros = word == '--ros-args'
        elif is_of_ros and word == '--params-file' and following:
            yield following


def _wants_help(args: Sequence[str]) -> bool:
    """Return whether help is asked for; raises InputError on words that are none of ROS's."""
    from rclpy.utilities import remove_ros_args

    from ..errors import InputError

    words = remove_ros_args(['sim_node', *args])[1:]
    if words and words[0] not in ('-h', '--help'):
        raise InputError('argument', words[0], 'one of -h, --help, or behind --ros-args', 'see sim_node --help')
    return bool(words)


def _spin(signals: 'Signals', files: 'FileParameters') -> int:
    from .node import FeedAxis

    node = FeedAxis(files, lambda: signals.stop)
    executor = make_executor()
    executor.add_node(node)
    try:
        signals.is_starting = False
        if not signals.stop:
            node.begin()
        while not signals.stop and node.loop.crash is None:
            executor.spin_once(timeout_sec=_POLL)
    finally:
        node.end()
        executor.remove_node(node)
        node.destroy_node()
    if node.loop.crash is not None:
        return _refuse(f'internal error in the step loop: {node.loop.crash!r}', 1)
    return 0


def make_executor() -> Any:
    """Return the executor that takes the least of the interpreter from the step loop (docs/loop.md)."""
    try:
        from rclpy.experimental import EventsExecutor
    except ImportError:
        from rclpy.executors import SingleThreadedExecutor
        return SingleThreadedExecutor()
    return EventsExecutor()


def _init_ros(args: Sequence[str]) -> None:
    """Initialise rclpy; raises InputError on arguments and parameter files that it refuses."""
    import rclpy
    from rclpy.logging import LoggingSeverity, set_logger_level
    from rclpy.signals import SignalHandlerOptions

    from .environment import refusing

    set_logger_level('rcl', LoggingSeverity.FATAL)    # it would say half of it in a line of its own
    with refusing('ROS arguments or environment', args):
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    set_logger_level('rcl', LoggingSeverity.UNSET)


def _refuse(text: str, code: int) -> int:
    sys.stderr.write('sim_node: ' + ' '.join(text.split()) + '\n')
    return code
