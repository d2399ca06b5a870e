# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A node whose parameters are those of a list, checked as those of a scene are."""

import difflib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from ...core.errors import InputError
from ...realtime.scheduling import Scheduling
from ...scene.load import without_those_of_ros
from ...scene.model import TimeSettings
from ...scene.parameter import Parameter as Entry
from ...scene.schema import NULL
from ..programs import GivenParameters
from .parameters import BoundedNode, changes_of, declare


class ListedNode(BoundedNode):
    """A node with the parameters of a list; `values` are those in force.

    Raises InputError when those given at the start are wrong.
    """

    def __init__(self, name: str, entries: Sequence[Entry], given: GivenParameters) -> None:
        super().__init__(name, given)
        self._entries = {entry.name: entry for entry in entries}
        self.values = values_at_start(self._entries, without_those_of_ros(self.given.values))
        declare(self, entries, self.values)

    def values_changed(self) -> None:
        """Let changed values take effect; for the heir."""

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set all or none; refused with one line that says what, why and what to do."""
        try:
            wanted = changes_of(self, parameter_list, self._entries, self.values)
            ours = {parameter.name: parameter.value for parameter in wanted
                    if parameter.name in self._entries or not self.has_parameter(parameter.name)}
            values = self.values | checked_values(self._entries, ours)
        except InputError as error:
            return SetParametersResult(successful=False, reason=str(error))
        if not wanted:
            return SetParametersResult(successful=True)
        result = super().set_parameters_atomically(wanted)
        if result.successful and ours:
            self.values = values
            self.values_changed()
        return result


def values_at_start(entries: Mapping[str, Entry], given: Mapping[str, object]) -> dict[str, object]:
    """Return the value of every parameter, given or default; raises InputError."""
    defaults = {name: entry.default for name, entry in entries.items()}
    return defaults | checked_values(entries, {name: value for name, value in given.items()
                                               if value != NULL or name not in entries})


def checked_values(entries: Mapping[str, Entry], given: Mapping[str, object]) -> dict[str, object]:
    """Return the values that are given as the types of their parameters; raises InputError."""
    for name, value in given.items():
        if name not in entries:
            close = difflib.get_close_matches(name, entries, 1, cutoff=0.5)
            raise InputError(name, value, 'one of ' + ', '.join(entries),
                             f'did you mean {close[0]}?' if close else 'drop it')
    return {name: entries[name].checked(value) for name, value in given.items()}


# The parameters that say how the kernel should treat the step thread; of the machine, and so no part of a scene.

_ENTRIES = (
    Entry('thread_priority', 'integer', 0, '', 'SCHED_FIFO priority of the thread that makes the steps; 0: none', 0,
          99),
    Entry('lock_memory', 'bool', False, '', 'whether all memory of the process is locked in RAM'),
    Entry('require_real_time', 'bool', False, '', 'whether the node refuses to start when thread_priority, lock_memory'
          ' or cpu_affinity is not granted'),
)
_CORES = 'cpu_affinity'
_ANY_CORE = -1


def scheduling_of(node: Node, given: Mapping[str, object], time: TimeSettings) -> Scheduling:
    """Declare the parameters, of which some are given; return what they want.  Raises InputError."""
    values: dict[str, Any] = {entry.name: entry.checked(given.get(entry.name, entry.default)) for entry in _ENTRIES}
    cores = cores_of(given.get(_CORES, _ANY_CORE))
    declare(node, _ENTRIES, values)
    node.declare_parameter(_CORES, list(cores) if len(cores) > 1 else next(iter(cores), _ANY_CORE), ParameterDescriptor(
        description='core, or cores, of the thread that makes the steps; -1: any', read_only=True,
        dynamic_typing=True), ignore_override=True)
    _check_mode(values, time)
    return Scheduling(values['thread_priority'], values['lock_memory'], cores, values['require_real_time'])


def _check_mode(values: Mapping[str, Any], time: TimeSettings) -> None:
    """Raise InputError on a priority for steps that nothing paces: they would keep a core for themselves."""
    if values['thread_priority'] and not time.is_paced:
        mode = f'time.mode: {time.mode}' + ('' if time.mode == 'lockstep' else ' and time.factor: .inf')
        raise InputError('thread_priority', values['thread_priority'], f'0 with {mode}',
                         'steps that are due at once would never leave the core to others')


def cores_of(value: object) -> tuple[int, ...]:
    """Return the cores of an integer or of a list of them; raises InputError."""
    if type(value) is int and value == _ANY_CORE:
        return ()
    cores: list[Any] = [value] if isinstance(value, str) or not isinstance(value, Iterable) else list(value)
    if not cores or not all(type(core) is int and core >= 0 for core in cores):
        raise InputError(_CORES, value, 'a core or a list of cores, as in 1 or [0, 1]', 'give whole numbers >= 0')
    return tuple(sorted(set(cores)))
