# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Generators by name: each is a function of a random.Random and returns a Case."""

import random
from collections.abc import Callable, Mapping

from ..case import Case
from . import closures, degenerate, inputs, loads, machines, ranges, sides, smooth, smooth_loads

Generator = Callable[[random.Random], Case]

GENERATORS: Mapping[str, Generator] = {generator.__name__: generator for generator in (
    machines.two_breakpoints, machines.fig4_sweep, machines.any_machine,
    degenerate.slopes, degenerate.critical_slip, degenerate.paper_critical, degenerate.critical_contact,
    degenerate.equal_eigenvalues, degenerate.limit_velocities, degenerate.contacts, degenerate.touching,
    degenerate.ties, inputs.grazing_sine, inputs.grazing_ramp, inputs.peak_at_breakpoint, inputs.steady_at_breakpoint,
    inputs.step_at_event, inputs.resonance, inputs.sines, smooth.smooth,
    ranges.static_laws, ranges.late, ranges.whole_range, ranges.excesses, ranges.odd_sines, ranges.periodic,
    loads.loads, loads.load_onto_force, smooth_loads.paper_loads, smooth_loads.smooth_loads,
    sides.two_directions, sides.odd_directions, sides.mid_cycle,
    closures.closures, closures.odd_closures, closures.delays)}
PLAUSIBLE = frozenset({'two_breakpoints', 'fig4_sweep', 'any_machine', 'smooth', 'sines', 'two_directions',
                       'closures', 'paper_loads'})
