# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of as many axes as asked for, each long enough that its motion is the one that stays.

An axis runs for at least eight times a natural period and the time in which its drive loads the spring to the static
limit, rounded up to a power of two.  It runs twice as long, from the start, until two runs end in the same cycle (stick
time and period within 1e-6 of each other and of the cycle before), or until a slip has gone on for more than half of
the run and either no event comes any more or steady sliding is stable.  With the events of `patience` cycles, or 1024
times as long as the first run, it is left as it is: not settled.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ..axis import Axis, InitialState
from ..batch import BatchFigures, run_batch
from ..solvers.exact.cycles import SETTLED
from ..words import Mode
from .figures import RUN_FIELDS, Flags, Numbers, Runs, no_runs
from .steady import sliding_slope

PATIENCE = 400     # cycles
_LOADINGS = 8.0     # of the spring, and natural periods, that a run has at least
_EVENTS = 8         # of a cycle, or of a swing without a stick, as a rule
_DOUBLINGS = 10
_FADING = 0.95     # of the share of stick, from a run to one twice as long


def run_settled(axis: Axis, initial: InitialState, inputs: Mapping[str, Numbers], duration: float | None = None,
                patience: int = PATIENCE) -> Runs:
    """Run an axis under `inputs` as of `batch.run_batch`, of one length, for `duration` s or until it settles."""
    count = len(inputs['drive_velocity'])
    if duration is not None:
        runs = _runs(axis, initial, inputs, duration)
        return replace(runs, settled=np.where(runs.slides_on, sliding_slope(axis, inputs) >= 0.0, runs.settled))
    runs = no_runs(count)
    exponents = _first_exponents(axis, inputs)
    last = exponents + _DOUBLINGS
    pending = np.arange(count)
    while len(pending):
        before = _taken(runs, pending)
        for exponent in np.unique(exponents[pending]):
            some = pending[exponents[pending] == exponent]
            runs.put(some, _runs(axis, initial, {name: values[some] for name, values in inputs.items()},
                                 2.0 ** float(exponent)))
        now = _taken(runs, pending)
        settled = _is_settled(before, now, axis, {name: values[pending] for name, values in inputs.items()})
        runs.settled[pending] = settled
        runs.fades[pending] = now.stick_share < _FADING * before.stick_share
        goes_on = ~settled & now.complete & (now.events < _EVENTS * patience) & (exponents[pending] < last[pending])
        pending = pending[goes_on]
        exponents[pending] += 1
    return runs


def _is_settled(before: Runs, now: Runs, axis: Axis, inputs: Mapping[str, Numbers]) -> Flags:
    """Return which runs show the motion that stays, beside those half as long."""
    same = np.ones(len(now.cycles), dtype=bool)
    for name in ('stick_time', 'period'):
        one, other = getattr(before, name), getattr(now, name)
        same &= np.abs(one - other) <= SETTLED * np.abs(other)
    goes_on = (now.cycles > before.cycles) & now.settled & same & ~now.slides_on
    slides = now.slides_on & ((sliding_slope(axis, inputs) >= 0.0) | (now.events == before.events))
    pulls_no_more = inputs['drive_velocity'] * _number(axis, inputs, 'drive_stiffness') == 0.0
    settled: Flags = goes_on | slides | (pulls_no_more & (now.final_mode == Mode.STICK))
    return settled


def _first_exponents(axis: Axis, inputs: Mapping[str, Numbers]) -> Any:
    """Return of which power of two the shortest run is, for each axis."""
    stiffness = _number(axis, inputs, 'drive_stiffness')
    force = _number(axis, inputs, 'normal_force') * np.maximum(
        _number(axis, inputs, 'static_limit'), _number(axis, inputs, 'static_initial'))
    with np.errstate(divide='ignore', invalid='ignore', over='ignore'):
        swing = 2.0 * np.pi * np.sqrt(_number(axis, inputs, 'mass') / stiffness)
        load = (force + np.abs(inputs['external_force'])) / (stiffness * np.abs(inputs['drive_velocity']))
    scale = np.where(np.isfinite(swing), swing, 1.0) + np.where(np.isfinite(load), load, 0.0)
    return np.ceil(np.log2(_LOADINGS * np.clip(scale, _SHORTEST, _LONGEST))).astype(int)


_SHORTEST, _LONGEST = 1e-9, 1e15   # s


def _number(axis: Axis, inputs: Mapping[str, Numbers], name: str) -> Numbers:
    """Return what each axis has for a number that may be among the inputs."""
    if name in inputs:
        return inputs[name]
    static = axis.friction.static
    return np.array(getattr(static, name.removeprefix('static_')) if name.startswith('static_')
                    else getattr(axis, name))


def _runs(axis: Axis, initial: InitialState, inputs: Mapping[str, Numbers], duration: float) -> Runs:
    found: BatchFigures = run_batch(axis, duration, initial=initial, threads=1, **inputs)
    return Runs(np.full(len(found.cycles), duration),
                **{name: getattr(found, name) for name in RUN_FIELDS if hasattr(found, name)},
                fades=np.zeros(len(found.cycles), dtype=bool))


def _taken(runs: Runs, places: Any) -> Runs:
    return replace(runs, **{name: getattr(runs, name)[places] for name in RUN_FIELDS})
