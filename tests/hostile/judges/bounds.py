# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Energy, and speeds: what no axis can do."""

import math

from stickslip_sim.axis import Axis
from stickslip_sim.core.input_profile import InputProfile
from stickslip_sim.core.types import Event, Sample
from stickslip_sim.friction import KineticTable

from ..case import Find, Run

_UNBALANCED = 1e-9   # of the throughput
_ROUNDING = 1e-14    # of the forces that add up, along the way: a drive damper may be huge, and its force nothing


def judge(run: Run) -> None:
    """Raise Find where the account of energy does not close, or a number is none, or a speed is beyond the bound."""
    for event in run.events:
        if not all(map(math.isfinite, event[5:11])):
            raise Find(f'a number is not finite: {tuple(event)}')
    bound = speed_bound(run)
    samples = [sample for _, sample in run.stretches]
    for time, speed in [(e.time, e.velocity) for e in run.events] + [(s.time, s.velocity) for s in samples]:
        if abs(speed) > bound:
            raise Find(f'a speed of {speed!r} m/s at {time!r} s; no more than {bound:.6g} is possible')
    residual = abs(run.energy.residual)
    if not residual <= _UNBALANCED * _energy(run) + _ROUNDING * _forces(run) * _way(run):
        raise Find(f'the account of energy does not close: a residual of {residual:.3g} J of {_energy(run):.3g} J')


def _energy(run: Run) -> float:
    """Return the throughput, or what a spring at the limit stores: a drive that comes back leaves no work."""
    axis, energy = run.parts.heaviest, run.energy
    limit = axis.normal_force * max(side.static.initial for side in axis.friction.sides)
    return max(energy.throughput, energy.stored, energy.stored_at_start,
               limit * limit / axis.drive_stiffness if axis.drive_stiffness > 0.0 else 0.0)


def _forces(run: Run) -> float:
    axis, end = run.parts.heaviest, run.parts.duration
    fastest = _most(run.parts.drive, end) + max(abs(state.velocity) for state in _states(run))
    stretch = max((abs(e.drive_force) for e in run.events), default=0.0)
    steepest = axis.normal_force * max(_steepest(side.kinetic) for side in axis.friction.sides)
    return (2.0 * (axis.drive_damping + steepest) * fastest + stretch + _most(run.parts.force, end)
            + axis.normal_force * max(_coefficients(axis, run)))


def _steepest(table: KineticTable) -> float:
    slopes = [abs((b - a) / (w - v)) for a, b, v, w in zip(table.coefficients, table.coefficients[1:], table.velocities,
                                                          table.velocities[1:])]
    return max([abs(table.end_slope), *slopes])


def _way(run: Run) -> float:
    return 2.0 * _most(run.parts.drive, run.parts.duration) * run.parts.duration + max(
        abs(state.position - run.start.position) for state in _states(run))


def _states(run: Run) -> list[Event | Sample]:
    return [run.start, *run.events, *(sample for _, sample in run.stretches)]


def speed_bound(run: Run) -> float:
    """Return a speed (m/s) that no slider can pass.

    Seen from the drive, E = m (ẋ − v)²/2 + c (s − x)²/2 changes by the power of F_e and friction, the damper only
    takes: sqrt(2 E/m) grows by (|F_e| + N mu)/m per second at the most, and by |dv|.  A rest begins anew.
    """
    axis, drive, force = run.parts.heaviest, run.parts.drive, run.parts.force
    end = run.parts.duration
    fastest, changes = _most(drive, end), _changes(drive, end)
    # a damper on the slideway is one on the drive and a force against its velocity
    pull = _most(force, end) + axis.normal_force * max(_coefficients(axis, run)) + axis.slideway_damping * fastest
    start = abs(run.parts.initial.velocity)
    # a slip begins with a stretch that a rest can hold; one rest is as good as any other
    stretch = (axis.normal_force * max(_coefficients(axis, run)) + _most(force, end)
               + axis.drive_damping * (fastest + start))
    stored = stretch / math.sqrt(axis.drive_stiffness * axis.mass) if axis.drive_stiffness > 0.0 else 0.0
    return 1.001 * (start + 2.0 * fastest + changes + stored + pull / axis.mass * end) + 1e-300


def _coefficients(axis: Axis, run: Run) -> list[float]:
    return [*(mu for side in axis.friction.sides for mu in (*side.kinetic.coefficients, side.static.initial)),
            *(event.static_coefficient for event in run.events)]


def _most(profile: InputProfile, end: float) -> float:
    values = [abs(v) + abs(r) * max(min(end, stop) - t, 0.0) for t, stop, v, r in zip(
        profile.starts, (*profile.starts[1:], profile.period), profile.values, profile.rates)]
    return max(values) + sum(abs(w.amplitude) for w in profile.sinusoids)


def _changes(profile: InputProfile, end: float) -> float:
    """Return a bound on how much the profile changes up to the end."""
    stops = (*profile.starts[1:], min(profile.period, end))
    rise = sum(abs(r) * max(min(end, stop) - t, 0.0) for t, stop, r in zip(profile.starts, stops, profile.rates))
    finals = [v + r * (stop - t) for t, stop, v, r in zip(profile.starts, stops, profile.values, profile.rates)]
    jumps = sum(abs(b - a) for a, b in zip(finals, profile.values[1:])) + abs(profile.values[0] - finals[-1])
    turns = max(1.0, math.ceil(end / profile.period)) if profile.period < math.inf else 1.0
    sinusoids = sum(abs(w.amplitude) * (4.0 * w.frequency * end + 2.0) for w in profile.sinusoids)
    return (rise + jumps) * turns + sinusoids


