# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The only clock of steps: which step is due when, on the steady clock.  What a step does takes time as an argument.

Deadlines are absolute: step n is due at start + n / (rate · factor), computed from the integer n, so that nothing
accumulates.  A late step is caught up at once; what is later than the allowed backlog is skipped and counted.
"""

import ctypes
import math
import time
from contextlib import suppress
from dataclasses import dataclass
from typing import Protocol

from ..core.time_grid import NANOSECONDS, Grid, decimal

_MAX_BACKLOG = NANOSECONDS // 2   # ns that a stalled loop catches up
_PR_SET_TIMERSLACK = 29
_SLICE = 0.05                     # s: how soon a waiting loop notices that it must stop


class Clock(Protocol):
    """A clock that never jumps, ns from an arbitrary origin."""

    def now(self) -> int:
        """Return the time, ns."""

    def sleep(self, seconds: float) -> None:
        """Wait."""


class SteadyClock:
    """The machine's steady clock."""

    now = staticmethod(time.monotonic_ns)
    sleep = staticmethod(time.sleep)


def wake_precisely() -> None:
    """Let the kernel wake this thread when it is due; it may be 50 µs late by default (docs/measured.md)."""
    with suppress(OSError, AttributeError):    # of Linux only
        ctypes.CDLL(None).prctl(_PR_SET_TIMERSLACK, 1, 0, 0, 0)


class StepClock(Clock, Protocol):
    """What releases the steps of the step loop, on the steady clock; durations in ns.

    `delay` is by how much steps are due later than they would be without the pauses since step 0, and without the wall
    time given up.
    """

    period: int
    counters: 'PacingCounters'

    @property
    def delay(self) -> int:
        """Return it."""

    def restart(self, step: int, lead: int = 0) -> None:
        """Let a step be due in `lead` ns, and those after it follow."""

    def wait(self, step: int) -> bool:
        """Wait until a step is due, at most a while; return whether it is."""

    def begin(self, step: int) -> tuple[int, int]:
        """Count a step that begins; return the time now and how late it is."""

    def watch_time(self, time: int) -> int:
        """Return the time by which silence is measured: on the steady clock, or simulation `time`."""


@dataclass(slots=True)
class PacingCounters:
    """How the steps kept their time; durations in ns."""

    steps: int = 0
    overruns: int = 0       # began more than a period late
    caught_up: int = 0      # made without waiting
    skips: int = 0          # times that wall time was given up
    skipped: int = 0        # ns of wall time given up

    def clear(self) -> None:
        """Begin to count anew."""
        self.steps = self.overruns = self.caught_up = self.skips = self.skipped = 0


class Pacer:
    """Says when each step is due on the steady clock, and counts what is late.

    `factor` is simulation time per wall time.  Silence is measured on the steady clock, or in simulation time; on the
    steady clock only while steps keep their time: commands may wait to be heard while this loop itself is behind.
    """

    def __init__(self, grid: Grid, factor: float = 1.0, clock: Clock | None = None,
                 watches_steady: bool = True) -> None:
        up, down = (decimal(grid.rate) * decimal(factor)).as_integer_ratio()
        self._numerator, self._denominator = NANOSECONDS * down, up
        self.period = self._numerator // self._denominator
        self.counters = PacingCounters()
        self._watches_steady = watches_steady
        self._backlog = max(_MAX_BACKLOG, 2 * self.period)
        self._clock: Clock = clock or SteadyClock()
        self.now, self.sleep = self._clock.now, self._clock.sleep
        self._begin = self._origin = self._latest = self._watched = 0
        self._waited = False
        self.restart(0)

    @property
    def delay(self) -> int:
        """By how much steps are due later than they were at step 0, ns."""
        return self._origin - self._begin

    def restart(self, step: int, lead: int = 0) -> None:
        """Let a step be due in `lead` ns, and those after it follow."""
        self._latest = self.now() + lead
        self._origin = self._latest - step * self._numerator // self._denominator
        if step == 0:
            self._begin = self._origin

    def due(self, step: int) -> int:
        """Return when a step is due, ns on the steady clock."""
        return self._origin + step * self._numerator // self._denominator

    def wait(self, step: int) -> bool:
        """Wait until a step is due, at most a while; return whether it is."""
        due = self.due(step)
        left = due - self.now()
        if left <= 0:
            return True
        self._waited = True
        self._clock.sleep(min(left / NANOSECONDS, _SLICE))
        return due <= self.now()

    def begin(self, step: int) -> tuple[int, int]:
        """Count a step that begins; return the time now and how late it is, ns."""
        now = self.now()
        lateness = now - self.due(step)
        counters = self.counters
        counters.steps += 1
        counters.caught_up += not self._waited
        counters.overruns += lateness > self.period
        if lateness > self._backlog:
            counters.skips += 1
            counters.skipped += lateness
            self._origin += lateness
        self._waited = False
        self._watched += now - self._latest if lateness <= self.period else 0
        self._latest = now
        return now, lateness

    def watch_time(self, time: int) -> int:
        """Return the time by which silence is measured."""
        return self._watched if self._watches_steady else time


class Unpaced:
    """Lets each step be due at once, for time that goes as fast as it can or as it is asked to."""

    delay = 0

    def __init__(self, grid: Grid) -> None:
        self.period = round(NANOSECONDS / grid.rate)
        self.counters = PacingCounters()
        self.now, self.sleep = SteadyClock.now, SteadyClock.sleep

    def restart(self, step: int, lead: int = 0) -> None:
        """Do nothing: no step waits for another."""

    def wait(self, step: int) -> bool:
        """Return that a step is due."""
        return True

    def begin(self, step: int) -> tuple[int, int]:
        """Count a step that begins, never late."""
        self.counters.steps += 1
        return self.now(), 0

    def watch_time(self, time: int) -> int:
        """Return simulation time."""
        return time


def step_clock(grid: Grid, mode: str, factor: float) -> StepClock:
    """Return what paces a mode of time: realtime, lockstep or free_run."""
    if mode == 'lockstep' or factor == math.inf:
        return Unpaced(grid)
    return Pacer(grid, factor, watches_steady=mode == 'realtime')


# Leaves the core to others now and then, where steps at real-time priority follow each other without a wait.
#
# A loop that never waits would keep the threads of the middleware from its core, and the kernel ends a process that
# goes beyond RLIMIT_RTTIME without one.

STRETCH = 50_000_000    # ns of steps without a wait
_REST = 2e-3            # s


class CoreShare:
    """For the thread of the step loop; times are ns on its `clock`."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self._since = 0

    def waited(self, now: int) -> None:
        """Note that the loop has waited until now."""
        self._since = now

    def worked(self, now: int) -> None:
        """Wait a little when the loop has worked for too long."""
        if now - self._since > STRETCH:
            self._clock.sleep(_REST)
            self._since = self._clock.now()
