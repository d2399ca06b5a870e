# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of each point of a study: the motion that it ends in, and the last round of that motion.

A round of stick-slip goes from one break-away out of stick to the next; a slip that reverses at once is part of it.

Without stick-slip, period, speed and force are NaN; with rounds that repeat in groups, the settling time is.  Of an
undecided point cycles, settled and duration alone are numbers, of a failed one nothing.
"""

from dataclasses import dataclass, fields
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Flags, Numbers
from ..core.types import Mode
from ..solvers.exact.many_axes import LEAST_STICK
from .cycles import SWINGS_ON


class Motion(IntEnum):
    """The motion that a point ends in."""

    AT_REST = 0
    SMOOTH_SLIDING = 1
    STICK_SLIP = 2
    FAILED = 3
    UNDECIDED = 4
    SWINGS_ON = 5


MOTIONS = {Motion.AT_REST: 'at rest', Motion.SMOOTH_SLIDING: 'smooth sliding', Motion.STICK_SLIP: 'stick-slip',
           Motion.FAILED: 'failed', Motion.UNDECIDED: 'undecided', Motion.SWINGS_ON: SWINGS_ON}


@dataclass(frozen=True)
class Runs:
    """The run of each point, one entry each; named as in `batch.BatchFigures` and `batch.Rounds`.

    `settled`: the motion is as it stays.  `undecided`: it may or may not go on to stick and slip.  `late`:
    it slides after sticks that went on for long, as by chance.
    """

    duration: Numbers
    complete: Flags
    events: Numbers
    cycles: Numbers
    final_mode: Numbers
    last_break_away: Numbers
    settled: Flags
    stick_share: Numbers
    sticks: Numbers
    last_stick: Numbers
    longest_pause: Numbers
    round_count: Numbers
    round_period: Numbers
    round_stick: Numbers
    round_travel: Numbers
    round_peak: Numbers
    round_force: Numbers
    round_settling: Numbers
    least_speed: Numbers
    lasts: Flags
    last_velocity: Numbers
    undecided: Flags
    late: Flags

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
    def sticks_on(self) -> Flags:
        """Whether a round came to its end in which the slider stood still, in the second half of the run.

        Neither does one count that only touches rest, nor one that is followed by such.
        """
        late = (self.last_stick >= 0.5 * self.duration) | (self.final_mode == Mode.STICK)
        stood: Flags = (self.round_stick > LEAST_STICK * self.round_period) & late
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
    """Arrays of one entry for each point, named as in `figures.catalogue`; `motion` holds numbers of `Motion`."""

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


_OF_A_ROUND = {'amplitude': 'round_travel', 'period': 'round_period', 'peak_speed': 'round_peak',
               'break_away_force': 'round_force'}


def figures_of_runs(runs: Runs) -> Figures:
    """Return the figures of runs."""
    motion = _motions(runs)
    slips, slides = motion == Motion.STICK_SLIP, np.isin(motion, (Motion.SMOOTH_SLIDING, Motion.SWINGS_ON))
    failed, unknown = motion == Motion.FAILED, (motion == Motion.FAILED) | (motion == Motion.UNDECIDED)
    with np.errstate(divide='ignore', invalid='ignore'):
        share = np.where(slips, runs.round_stick / runs.round_period, np.where(slides, 0.0, 1.0))
    settling = np.where(slips, runs.round_settling, np.where(slides, np.nan_to_num(runs.last_break_away), np.nan))
    of_a_round = {figure: np.where(slips, getattr(runs, name), np.nan) for figure, name in _OF_A_ROUND.items()}
    of_a_round['amplitude'] = np.where(slips, runs.round_travel, np.where(unknown, np.nan, 0.0))
    return Figures(
        motion=motion.astype(float), stick_slip=np.where(unknown, np.nan, slips.astype(float)), **of_a_round,
        stick_share=np.where(unknown, np.nan, share),
        settling_time=np.where(runs.settled & ~unknown, settling, np.nan), cycles=np.where(failed, np.nan, runs.cycles),
        settled=np.where(failed, np.nan, runs.settled & ~unknown), duration=np.where(failed, np.nan, runs.duration))


def _motions(runs: Runs) -> NDArray[np.int64]:
    """Return the motion of each run.

    It may have stuck for a while and slide now: the last motion counts.  A slip that just began is one of a cycle.
    """
    moves = (runs.final_mode != Mode.STICK) | (runs.cycles > 0)
    found = np.where(runs.sticks_on, Motion.STICK_SLIP, np.where(moves, Motion.SMOOTH_SLIDING, Motion.AT_REST))
    sliding = np.where(runs.settled, Motion.SMOOTH_SLIDING, Motion.SWINGS_ON)
    found = np.where(runs.slides_on | runs.lasts, sliding, np.where(runs.rests_on, Motion.AT_REST, found))
    found = np.where(runs.undecided, Motion.UNDECIDED, found)
    return np.where(runs.complete & _is_finite(runs), found, Motion.FAILED)


def _is_finite(runs: Runs) -> Flags:
    """Return whether all is a number that has to be."""
    finite = np.isfinite(runs.stick_share) & np.isfinite(runs.duration)
    of_a_round = np.isfinite([getattr(runs, name) for name in (*_OF_A_ROUND.values(), 'round_stick')]).all(axis=0)
    found: Flags = finite & (of_a_round | (runs.round_count == 0.0))
    return found
