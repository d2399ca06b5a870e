# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One line on whether a run can be trusted in real time, and what befell its commands."""

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from ..scene.model import Scene, TimingSettings
from ..simulation import DRIVE_FAILED
from .pacing import PacingCounters
from .step_loop import StepLoop

_NS = 1e-9
_LEVELS = (50.0, 99.0, 99.9, 100.0)


class Quantiles(NamedTuple):
    """Median, 99 %, 99.9 % and maximum, s; NaN of nothing."""

    p50: float = math.nan
    p99: float = math.nan
    p999: float = math.nan
    max: float = math.nan


class TimingWindow(NamedTuple):
    """One window: how many steps, and the quantiles of what they took."""

    steps: int
    cost: Quantiles        # begin to end of a step, publishing included
    lateness: Quantiles    # due to begin
    age: Quantiles         # of the newest command in force
    latency: Quantiles     # arrival of a command to the first published state that it moved


class Worst(NamedTuple):
    """The worst case of a run, s, and the simulation time at which it happened, s; NaN of nothing."""

    value: float = math.nan
    time: float = math.nan


class TimingStatistics:
    """Takes an entry a step; another thread looks at it."""

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Begin anew."""
        self._rows: deque[tuple[int, int, int | None, int | None]] = deque()
        self._worst: dict[str, tuple[int, int]] = {}

    def add(self, time: int, cost: int, lateness: int, age: int | None, latency: int | None) -> None:
        """Add a step that ends at a simulation time, all in ns; None without a command in force, or a new one."""
        self._rows.append((cost, lateness, age, latency))
        for name, value in (('cost', cost), ('lateness', lateness), ('latency', latency)):
            if value is not None and (name not in self._worst or value > self._worst[name][0]):
                self._worst[name] = value, time

    def take(self) -> TimingWindow:
        """Begin a new window; return the one until now."""
        rows = [self._rows.popleft() for _ in range(len(self._rows))]    # none is lost to a step that ends meanwhile
        columns = ([row[i] for row in rows] for i in range(4))
        return TimingWindow(len(rows), *map(quantiles, columns))

    def worst(self, name: str) -> Worst:
        """Return the worst cost, lateness or latency of the run."""
        if name not in self._worst:
            return Worst()
        value, time = self._worst[name]
        return Worst(value * _NS, time * _NS)


def quantiles(nanoseconds: list[int | None]) -> Quantiles:
    """Return the quantiles of the durations that there are."""
    there = [value for value in nanoseconds if value is not None]
    if not there:
        return Quantiles()
    return Quantiles(*(np.percentile(there, _LEVELS) * _NS).tolist())


class TimingVerdict(NamedTuple):
    """`valid` is None when there was no real-time clock to keep."""

    valid: bool | None
    text: str


def verdict(scene: Scene, loop: StepLoop) -> TimingVerdict:
    """Return the verdict on the run so far, against the limits in the section `timing` of the scene."""
    commands = _commands(loop) + _scheduling(loop)
    if scene.time.mode != 'realtime':
        return TimingVerdict(None, f'not in real time (time.mode {scene.time.mode}); {commands}')
    reasons = _reasons(scene.timing, loop.timing_statistics, loop.pacing_counters)
    lateness = loop.timing_statistics.worst('lateness')
    worst = f'worst {lateness.value * 1e3:.2f} ms at t = {lateness.time:.4g} s'
    why = f' ({"; ".join(reasons)})' if reasons else ''
    return TimingVerdict(not reasons, f'real-time valid: {"no" if reasons else "yes"}, {worst}{why}; {commands}')


def _reasons(limits: TimingSettings, timing_statistics: TimingStatistics, counters: PacingCounters) -> list[str]:
    """Return what is beyond the limits."""
    reasons = []
    if counters.skipped:
        reasons.append(f'{counters.skipped * 1e-9:.3f} s of wall time given up')
    for name, limit in (('lateness', limits.max_lateness), ('latency', limits.max_latency)):
        worst = timing_statistics.worst(name)
        if worst.value > limit:
            reasons.append(f'{name} {worst.value * 1e3:.2f} ms at t = {worst.time:.4g} s is over {limit * 1e3:g} ms')
    share = counters.overruns / max(counters.steps, 1)
    if share > limits.max_overruns:
        reasons.append(f'{share:.2%} of the steps more than a period late, over {limits.max_overruns:.2%}')
    return reasons


def _scheduling(loop: StepLoop) -> str:
    """Return what the kernel grants the step thread, and whether anything is missing; nothing of what is not wanted."""
    thread = loop.step_thread
    if not (thread.granted or thread.missing):
        return ''
    granted = thread.granted or 'as any thread'
    return f'; scheduling: {granted}{" (not all that is wanted)" if thread.missing else ""}'


def _commands(loop: StepLoop) -> str:
    totals = loop.command_totals
    return (f'commands: {totals.received} received, {totals.refused} refused, {totals.lost} lost, {totals.limited}'
            f' limited, {totals.timed_out} time-out{"" if totals.timed_out == 1 else "s"}')


# Commands that were not taken since the report before: of which kind, how many, and why.

class Refusal(NamedTuple):
    """Commands of one kind that were refused at one place, and why the latest of them was."""

    name: str
    reason: str
    number: int


class Refusals:
    """Looks at where commands arrive, and at the drive, which takes none after a time-out with on_timeout: fault."""

    def __init__(self, loop: StepLoop) -> None:
        self._loop = loop
        self.forget()

    def forget(self) -> None:
        """Begin anew, as the counters do."""
        self._known = [0] * len(self._so_far())

    def look(self) -> list[Refusal]:
        """Return what was refused since the look before."""
        so_far = self._so_far()
        new = [refusal._replace(number=refusal.number - known) for refusal, known in zip(so_far, self._known)]
        self._known = [refusal.number for refusal in so_far]
        return [refusal for refusal in new if refusal.number > 0]

    def _so_far(self) -> list[Refusal]:
        return [*(Refusal(slot.name, slot.last_refusal, slot.refused) for slot in self._loop.slots),
                Refusal('velocity', DRIVE_FAILED, self._loop.rig.counts.refused)]
