# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What becomes of each point of a study, in numbers: the motion it ends in and the last cycle of that.

| figure | unit | meaning |
|---|---|---|
| motion | | what the point ends in: one of `MOTIONS` |
| stick_slip | | 1 or 0 |
| amplitude | m | travel of one slip, from break-away to standstill; 0 without stick-slip |
| period | s | from break-away to break-away |
| stick_share | | of the last period; 0 for smooth sliding, 1 at rest |
| peak_speed | m/s | of a slip |
| break_away_force | N | friction at the break-away |
| settling_time | s | time to the limit cycle: the break-away from which on each period is the one before, to 1e-6; of \
smooth sliding the last break-away |
| cycles | | complete ones |
| settled | | 1: the motion is as it stays, 0: it still changed when its time was over |
| duration | s | simulated |

Without stick-slip, period, speed and force are NaN.
"""

from dataclasses import dataclass, fields
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..words import Mode

Numbers = NDArray[np.float64]
Flags = NDArray[np.bool_]

LEAST_STICK = 1e-6   # of the period: less is a slip that only touches rest, as in motion without any damping


class Motion(IntEnum):
    """What a point ends in."""

    AT_REST = 0
    SMOOTH_SLIDING = 1
    STICK_SLIP = 2
    UNSOLVED = 3


MOTIONS = {Motion.AT_REST: 'at rest', Motion.SMOOTH_SLIDING: 'smooth sliding', Motion.STICK_SLIP: 'stick-slip',
           Motion.UNSOLVED: 'unsolved'}


@dataclass(frozen=True)
class Runs:
    """What is known of the run of each point, one entry each; named as in `batch.BatchFigures`.

    `fades`: sticks take a smaller and smaller share of runs twice as long.
    """

    duration: Numbers
    complete: Flags
    events: Numbers
    cycles: Numbers
    final_mode: Numbers
    last_break_away: Numbers
    settling_time: Numbers
    settled: Flags
    stick_share: Numbers
    stick_time: Numbers
    period: Numbers
    slip_travel: Numbers
    peak_speed: Numbers
    break_away_force: Numbers
    fades: Flags

    @property
    def slides_on(self) -> Flags:
        """Whether the last slip goes on and took more than half of the run."""
        slides: Flags = (self.final_mode != Mode.STICK) & self._is_calm
        return slides

    @property
    def rests_on(self) -> Flags:
        """Whether the slider stands still at the end, and no slip began in the second half of the run."""
        rests: Flags = (self.final_mode == Mode.STICK) & self._is_calm
        return rests

    @property
    def _is_calm(self) -> Flags:
        return self.duration - np.nan_to_num(self.last_break_away) >= 0.5 * self.duration

    @property
    def sticks(self) -> Flags:
        """Whether a cycle came to its end in which the slider stood still."""
        stood: Flags = (self.cycles > 0) & (self.stick_time > LEAST_STICK * self.period)
        return stood

    def put(self, at: Any, others: 'Runs') -> None:
        """Take other runs for the points `at`."""
        for name in RUN_FIELDS:
            getattr(self, name)[at] = getattr(others, name)


RUN_FIELDS = tuple(field.name for field in fields(Runs))


def no_runs(count: int) -> Runs:
    """Return a place for so many runs."""
    return Runs(**{field.name: np.zeros(count, bool if field.type == Flags else float) for field in fields(Runs)})


@dataclass(frozen=True)
class Figures:
    """The figures of the module's table, arrays of one entry for each point; `motion` holds numbers of `Motion`."""

    motion: Numbers
    stick_slip: Numbers
    amplitude: Numbers
    period: Numbers
    stick_share: Numbers
    peak_speed: Numbers
    break_away_force: Numbers
    settling_time: Numbers
    cycles: Numbers
    settled: Numbers
    duration: Numbers


FIGURES = tuple(field.name for field in fields(Figures))


def figures_of(runs: Runs) -> Figures:
    """Return the figures of runs."""
    motion = _motions(runs)
    slips = motion == Motion.STICK_SLIP
    slides = motion == Motion.SMOOTH_SLIDING
    share = np.where(slips, runs.stick_time / runs.period, np.where(slides, 0.0, 1.0))
    settling = np.where(slips, runs.settling_time, np.where(slides, np.nan_to_num(runs.last_break_away), np.nan))
    unsolved = motion == Motion.UNSOLVED

    def of_a_cycle(values: Numbers, without: float = np.nan) -> Numbers:
        return np.where(unsolved, np.nan, np.where(slips, values, without))

    return Figures(
        motion=motion.astype(float), stick_slip=slips.astype(float), amplitude=of_a_cycle(runs.slip_travel, 0.0),
        period=of_a_cycle(runs.period), stick_share=np.where(unsolved, np.nan, share),
        peak_speed=of_a_cycle(runs.peak_speed), break_away_force=of_a_cycle(runs.break_away_force),
        settling_time=np.where(runs.settled & ~unsolved, settling, np.nan), cycles=runs.cycles,
        settled=(runs.settled & ~unsolved).astype(float), duration=runs.duration)


def _motions(runs: Runs) -> NDArray[np.int64]:
    """Return the motion of each run.

    It may have stuck for a while and slide now: what it ends in counts.  A slip that just began is one of a cycle.
    """
    moves = (runs.final_mode != Mode.STICK) | (runs.cycles > 0)
    found = np.where(runs.sticks, Motion.STICK_SLIP, np.where(moves, Motion.SMOOTH_SLIDING, Motion.AT_REST))
    found = np.where(runs.slides_on, Motion.SMOOTH_SLIDING, np.where(runs.rests_on, Motion.AT_REST, found))
    return np.where(runs.complete, found, Motion.UNSOLVED)
