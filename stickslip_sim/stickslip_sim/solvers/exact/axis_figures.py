# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of an axis that runs among many; `runs.batch` reports those of the first two groups by these names."""

import math
from dataclasses import dataclass

from ...axis.fields import names_of


@dataclass(slots=True)
class AxisFigures:
    """Figures of cycles and rounds, NaN where there is none, and what is counted on the way to them.

    These values are where an axis begins.
    """

    # of the run and its last cycle; `batch.BatchFigures` has what they are
    events: float = 0.0
    cycles: float = 0.0
    complete: float = math.nan
    final_mode: float = math.nan
    first_break_away: float = math.nan
    stick_share: float = 0.0
    period_before: float = math.nan      # s, of the cycle before the last
    direction: float = math.nan
    rest_time: float = math.nan
    slip_time: float = math.nan
    stick_time: float = math.nan
    period: float = math.nan
    slip_travel: float = math.nan
    jump: float = math.nan
    peak_speed: float = math.nan
    break_away_force: float = math.nan
    static_coefficient: float = math.nan
    last_break_away: float = math.nan
    settling_time: float = math.nan
    # of its rounds; `batch.Rounds` has what they are
    sticks: float = 0.0
    last_stick: float = math.nan
    longest_pause: float = 0.0
    round_count: float = 0.0
    round_period: float = math.nan
    round_stick: float = math.nan
    round_travel: float = math.nan
    round_peak: float = math.nan
    round_force: float = math.nan
    round_settling: float = math.nan
    least_speed: float = math.nan
    lasts: float = 0.0
    last_velocity: float = math.nan
    # not reported: since when the mode holds
    since_second: float = 0.0
    since_fraction: float = 0.0
    # the slip that goes on or was the last: whether it goes on, whether it ended at standstill, where it began and
    # ended, and its figures so far
    slips: float = 0.0
    is_over: float = 0.0
    begin_second: float = 0.0
    begin_fraction: float = 0.0
    begin_position: float = 0.0
    stop_second: float = 0.0
    stop_fraction: float = 0.0
    stop_position: float = 0.0
    peak: float = 0.0
    force: float = 0.0
    rest: float = 0.0
    static: float = 0.0
    sign: float = 0.0
    has_slowed: float = 0.0         # since its speed was least
    # the round that goes on, if one does: when it began, and its figures so far
    has_round: float = 0.0
    from_second: float = 0.0
    from_fraction: float = 0.0
    travel_so_far: float = 0.0
    peak_so_far: float = 0.0
    force_at_first: float = 0.0


@dataclass(slots=True)
class KeptRound:
    """One of the latest rounds."""

    stick: float    # s
    period: float   # s
    force: float    # N, the drive's at its end
    speed: float    # m/s, at its end


KeptRounds = list[KeptRound]   # the latest ones, in turn

FIGURE_NAMES = names_of(AxisFigures)
ROUND_SIZE = len(names_of(KeptRound))
