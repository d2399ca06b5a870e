# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The settings of the rig around the axis and of time in a scene, checked together."""

import math
from collections.abc import Mapping
from typing import Any

from ..core.errors import InputError
from ..core.time_grid import Grid
from ..simulation.drive import DriveLimits
from ..simulation.encoder import EncoderSettings
from ..simulation.faults import Fault, Faults
from ..simulation.rig import RigSettings
from .model import TimeSettings

_FAULT_LISTS = 'ids', 'kinds', 'starts', 'durations', 'values'
_FINEST = 1e-15    # m, of an encoder: the counts of any position are numbers then


def time_settings(values: Mapping[str, Any]) -> TimeSettings:
    """Return how time goes; raises InputError."""
    mode, rate, factor = values['time.mode'], values['time.rate'], values['time.factor']
    if factor == math.inf and mode != 'free_run':
        raise InputError('time.factor', factor, 'finite', 'only time.mode: free_run goes as fast as it can')
    clock_rate = values.get('clock.rate', rate)
    if clock_rate > rate:
        raise InputError('clock.rate', clock_rate, f'at most time.rate ({rate:g} Hz)',
                         'time moves with the steps: raise time.rate, or leave it out for a message with every step')
    return TimeSettings(mode, rate, factor, clock_rate)


def rig_settings(values: Mapping[str, Any]) -> RigSettings:
    """Return the rig; raises InputError."""
    encoder = EncoderSettings(*(values[f'encoder.{name}'] for name in EncoderSettings.__dataclass_fields__))
    if 0.0 < encoder.resolution < _FINEST:
        raise InputError('encoder.resolution', encoder.resolution, f'0, or at least {_FINEST:g} m', '0 does not round')
    grid = Grid(values['time.rate'])
    _check_timeout(values['command.timeout'], grid)
    return RigSettings(
        seed=values['seed'],
        measures=values['joint_interface.enabled'],
        encoder=encoder,
        encoder_delay_steps=_whole_steps('encoder.delay', encoder.delay, grid),
        limits=DriveLimits(values['command.velocity_limit'], values['command.acceleration_limit']),
        on_timeout=values['command.on_timeout'],
        timeout_deceleration=values.get('command.timeout_deceleration', math.inf),
        faults=_faults(values, grid))


def _check_timeout(timeout: float, grid: Grid) -> None:
    if 0.0 < timeout < 1.0 / grid.rate:
        raise InputError('command.timeout', timeout, f'0, or at least a step ({1.0 / grid.rate:g} s)',
                         'commands are taken once a step: make it longer, or raise time.rate')


def _whole_steps(name: str, seconds: float, grid: Grid) -> int:
    count = grid.steps(seconds)
    if grid.instant(count).seconds != seconds:
        raise InputError(name, seconds, f'whole steps of {1.0 / grid.rate:g} s',
                         'choose a multiple, or another time.rate')
    return count


def _faults(values: Mapping[str, Any], grid: Grid) -> tuple[Fault, ...]:
    given = {name: values[f'faults.{name}'] for name in _FAULT_LISTS if f'faults.{name}' in values}
    if not given:
        return ()
    given.setdefault('values', (0.0,) * len(given.get('ids', ())))
    for name in _FAULT_LISTS:
        if name not in given or len(given[name]) != len(given.get('ids', ())):
            raise InputError(f'faults.{name}', list(given.get(name, ())), 'as many as there are faults.ids',
                             'give ids, kinds, starts and durations, one of each for every fault')
    faults = tuple(map(Fault, *(given[name] for name in _FAULT_LISTS)))
    plan = Faults(grid, ())
    for fault in faults:
        try:
            plan.inject(fault, 1)
        except InputError as error:
            raise InputError(f'faults ({fault.id}): {error.name}', error.value, error.allowed, error.fix) from None
    return faults
