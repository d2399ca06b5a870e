# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What `ros2 launch` would start: the launch files run on a small double of launch, which has no wheels.

It knows what these files use and no more, with the rules of launch: a configuration that is set stays, a declared
argument sets it otherwise, and what a file includes shares all of them.  Where launch is installed,
tests/house/test_launch.py holds it to what launch starts and declares.
"""

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from tests.support.repository import ROOT

LAUNCH = ROOT / 'stickslip_sim' / 'launch'
FILES = {file.name.removesuffix('.launch.py'): file for file in sorted(LAUNCH.glob('*.launch.py'))}

Context = dict[str, str]


class Argument(NamedTuple):
    """A declared argument of a launch file."""

    name: str
    default_value: str | None = None
    description: str = ''
    choices: list[str] | None = None

    def declare(self, context: Context) -> None:
        """Give it its value; raises RuntimeError where launch does."""
        if self.name not in context and self.default_value is None:
            raise RuntimeError(f'Required launch argument "{self.name}" was not provided.')
        value = context.setdefault(self.name, self.default_value or '')
        if self.choices and value not in self.choices:
            raise RuntimeError(f'Argument "{self.name}" provided value "{value}" is not valid.')


class Started(NamedTuple):
    """A process that launch would start."""

    package: str
    executable: str
    words: list[str]


class Launched(NamedTuple):
    """What a launch file declares and starts."""

    arguments: list[Argument]
    processes: list[Started]
    ends: list[str]    # what happens when the first of them has ended

    @property
    def ours(self) -> list[Started]:
        return [process for process in self.processes if process.package == 'stickslip_sim']


def launched(name: str, **given: str) -> Launched:
    """Run a launch file of the package with arguments."""
    result = Launched([], [], [])
    with _double(Context(given)) as context:
        _visit(_entities(FILES[name]), context, result)
    return result


def _entities(file: Path) -> list[Any]:
    names: dict[str, Any] = {'__file__': str(file)}
    exec(compile(file.read_text(encoding='utf-8'), str(file), 'exec'), names)
    description: list[Any] = names['generate_launch_description']()
    return description


def _visit(entities: Iterable[Any], context: Context, result: Launched) -> None:
    for entity in entities:
        if isinstance(entity, Argument):
            entity.declare(context)
            result.arguments.append(entity)
        else:
            entity(context, result)


def _text(value: Any, context: Context) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, list):
        return ''.join(_text(part, context) for part in value)
    return str(value.perform(context))


class _LaunchConfiguration(NamedTuple):
    name: str

    def perform(self, context: Context) -> str:
        return context[self.name]


class _PathJoin(NamedTuple):
    parts: list[Any]

    def perform(self, context: Context) -> str:
        return os.path.join(*(_text(part, context) for part in self.parts))


class _Share(NamedTuple):
    package: str

    def perform(self, _: Context) -> str:
        assert self.package == 'stickslip_sim'
        return str(LAUNCH.parent)


class _Command(NamedTuple):
    command: list[Any]

    def perform(self, context: Context) -> str:
        return f'$({_text(self.command, context)})'


class _ParameterValue(NamedTuple):
    value: Any
    value_type: type

    def perform(self, context: Context) -> str:
        return _text(self.value, context)


class _IfCondition(NamedTuple):
    predicate: Any

    def holds(self, context: Context) -> bool:
        return _text(self.predicate, context).lower() in ('true', '1')


class _Include(NamedTuple):
    source: Any
    launch_arguments: Iterable[tuple[str, Any]] = ()
    condition: _IfCondition | None = None

    def __call__(self, context: Context, result: Launched) -> None:
        if self.condition is not None and not self.condition.holds(context):
            return
        for name, value in self.launch_arguments:
            context[name] = _text(value, context)
        _visit(_entities(Path(_text(self.source, context))), context, result)


class _OpaqueFunction(NamedTuple):
    function: Callable[[Context], Iterable[Any] | None]

    def __call__(self, context: Context, result: Launched) -> None:
        _visit(self.function(context) or [], context, result)


class _OnProcessExit(NamedTuple):
    on_exit: list[str]


class _RegisterEventHandler(NamedTuple):
    handler: _OnProcessExit

    def __call__(self, _: Context, result: Launched) -> None:
        result.ends.extend(self.handler.on_exit)


class _Node(NamedTuple):
    package: str
    executable: Any
    name: str = ''
    namespace: Any = None
    arguments: Iterable[Any] = ()
    parameters: Iterable[Any] = ()
    remappings: Iterable[tuple[Any, Any]] = ()
    output: str = 'log'
    condition: _IfCondition | None = None

    def __call__(self, context: Context, result: Launched) -> None:
        if self.condition is not None and not self.condition.holds(context):
            return
        renamed = [('__node', self.name)] if self.name else []
        if self.namespace is not None:
            renamed.append(('__ns', '/' + _text(self.namespace, context).lstrip('/')))
        renamed += self.remappings
        rules = [f'{before}:={_text(after, context)}' for before, after in renamed]
        files = [self._file(entry, context) for entry in self.parameters]
        words = [_text(word, context) for word in self.arguments]
        words += ['--ros-args', *(word for rule in rules for word in ('-r', rule)), *files]
        result.processes.append(Started(self.package, _text(self.executable, context), words))

    @staticmethod
    def _file(entry: Any, context: Context) -> str:
        if isinstance(entry, Mapping):
            return str({name: _text(value, context) for name, value in entry.items()})
        return _text(entry, context)


_DOUBLE: dict[str, dict[str, Any]] = {
    'launch': {'LaunchDescription': list, 'LaunchContext': dict},
    'launch.actions': {'DeclareLaunchArgument': Argument, 'IncludeLaunchDescription': _Include,
                       'OpaqueFunction': _OpaqueFunction, 'RegisterEventHandler': _RegisterEventHandler,
                       'Shutdown': lambda: 'shutdown'},
    'launch.conditions': {'IfCondition': _IfCondition},
    'launch.event_handlers': {'OnProcessExit': _OnProcessExit},
    'launch.launch_description_sources': {'PythonLaunchDescriptionSource': lambda location: location},
    'launch.substitutions': {'Command': _Command, 'LaunchConfiguration': _LaunchConfiguration,
                             'PathJoinSubstitution': _PathJoin},
    'launch_ros': {},
    'launch_ros.actions': {'Node': _Node},
    'launch_ros.parameter_descriptions': {'ParameterValue': _ParameterValue},
    'launch_ros.substitutions': {'FindPackageShare': _Share},
}


@contextmanager
def _double(context: Context) -> Iterator[Context]:
    """Put the double in the place of launch, which may be installed."""
    before = {name: sys.modules.get(name) for name in _DOUBLE}
    for name, members in _DOUBLE.items():
        sys.modules[name] = ModuleType(name)
        vars(sys.modules[name]).update(members)
    try:
        yield context
    finally:
        for name, module in before.items():
            if module is None:
                del sys.modules[name]
            else:
                sys.modules[name] = module
