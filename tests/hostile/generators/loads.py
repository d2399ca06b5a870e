# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Normal forces that jump: to nothing and back, at events, with other inputs, and onto the force that is held."""

import random

from stickslip_sim.core.errors import SolverError
from stickslip_sim.core.types import EventKind

from ..case import Case, Values, all_events
from . import degenerate, draw, inputs, machines, ranges, sides

_BASES = (machines.any_machine, machines.any_machine, machines.two_breakpoints, inputs.sines, inputs.step_at_event,
          ranges.excesses, ranges.periodic, ranges.static_laws, degenerate.ties, sides.two_directions,
          sides.odd_directions, sides.mid_cycle)


def loads(rng: random.Random) -> Case:
    """A scene of another kind under a load that jumps."""
    case = rng.choice(_BASES)(rng)
    normal = case.values['axis.normal_force']
    times = [0.0, *_times(rng, case)]
    forces = [normal * rng.choice((0.0, 0.0, -1.0, -0.5, rng.uniform(-1.0, 0.0), rng.uniform(0.0, 2.0), 1e-12))
              for _ in times]
    if 'initial.deflection' in case.values:   # which the contact can hold without a load
        forces[0] = 0.0
    values: Values = case.values | draw.steps('normal_load', 'forces', times, forces)
    if rng.random() < 0.3:
        values['normal_load.period'] = max(times[-1] * rng.uniform(1.01, 1.5), 1e-6)
    return Case(values, case.duration)


def load_onto_force(rng: random.Random) -> Case:
    """A load that falls until the limit is what the slider holds, within rounding, or jumps together with the force."""
    values = draw.paper() | rng.choice((draw.contact(), draw.contact(5e6, rng.choice((0.0, 15000.0)))))
    values |= draw.kinetic([0.0, 0.035], [0.12, 0.05], 0.0, rng.random() < 0.5)
    values = {name: value for name, value in values.items() if not name.startswith('friction.static.')}
    values |= rng.choice((draw.static(0.24), draw.static(0.12, 0.24, 0.2)))
    normal = values['axis.normal_force']
    at = rng.uniform(0.1, 2.0)
    share = rng.choice((0.5, 0.25, rng.uniform(0.1, 0.9)))
    force = 0.24 * normal * share * rng.choice((1.0, -1.0))
    off = rng.choice((0.0, 0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-6, -1e-6))
    values |= draw.steps('normal_load', 'forces', [0.0, at, 1.5 * at],
                         [0.0, normal * (share * (1.0 + off) - 1.0), normal * rng.choice((0.0, 1.0))])
    if rng.random() < 0.5:
        values |= {'drive.course': 'constant', 'drive.velocity': rng.choice((0.0, 0.002))}
        values |= {'force.course': 'constant', 'force.constant': force}
    else:   # both at once: the limit rises with the force, or falls with it
        values |= draw.constant(rng.choice((0.0, 0.002)))
        del values['force.constant']
        values |= draw.steps('force', 'forces', [0.0, at, 1.5 * at],
                             [force * rng.choice((0.0, 1.0)), force, rng.choice((force, 2.0 * force))])
    return Case(values, 2.0 * at)


def _times(rng: random.Random, case: Case) -> list[float]:
    """Return when the load jumps: anywhere, at events or beside them, and where other inputs jump."""
    end = case.duration
    times = {rng.uniform(0.02, 0.98) * end for _ in range(rng.randint(1, 4))}
    try:
        events = [event.time for event in all_events(case.parts)[:40] if event.kind != EventKind.KNOT]
    except SolverError:
        events = []
    times |= {draw.beside(rng, time) for time in rng.sample(events, min(len(events), 2)) if rng.random() < 0.5}
    borders = [*case.values.get('drive.times', ()), *case.values.get('force.times', ())]
    times |= {time for time in borders if rng.random() < 0.4}
    return sorted(time for time in times if time > 1e-12)
