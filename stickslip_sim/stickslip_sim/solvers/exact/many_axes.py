# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many axes, one after the other: each runs under constant inputs, and only the figures of its cycles are kept.

The figures are those of `figures.cycles`: `Cycle` and `Summary`, from the same events.

A round goes from one break-away out of stick to the next; a slip that reverses at once does not end it.  A round whose
stick is less than LEAST_STICK of it only touches rest.

A slip lasts for ever once its least speed grows from swing to swing.  While it goes on, under constant inputs, stretch
of the spring and speed are one autonomous motion in a plane: friction is a continuous function of the two (with two
branches, too: coasting fills what is between them), so that no two paths cross.  The border at which the slider begins
to accelerate is passed once a turn, at a speed below the drive's; a path that comes back there at a higher speed than
it had before is shut in by its own last turn, which stays clear of standstill.  After a break-away the turn begins at
the speed of that, with a force that accelerates already: the same holds.
"""

import math
from typing import Any

from ...axis.codes import ACCELERATE, ACCELERATING, ARREST, BREAKAWAY, DECELERATE, REVERSE, STICK
from ...axis.fields import numbers_in
from ...axis.layout import Parameters
from ...axis.rows import EventRow, Events, SampleRow, Sinusoids
from ...axis.state_record import State
from ...core.hot_path import compiled, inlined
from .. import DONE, FULL
from .axis_figures import FIGURE_NAMES, ROUND_SIZE, AxisFigures, KeptRound, KeptRounds
from .engine import advance, sample, set_inputs, start
from .soundness import is_sound

SETTLED = 1e-6       # relative change of the period from one cycle to the next
LEAST_STICK = 1e-6   # of a round: less is a slip that only touches rest, as in motion without any damping
_SAME = 1e-12        # of the least speed of a swing: one that loses less is the same again


def run_axes(parameters: Any, inputs: Any, starts: Any, duration: float, first: int, last: int, p: Any, s: State,
             events: Events, sinusoids: Sinusoids, out: Any) -> None:
    """Run the axes `first` to `last` of the rows of `parameters`, `inputs` and `starts`.

    A row of `inputs` is v and F_e, one of `starts` an `InitialState`.  Rows of `out` have the numbers of an
    `AxisFigures`, and behind them those of as many `KeptRound` as there is room for; they are brought up to date.
    Pauses between sticks count in the second half alone.  `s` is a state that keeps the account of energy, `p` room for
    the parameters of an axis.
    """
    size = len(FIGURE_NAMES)
    for i in range(first, last):
        a = AxisFigures(*map(float, out[i, :size]))
        latest = [KeptRound(*map(float, kept)) for kept in out[i, size:].reshape(-1, ROUND_SIZE)]
        position, velocity, rest, stretch, deflection = map(float, starts[i])
        v, f = map(float, inputs[i])
        run_axis(Parameters(parameters[i].tolist()), s, position, velocity, rest, stretch, deflection, v, f, duration,
                 sinusoids, events, a, latest, len(latest))
        out[i] = list(numbers_in([a, latest]))


@compiled
def run_axis(p: Parameters, s: State, position: float, velocity: float, rest: float, stretch: float, deflection: float,
             v: float, f: float, duration: float, sinusoids: Sinusoids, events: Events, a: AxisFigures,
             latest: KeptRounds, kept: int) -> None:
    """Run one of the axes, which begins as an `InitialState`, under constant inputs."""
    second = float(math.floor(duration))
    fraction = duration - second
    rows = start(p, s, position, velocity, rest, stretch, deflection, v, 0.0, f, 0.0, sinusoids, events, 0)
    a.final_mode = STICK if rows > 0 else s.mode
    ended = FULL
    while ended == FULL:
        rows, ended = advance(p, s, second, fraction, events, rows)
        for k in range(rows):
            book(a, latest, kept, events.rows[k], 0.5 * duration)
        rows = 0
    if a.final_mode == STICK:
        a.stick_share += (second - a.since_second) + (fraction - a.since_fraction)
    a.stick_share /= duration
    a.complete = 1.0 if ended == DONE and is_sound(p, s, second, fraction) else 0.0


def step_axes(parameters: Any, states: Any, tables: Any, from_second: float, from_fraction: float, second: float,
              fraction: float, velocities: Any, forces: Any, commanded: bool, sinusoids: Sinusoids, alive: Any,
              counts: Any, told: Any, history: Any, step: int) -> int:
    """Bring axes, each with parameters, a state and a table of its own, through one step; return how many events came.

    They are brought to (`second`, `fraction`); where `commanded`, velocities (m/s) and forces (N) hold from the time
    before it on.  `told` gets position, velocity, drive position, drive velocity and drive force, a row each, `history`
    at the `step` the samples unless it is None, `counts` the events of each.  Those that are not `alive` are left out;
    one whose solver gives up, whose table is full or whose state leaves the range of numbers no longer is.
    """
    told_by = SampleRow()
    for i in range(len(alive)):
        counts[i] = 0
        if not alive[i]:
            continue
        counts[i], alive[i] = step_axis(
            parameters[i], states[i], from_second, from_fraction, second, fraction, float(velocities[i]),
            float(forces[i]), commanded, sinusoids, tables[i], told_by)
        told[:, i] = (told_by.position, told_by.velocity, told_by.drive, told_by.drive_velocity,
                      told_by.drive_force)
        if history is not None:
            history[i, step] = told_by.tolist()
    return int(counts.sum())


@inlined
def step_axis(p: Parameters, s: State, from_second: float, from_fraction: float, second: float, fraction: float,
              velocity: float, force: float, commanded: bool, sinusoids: Sinusoids, events: Events, out: SampleRow
              ) -> tuple[int, bool]:
    """Bring one of the axes through a step; return the rows of events, and whether it goes on."""
    row = 0
    if commanded:
        row = set_inputs(p, s, from_second, from_fraction, velocity, 0.0, force, 0.0, sinusoids, events, 0)
    row, ended = advance(p, s, second, fraction, events, row)
    sample(p, s, second, fraction, out)
    size = (out.position + out.velocity + out.acceleration + out.drive + out.drive_velocity + out.drive_force
            + out.external + out.friction)
    return row, ended == DONE and size - size == 0.0


@compiled
def book(a: AxisFigures, latest: KeptRounds, kept: int, e: EventRow, half: float) -> None:
    """Take the next event of a run, whose second half begins at `half` s; `kept` rounds are kept."""
    kind, mode = e.kind, e.mode
    a.events += 1.0
    a.last_velocity = e.velocity
    begins = kind == REVERSE or (kind == BREAKAWAY and mode != STICK)
    if mode != a.final_mode:
        if a.final_mode == STICK:
            a.stick_share += (e.second - a.since_second) + (e.fraction - a.since_fraction)
        a.final_mode, a.since_second, a.since_fraction = mode, e.second, e.fraction
    if a.slips != 0.0:
        a.peak = max(a.peak, abs(e.velocity))
        if begins or mode == STICK:
            a.slips = 0.0
            a.is_over = 1.0 if kind in (ARREST, REVERSE) else 0.0
            a.stop_second, a.stop_fraction = e.second, e.fraction
            a.stop_position = e.position
    if begins:
        if a.is_over != 0.0:
            _end_cycle(a, e)
            if a.has_round != 0.0:
                a.travel_so_far = max(a.travel_so_far, a.slip_travel)
                a.peak_so_far = max(a.peak_so_far, a.peak_speed)
                if kind == BREAKAWAY:
                    _end_round(a, latest, kept, e, half)
        _begin_slip(a, e)
        if kind == BREAKAWAY:
            _begin_round(a, e)
    elif kind == DECELERATE:
        a.has_slowed = 1.0
    elif kind == ACCELERATE and mode == ACCELERATING:
        speed = abs(e.velocity)
        if a.has_slowed != 0.0 and speed >= a.least_speed * (1.0 - _SAME):
            a.lasts = 1.0
        a.least_speed, a.has_slowed = speed, 0.0
    elif mode == STICK:
        a.lasts = 0.0


@compiled
def _end_cycle(a: AxisFigures, e: EventRow) -> None:
    a.cycles += 1.0
    a.period_before = a.period
    a.period = (e.second - a.begin_second) + (e.fraction - a.begin_fraction)
    if not abs(a.period - a.period_before) < SETTLED * a.period:   # also after the first
        a.settling_time = a.begin_second + a.begin_fraction
    a.slip_time = (a.stop_second - a.begin_second) + (a.stop_fraction - a.begin_fraction)
    a.stick_time = (e.second - a.stop_second) + (e.fraction - a.stop_fraction)
    a.direction = a.sign
    a.slip_travel = a.sign * (a.stop_position - a.begin_position)
    a.jump = a.sign * (e.position - a.begin_position)
    a.peak_speed = a.peak
    a.rest_time, a.break_away_force, a.static_coefficient = a.rest, a.force, a.static


@compiled
def _begin_slip(a: AxisFigures, e: EventRow) -> None:
    if math.isnan(a.first_break_away):
        a.first_break_away = e.second + e.fraction
    a.last_break_away = e.second + e.fraction
    a.slips, a.is_over = 1.0, 0.0
    a.begin_second, a.begin_fraction, a.begin_position = e.second, e.fraction, e.position
    a.peak = abs(e.velocity)
    a.force, a.rest, a.static = abs(e.friction), e.rest, e.static
    a.sign = e.direction
    a.least_speed, a.has_slowed, a.lasts = a.peak, 0.0, 0.0


@compiled
def _begin_round(a: AxisFigures, e: EventRow) -> None:
    a.has_round = 1.0
    a.from_second, a.from_fraction = e.second, e.fraction
    a.travel_so_far = a.peak_so_far = 0.0
    a.force_at_first = a.force


@compiled
def _end_round(a: AxisFigures, latest: KeptRounds, kept: int, e: EventRow, half: float) -> None:
    time = e.second + e.fraction
    before = a.round_period
    a.round_period = (e.second - a.from_second) + (e.fraction - a.from_fraction)
    if not abs(a.round_period - before) < SETTLED * a.round_period:   # also after the first
        a.round_settling = a.from_second + a.from_fraction
    a.round_stick, a.round_travel = a.stick_time, a.travel_so_far
    a.round_peak, a.round_force = a.peak_so_far, a.force_at_first
    if a.round_stick > LEAST_STICK * a.round_period:
        if time >= half and a.sticks > 0.0:
            a.longest_pause = max(a.longest_pause, time - a.last_stick)
        a.sticks += 1.0
        a.last_stick = time
    if kept > 0:
        k = int(a.round_count % kept)
        latest[k].stick, latest[k].period = a.round_stick, a.round_period
        latest[k].force, latest[k].speed = e.drive_force, e.velocity
    a.round_count += 1.0
