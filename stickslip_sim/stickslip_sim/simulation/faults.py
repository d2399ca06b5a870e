# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Faults: what may go wrong, how it is checked, and when it begins and ends."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from ..core.errors import InputError
from ..core.time_grid import Grid

MAX_FAULTS = 1000      # planned or in force
MAX_TIME = 1e9         # s
_ID_LENGTH = 64        # characters
_LISTED = 10           # ids in a refusal


class Fault(NamedTuple):
    """One fault: `start` in s from its injection (in a scene: from the start of the run), `duration` in s, or inf."""

    id: str
    kind: str
    start: float
    duration: float
    value: float


class _Rule(NamedTuple):
    """What the value of a kind may be."""

    low: float
    high: float
    allowed: str
    low_is_open: bool = False


_NONE = _Rule(0.0, 0.0, '0: this kind has no value')
_SHARE = _Rule(0.0, 1.0, 'a share, > 0 and <= 1', low_is_open=True)
RULES: dict[str, _Rule] = {
    'friction_scale': _Rule(0.0, 100.0, 'a factor, >= 0 and <= 100'),
    'force_pulse': _Rule(-1e9, 1e9, 'within ±1e9 N'),
    'encoder_freeze': _NONE,
    'encoder_step': _Rule(-1e3, 1e3, 'within ±1000 m'),
    'encoder_dropout': _SHARE,
    'command_loss': _SHARE,
    'command_delay': _Rule(0.0, 60.0, '> 0 and <= 60 s', low_is_open=True),
    'drive_freeze': _NONE,
}


def value_of_kind(kind: str) -> str:
    """Return what the value of a kind of fault may be; empty for one that has none, and for what is no kind."""
    rule = RULES.get(kind, _NONE)
    return '' if rule is _NONE else rule.allowed


def check_fault(fault: Fault, period: float) -> None:
    """Raise InputError on a fault without a meaning; `period` is the length of a step, s."""
    if fault.kind not in RULES:
        raise InputError('kind', fault.kind, 'one of ' + ', '.join(RULES), 'choose one of these')
    if len(fault.id) > _ID_LENGTH or not fault.id.isprintable() or not fault.id:
        raise InputError('id', fault.id, f'printable text of 1 to {_ID_LENGTH} characters', 'shorten it')
    if not 0.0 <= fault.start <= MAX_TIME:
        raise InputError('start', fault.start, f'0 to {MAX_TIME:g} s', 'faults cannot begin in the past')
    if not (period <= fault.duration <= MAX_TIME or fault.duration == math.inf):
        raise InputError('duration', fault.duration, f'from a step ({period:g} s) to {MAX_TIME:g} s, or inf',
                         'inf lasts until it is cleared')
    rule = RULES[fault.kind]
    if not rule.low <= fault.value <= rule.high or (rule.low_is_open and fault.value == rule.low):
        raise InputError('value', fault.value, f'with {fault.kind}: {rule.allowed}', 'give a value in this range')


class Effect(NamedTuple):
    """What the faults in force do together: factor, N, m, shares that get through, steps, and what is frozen."""

    friction_scale: float = 1.0
    force_pulse: float = 0.0
    encoder_step: float = 0.0
    encoder_kept: float = 1.0
    encoder_frozen: bool = False
    command_kept: float = 1.0
    command_delay: int = 0
    drive_frozen: bool = False


NO_EFFECT = Effect()


class _Planned(NamedTuple):
    first: int           # step
    end: float           # first step without it; inf for none
    fault: Fault


class Faults:
    """The faults of a run: `active` by id, in the order in which they began, and their `effect`."""

    def __init__(self, grid: Grid, planned: Sequence[Fault]) -> None:
        self.active: dict[str, Fault] = {}
        self.effect = NO_EFFECT
        self._grid = grid
        self._planned: list[_Planned] = []
        self._ends: dict[str, float] = {}
        self._chosen = 0
        self.next_change = math.inf      # the step before which something begins or ends
        for fault in planned:
            self.inject(fault, 1)

    @property
    def ids(self) -> list[str]:
        """The ids in use."""
        return [*self.active, *(planned.fault.id for planned in self._planned)]

    def inject(self, fault: Fault, step: int) -> Fault:
        """Plan a fault whose start counts from the start of a step; return it with its id.  Raises InputError."""
        fault = fault if fault.id else fault._replace(id=self._free_id(fault.kind))
        check_fault(fault, 1.0 / self._grid.rate)
        if fault.id in self.ids:
            raise InputError('id', fault.id, 'not in use', 'choose another, or clear that fault first')
        if len(self.ids) >= MAX_FAULTS:
            raise InputError('faults', len(self.ids) + 1, f'at most {MAX_FAULTS} at a time', 'clear some first')
        first = step + self._grid.steps(fault.start)
        lasts = math.inf if fault.duration == math.inf else self._grid.steps(fault.duration)
        self._planned.append(_Planned(first, first + lasts, fault))
        self._planned.sort(key=lambda planned: planned.first)
        self._changed()
        return fault

    def clear(self, fault_id: str) -> Fault:
        """Forget a fault, planned or in force, at once; raises InputError when there is none by that id."""
        if fault_id not in self.ids:
            raise InputError('id', fault_id, f'the id of a fault: {_listed(self.ids)}',
                             'see the ids that ~/inject_fault answered')
        fault = self.active.pop(fault_id, None)
        for planned in self._planned:
            if planned.fault.id == fault_id:
                fault = planned.fault
        self._planned = [planned for planned in self._planned if planned.fault.id != fault_id]
        self._ends.pop(fault_id, None)
        self._changed()
        assert fault is not None
        return fault

    def enter(self, step: int) -> tuple[list[Fault], list[Fault]]:
        """Let a step begin; return the faults that end and those that begin with it."""
        ended = [self.active.pop(name) for name in [name for name, end in self._ends.items() if end <= step]]
        for fault in ended:
            del self._ends[fault.id]
        begun = [planned for planned in self._planned if planned.first <= step]
        self._planned = self._planned[len(begun):]
        for planned in begun:
            self.active[planned.fault.id] = planned.fault
            self._ends[planned.fault.id] = planned.end
        self._changed()
        return ended, [planned.fault for planned in begun]

    def checkpoint(self) -> dict[str, Any]:
        """Return what is planned and in force, as plain data."""
        return {'active': [[list(fault), self._ends[name]] for name, fault in self.active.items()],
                'planned': [[planned.first, planned.end, list(planned.fault)] for planned in self._planned],
                'chosen': self._chosen}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Go on from a checkpoint; raises InputError on a fault without a meaning."""
        active = [(self._checked(fault), float(end)) for fault, end in saved['active']]
        self.active = {fault.id: fault for fault, _ in active}
        self._ends = {fault.id: end for fault, end in active}
        self._planned = [_Planned(int(first), float(end), self._checked(fault))
                         for first, end, fault in saved['planned']]
        self._chosen = int(saved['chosen'])
        self._changed()

    def _checked(self, saved: Sequence[Any]) -> Fault:
        name, kind, *numbers = saved
        fault = Fault(str(name), str(kind), *map(float, numbers))
        check_fault(fault, 1.0 / self._grid.rate)
        return fault

    def _changed(self) -> None:
        """Look what is in force now, and when that changes."""
        self.effect = self._effect() if self.active else NO_EFFECT
        self.next_change = min([*self._ends.values(), *(planned.first for planned in self._planned[:1])],
                               default=math.inf)

    def _effect(self) -> Effect:
        def values(kind: str) -> list[float]:
            return [fault.value for fault in self.active.values() if fault.kind == kind]

        def kept(kind: str) -> float:
            return math.prod((1.0 - lost for lost in values(kind)), start=1.0)

        step = 0.0
        for value in values('encoder_step'):    # `sum` rounds otherwise from Python 3.12 on
            step += value
        return Effect(math.prod(values('friction_scale')), math.fsum(values('force_pulse')), step,
                      kept('encoder_dropout'), bool(values('encoder_freeze')),
                      kept('command_loss'), sum(map(self._grid.steps, values('command_delay'))),
                      bool(values('drive_freeze')))

    def _free_id(self, kind: str) -> str:
        while True:
            self._chosen += 1
            if f'{kind}_{self._chosen}' not in self.ids:
                return f'{kind}_{self._chosen}'


def _listed(ids: Sequence[str]) -> str:
    more = f' and {len(ids) - _LISTED} more' if len(ids) > _LISTED else ''
    return ', '.join(ids[:_LISTED]) + more or 'none at the moment'
