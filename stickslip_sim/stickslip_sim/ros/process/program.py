# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The process around a node, from its arguments to the exit code."""

import gc
import sys
from collections.abc import Callable, Sequence
from itertools import takewhile
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from .given_parameters import GivenParameters
    from .stop_signals import Signals

_POLL = 0.1                # s: how soon a signal is acted on
SWITCH_INTERVAL = 5e-5    # s that another thread may keep the interpreter from a step loop (the default is 5 ms)


class Program(NamedTuple):
    """An executable; `run` runs its node with the parameters of the command line."""

    name: str
    usage: str
    run: Callable[['GivenParameters', 'Signals'], None]


def live(args: Sequence[str], signals: 'Signals', program: Program) -> int:
    """Bring a node up and down; return the exit code.  ROS is imported in here, where errors are met."""
    from ...core.errors import StickslipError, internal_error
    from .environment import check_environment
    from .standstill import Standstill

    sys.setswitchinterval(SWITCH_INTERVAL)
    signals.standstill = Standstill(program.name)
    gc.disable()     # up to `spin`: what a start makes stays, and looking through it time and again is a tenth of it
    try:
        check_environment()
        _with_ros(args, signals, program)
        return 0
    except StickslipError as error:
        return _refuse(program, str(error), error.exit_code)
    except Exception as error:
        return _refuse(program, internal_error(error), 1)
    finally:
        gc.enable()
        signals.ignore()
        signals.standstill.close()


def spin(node: Any, signals: 'Signals', is_over: Callable[[], bool] = lambda: False,
         look: Callable[[], None] = lambda: None) -> None:
    """Let a node begin once it is ready, hear, and end with a signal or when it is over; `look` is called at times."""
    executor = make_executor()
    executor.add_node(node)
    gc.enable()
    try:
        signals.is_starting = False
        signals.standstill.is_up()
        while not signals.stop and not node.is_ready():
            executor.spin_once(timeout_sec=_POLL)
        if not signals.stop:
            node.begin()
        while not signals.stop and not is_over():
            executor.spin_once(timeout_sec=_POLL)
            look()
    finally:
        node.end()
        signals.standstill.last()
        executor.shutdown()      # lets go of what still arrives; removing the node would do so with the next spin only
        node.destroy_node()


def make_executor() -> Any:
    """Return the executor that takes the least of the interpreter from the step loop (docs/loop.md)."""
    try:
        from rclpy.experimental import EventsExecutor
    except ImportError:
        from rclpy.executors import SingleThreadedExecutor
        return SingleThreadedExecutor()
    return EventsExecutor()


def _with_ros(args: Sequence[str], signals: 'Signals', program: Program) -> None:
    import rclpy
    from rclpy.executors import ExternalShutdownException

    from .given_parameters import GivenParameters

    given = GivenParameters.read(args)    # before ROS, whose parser takes minutes for some files
    try:
        _init_ros(args)
        if _wants_help(args, program):
            sys.stdout.write(program.usage)
        else:
            program.run(given, signals)
    except ExternalShutdownException:
        pass
    finally:
        rclpy.try_shutdown()


def _wants_help(args: Sequence[str], program: Program) -> bool:
    """Return whether help is asked for; raises InputError on words that are none of ROS's."""
    from rclpy.utilities import remove_ros_args

    from ...core.errors import InputError

    for word in takewhile(lambda word: word != '--ros-args', args):
        if ':=' in word:    # ROS takes it for a name to be replaced, and the node starts without it
            raise InputError('argument', word, 'behind --ros-args -p', f'{program.name} --ros-args -p {word}')
    words = remove_ros_args([program.name, *args])[1:]
    if words and words[0] not in ('-h', '--help'):
        raise InputError('argument', words[0], 'one of -h, --help, or behind --ros-args', f'see {program.name} --help')
    return bool(words)


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


def _refuse(program: Program, text: str, code: int) -> int:
    sys.stderr.write(f'{program.name}: ' + ' '.join(text.split()) + '\n')
    return code
