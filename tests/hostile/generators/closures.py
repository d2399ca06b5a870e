# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The other closures of how stick begins and ends, alone and together, and growth of mu_s that waits."""

import random

from stickslip_sim.core.errors import InputError, SolverError
from stickslip_sim.core.types import Event, EventKind

from ..case import Case, all_events
from . import degenerate, draw, inputs, loads, machines, ranges, sides, smooth

_MACHINES = machines.two_breakpoints, machines.any_machine, smooth.smooth, inputs.sines, sides.two_directions
_ODD = (degenerate.slopes, degenerate.critical_slip, degenerate.critical_contact, degenerate.equal_eigenvalues,
        degenerate.limit_velocities, degenerate.contacts, degenerate.touching, degenerate.ties, inputs.grazing_sine,
        inputs.grazing_ramp, inputs.peak_at_breakpoint, inputs.step_at_event, inputs.resonance, ranges.static_laws,
        ranges.late, ranges.whole_range, ranges.excesses, ranges.odd_sines, ranges.periodic, loads.loads,
        loads.load_onto_force, sides.odd_directions, sides.mid_cycle)


def closures(rng: random.Random) -> Case:
    """Machines with any of the other closures, or all of them."""
    return _closed(rng, rng.choice(_MACHINES)(rng))


def odd_closures(rng: random.Random) -> Case:
    """Scenes of every other kind with the other closures."""
    return _closed(rng, rng.choice(_ODD)(rng))


def delays(rng: random.Random) -> Case:
    """A growth of mu_s that begins at an event, at a jump of an input, with the run or beside them; or never."""
    case = rng.choice((machines.two_breakpoints, machines.any_machine, ranges.static_laws, loads.loads))(rng)
    values = case.values
    if 'friction.static.time_constant' not in values:
        return case
    delay = rng.choice((draw.beside(rng, rng.choice(_rests(case) or [0.1])), draw.powers(rng, 1e-12, 1e6)))
    changes = {'friction.static.delay': delay}
    if rng.random() < 0.3:
        changes['initial.rest_time'] = rng.choice((delay, draw.beside(rng, delay), 0.5 * delay))
    return Case(values | changes, case.duration)


def _closed(rng: random.Random, case: Case) -> Case:
    return Case(case.values | draw.closures(rng, case.values, rng.choice((0.3, 0.6, 1.0))), case.duration)


def _rests(case: Case) -> list[float]:
    """Return how long sticks last, or how long they have lasted where an input jumps, s."""
    try:
        events = all_events(case.parts)[:60]
    except (InputError, SolverError):
        return []
    borders = [*case.values.get('drive.times', ()), *case.values.get('force.times', ())]
    rests = [event.rest_time for event in events if event.kind == EventKind.BREAKAWAY]
    rests += [time - _stick_before(events, time) for time in borders]
    return [rest for rest in rests if 0.0 < rest < 1e6]


def _stick_before(events: list[Event], time: float) -> float:
    return max((event.time for event in events if event.kind == EventKind.STICK and event.time <= time), default=0.0)
