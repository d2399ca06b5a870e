# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Generators by name: each is a function of a random.Random and returns a Case.

Here are those that change how stick begins and ends, alone and together, and let the growth of mu_s wait.
"""

import random
from collections.abc import Callable, Mapping

from stickslip_sim.core.types import Event, EventKind

from ..case import Case
from . import changes, draw, edges, inputs, machines

_MACHINES = machines.two_breakpoints, machines.any_machine, machines.smooth, inputs.sines, changes.two_directions
_ODD = (edges.slopes, edges.critical_slip, edges.critical_contact, edges.equal_eigenvalues,
        edges.limit_velocities, edges.contacts, edges.touching, edges.ties, inputs.grazing_sine,
        inputs.grazing_ramp, inputs.peak_at_breakpoint, inputs.step_at_event, inputs.resonance, edges.static_laws,
        edges.late, edges.whole_range, edges.excesses, edges.odd_sines, edges.periodic, changes.loads,
        changes.load_onto_force, changes.odd_directions, changes.mid_cycle)


def closures(rng: random.Random) -> Case:
    """Machines with any of the other closures, or all of them."""
    return _closed(rng, rng.choice(_MACHINES)(rng))


def odd_closures(rng: random.Random) -> Case:
    """Scenes of every other kind with the other closures."""
    return _closed(rng, rng.choice(_ODD)(rng))


def delays(rng: random.Random) -> Case:
    """A growth of mu_s that begins at an event, at a jump of an input, with the run or beside them; or never."""
    case = rng.choice((machines.two_breakpoints, machines.any_machine, edges.static_laws, changes.loads))(rng)
    values = case.values
    if 'friction.static.time_constant' not in values:
        return case
    delay = rng.choice((draw.beside(rng, rng.choice(_rests(case) or [0.1])), draw.powers(rng, 1e-12, 1e6)))
    given = {'friction.static.delay': delay}
    if rng.random() < 0.3:
        given['initial.rest_time'] = rng.choice((delay, draw.beside(rng, delay), 0.5 * delay))
    return Case(values | given, case.duration)


def _closed(rng: random.Random, case: Case) -> Case:
    return Case(case.values | draw.closures(rng, case.values, rng.choice((0.3, 0.6, 1.0))), case.duration)


def _rests(case: Case) -> list[float]:
    """Return how long sticks last, or how long they have lasted where an input jumps, s."""
    events = case.events[:60]
    borders = [*case.values.get('drive.times', ()), *case.values.get('force.times', ())]
    rests = [event.rest_time for event in events if event.kind == EventKind.BREAKAWAY]
    rests += [time - _stick_before(events, time) for time in borders]
    return [rest for rest in rests if 0.0 < rest < 1e6]


def _stick_before(events: list[Event], time: float) -> float:
    return max((event.time for event in events if event.kind == EventKind.STICK and event.time <= time), default=0.0)


Generator = Callable[[random.Random], Case]

GENERATORS: Mapping[str, Generator] = {generator.__name__: generator for generator in (
    machines.two_breakpoints, machines.fig4_sweep, machines.any_machine,
    edges.slopes, edges.critical_slip, edges.paper_critical, edges.critical_contact,
    edges.equal_eigenvalues, edges.limit_velocities, edges.contacts, edges.touching,
    edges.ties, inputs.grazing_sine, inputs.grazing_ramp, inputs.peak_at_breakpoint, inputs.steady_at_breakpoint,
    inputs.step_at_event, inputs.resonance, inputs.sines, inputs.shaken, machines.smooth,
    edges.static_laws, edges.late, edges.whole_range, edges.excesses, edges.odd_sines, edges.periodic,
    changes.loads, changes.load_onto_force, changes.paper_loads, changes.smooth_loads,
    changes.two_directions, changes.odd_directions, changes.mid_cycle,
    closures, odd_closures, delays)}
PLAUSIBLE = frozenset({'two_breakpoints', 'fig4_sweep', 'any_machine', 'smooth', 'sines', 'two_directions',
                       'closures', 'paper_loads'})
