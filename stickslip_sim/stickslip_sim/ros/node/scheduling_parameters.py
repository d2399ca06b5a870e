# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters that say how the kernel should treat the step thread; of the machine, and so no part of a scene."""

from collections.abc import Iterable, Mapping
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node

from ...config.parameter import Parameter as Entry
from ...core.errors import InputError
from ...realtime.scheduling import Scheduling
from ...scene.model import TimeSettings
from .parameters import declare

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
