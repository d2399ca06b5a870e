# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The process around a node, from its arguments to the exit code."""

import gc
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.errors import InputError
from ..scene.load import Section, named, read_text, sections_of
from ..scene.ros_yaml import read_yaml

if TYPE_CHECKING:
    from .stop_signals import Signals

_POLL = 0.1                # s: how soon a signal is acted on
SWITCH_INTERVAL = 5e-5    # s that another thread may keep the interpreter from a step loop (the default is 5 ms)


class Program(NamedTuple):
    """An executable; `run` runs its node with what the command line gives it.

    It takes `options` before --ros-args, each with a value.
    """

    name: str
    usage: str
    run: Callable[['GivenParameters', 'Signals'], None]
    options: Sequence[str] = ()


def live(args: Sequence[str], signals: 'Signals', program: Program) -> int:
    """Bring a node up and down; return the exit code.  ROS is imported in here, where errors are met."""
    from ..core.errors import StickslipError, internal_error
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
    """Return the executor that takes the least of the interpreter from the step loop (docs/data/loop.json)."""
    try:
        from rclpy.experimental import EventsExecutor
    except ImportError:
        from rclpy.executors import SingleThreadedExecutor
        return SingleThreadedExecutor()
    return EventsExecutor()


def _with_ros(args: Sequence[str], signals: 'Signals', program: Program) -> None:
    import rclpy
    from rclpy.executors import ExternalShutdownException

    given = GivenParameters.read(args)    # before ROS, whose parser takes minutes for some files
    try:
        _init_ros(args)
        options = _options_of(args, program)
        if options is None:
            sys.stdout.write(program.usage)
        else:
            program.run(given._replace(options=options), signals)
    except ExternalShutdownException:
        pass
    finally:
        rclpy.try_shutdown()


def _options_of(args: Sequence[str], program: Program) -> list[tuple[str, str]] | None:
    """Return the options of a program, None when help is asked for; raises InputError on words that are none."""
    from rclpy.utilities import remove_ros_args

    for word in takewhile(lambda word: word != '--ros-args', args):
        if ':=' in word:    # ROS takes it for a name to be replaced, and the node starts without it
            raise InputError('argument', word, 'behind --ros-args -p', f'{program.name} --ros-args -p {word}')
    words = remove_ros_args([program.name, *args])[1:]
    options: list[tuple[str, str]] = []
    while words:
        word = words.pop(0)
        name, equals, value = word.partition('=')
        if word in ('-h', '--help'):
            return None
        if name not in program.options:
            raise InputError('argument', word, f'one of {", ".join(("-h", "--help", *program.options))}, or behind '
                             '--ros-args', f'see {program.name} --help')
        if not equals and not words:
            raise InputError(name, None, 'followed by its value', f'see {program.name} --help')
        options.append((name, value if equals else words.pop(0)))
    return options


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


# The parameters that the command line gives a node, in files and one by one.
#
# Files are read here before ROS reads them, whose parser needs minutes for what is long or deeply nested; and here the
# sections that fit a node are chosen as rclcpp does it, where rclpy knows no wildcard but `/**`.

class ParameterFile(NamedTuple):
    """A file and its sections, for any nodes."""

    path: str
    sections: Sequence[Section]


class NodeParameters(NamedTuple):
    """The parameters of one node by dotted name: those `in_files`, and `single` ones, which hold over them.

    `folders` are those of the files by parameter; `passed_over` are the files without a section that fits the node.
    """

    in_files: Mapping[str, object]
    single: Mapping[str, object]
    folders: Mapping[str, Path]
    source: str
    passed_over: Sequence[str]

    @property
    def values(self) -> dict[str, object]:
        """All of them."""
        return {**self.in_files, **self.single}


class GivenParameters(NamedTuple):
    """All parameters of a command line, for any nodes; each of the single ones is a section.

    `options` are those of the program itself.
    """

    files: Sequence[ParameterFile] = ()
    single: Sequence[Section] = ()
    options: Sequence[tuple[str, str]] = ()

    @classmethod
    def read(cls, args: Sequence[str]) -> 'GivenParameters':
        """Read them; raises InputError on a file that is too long or deep, or no parameter file as ROS reads it."""
        files, single = [], []
        for flag, word in _options(args):
            if flag == '--params-file':
                files.append(_read(word))
            elif ':=' in word:    # ROS itself refuses what is none
                single.append(_assigned(word))
        return cls(files, single)

    def of(self, node: str) -> NodeParameters:
        """Return the parameters of a node by its full name.

        What a more specific section says holds, and of equally specific ones the later.
        """
        fitting = [(section, file.path) for file in self.files for section in file.sections if section.fits(node)]
        fitting.sort(key=lambda found: found[0].specificity)
        in_files = {name: value for section, _ in fitting for name, value in section.values}
        folders = {name: Path(path).parent for section, path in fitting for name, _ in section.values}
        single = {name: value for section in self.single if section.fits(node) for name, value in section.values}
        paths = dict.fromkeys(path for _, path in fitting)
        return NodeParameters(in_files, single, folders, ' + '.join(paths),
                              [file.path for file in self.files if file.path not in paths])


def _options(args: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield the flags of ROS for parameters and what follows each; they stand between --ros-args and --."""
    is_of_ros = False
    for word, following in zip(args, [*args[1:], '']):
        if word in ('--ros-args', '--'):
            is_of_ros = word == '--ros-args'
        elif is_of_ros and word in ('--params-file', '-p', '--param') and following:
            yield word, following


def _read(path: str) -> ParameterFile:
    with named(path):
        return ParameterFile(path, sections_of(read_yaml(read_text(Path(path), 'parameter file'))))


def _assigned(word: str) -> Section:
    """Return `[NODE:]NAME:=VALUE` as a section."""
    left, _, value = word.partition(':=')
    node, _, name = left.rpartition(':')
    with named(left):
        return Section(node or '/**', [(name, read_yaml(value))])
