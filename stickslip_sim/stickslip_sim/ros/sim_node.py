"""The executable `sim_node`: the life of the process around the node, from the first signal to the exit code."""

import os
import re
import signal
import sys
import threading
from collections.abc import Sequence
from typing import Any

_USAGE = """\
usage: sim_node [--help] [--ros-args [--params-file SCENE.yaml] [-p NAME:=VALUE]... [-r __ns:=/NAMESPACE]]

Simulates a feed axis with stick-slip friction in real time (node feed_axis).  Without a file it runs the scene
paper_fig8; -p scene:=NAME takes another shipped one, -p record.enabled:=true records a bag from the start.
"""
_POLL = 0.1                # s: how soon a signal is acted on
_SWITCH_INTERVAL = 2e-4    # s that a callback may keep the interpreter from the step loop (the default is 5 ms)


class _Signals:
    """Takes SIGINT and SIGTERM: they cut the start short, and end the run at the next look at `stop`."""

    def __init__(self) -> None:
        self.stop = threading.Event()
        self.is_starting = True
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._take)

    def _take(self, *_: object) -> None:
        self.stop.set()
        if self.is_starting:    # nothing is open yet; compiling may take long, and swallows exceptions
            os._exit(0)


def main(args: Sequence[str] | None = None) -> int:
    """Run until SIGINT or SIGTERM; return the exit code: 0 ended, 1 internal error, 2 refused start."""
    return _run(args, _Signals())


def _run(args: Sequence[str] | None, signals: _Signals) -> int:
    """Bring the node up and down.  ROS and numba are imported here, when signals are already taken care of."""
    import rclpy
    from rclpy.executors import ExternalShutdownException

    from ..errors import StickslipError

    sys.setswitchinterval(_SWITCH_INTERVAL)
    try:
        _init_ros(args)
        if _wants_help(args):
            sys.stdout.write(_USAGE)
            return 0
        return _live(signals, '--params-file' in (sys.argv if args is None else args))
    except StickslipError as error:
        return _refuse(str(error), error.exit_code)
    except ExternalShutdownException:
        return 0
    finally:
        rclpy.try_shutdown()


def _wants_help(args: Sequence[str] | None) -> bool:
    """Return whether help is asked for; raises InputError on words that are none of ROS's."""
    from rclpy.utilities import remove_ros_args

    from ..errors import InputError

    words = remove_ros_args(sys.argv if args is None else ['sim_node', *args])[1:]
    if words and words[0] not in ('-h', '--help'):
        raise InputError('argument', words[0], 'one of -h, --help, or behind --ros-args', 'see sim_node --help')
    return bool(words)


def _live(signals: _Signals, from_file: bool) -> int:
    from .node import FeedAxis

    node = FeedAxis(from_file)
    executor = make_executor()
    executor.add_node(node)
    try:
        signals.is_starting = False
        if not signals.stop.is_set():
            node.begin()
        while not signals.stop.is_set() and node.loop.crash is None:
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


def _init_ros(args: Sequence[str] | None) -> None:
    """Initialise rclpy; raises InputError on arguments and parameter files that it refuses."""
    import rclpy
    from rclpy.logging import LoggingSeverity, set_logger_level
    from rclpy.signals import SignalHandlerOptions

    from ..errors import InputError

    set_logger_level('rcl', LoggingSeverity.FATAL)    # it would say half of it in a line of its own
    try:
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:    # the base of all that rclpy raises there
        raise InputError('ROS arguments', sys.argv[1:] if args is None else args, 'understood by ROS',
                         re.sub(r',? at /\S+', '', str(error))) from None
    set_logger_level('rcl', LoggingSeverity.UNSET)


def _refuse(text: str, code: int) -> int:
    sys.stderr.write('sim_node: ' + ' '.join(text.split()) + '\n')
    return code


if __name__ == '__main__':
    sys.exit(main())
