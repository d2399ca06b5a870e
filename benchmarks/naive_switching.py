# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One slip of the paper's axis by a stepper that takes the branch of friction from the last sign of ẍ.

Its friction flickers between the branches step by step, which on average is friction half way between them: what it
converges to with smaller steps is not the coasting motion.  `python3 -m benchmarks.paper` shows it.
"""

from typing import NamedTuple

from stickslip_sim.axis import Axis
from stickslip_sim.figures.cycles import cycle_figures
from stickslip_sim.proof.axes import RIGID, paper_axis, run_events
from stickslip_sim.report.text import markdown_table

FEED = 0.002                   # m/s
STEPS = 1e-4, 1e-5, 1e-6       # s


class Slip(NamedTuple):
    """How long a slip takes (s), how far it goes (m), its peak speed (m/s), and how often the branch changed."""

    time: float
    travel: float
    peak_speed: float
    switches: int


def naive_slip(step: float, axis: Axis) -> Slip:
    """Return the first slip from prolonged rest by semi-implicit Euler steps (s)."""
    kinetic, psi = axis.friction.kinetic, axis.friction.excess
    assert psi is not None
    stretch = (axis.normal_force * axis.friction.static.limit - axis.drive_damping * FEED) / axis.drive_stiffness
    excess = axis.friction.static.limit - kinetic.coefficients[0]
    x, peak, switches, steps, accelerating = 0.0, 0.0, 0, 0, True
    u = 1e-9   # m/s: at 0 the forces of the break-away balance
    while u > 0.0:
        mu = kinetic.coefficient(u) + (excess * psi.fraction(u) if accelerating else 0.0)
        force = axis.drive_stiffness * (stretch + FEED * steps * step - x) + axis.drive_damping * (FEED - u)
        acceleration = (force - axis.normal_force * mu) / axis.mass
        switches += (acceleration > 0.0) != accelerating
        accelerating = acceleration > 0.0
        u += step * acceleration
        x += step * u
        peak, steps = max(peak, u), steps + 1
    return Slip(steps * step, x, peak, switches)


def exact_slip(axis: Axis) -> Slip:
    """Return the first slip of the engine; its branch changes once, by coasting."""
    cycle = cycle_figures(run_events(axis, FEED, 2.0))[0]
    return Slip(cycle.slip_time, cycle.slip_travel, cycle.peak_speed, 1)


def table() -> str:
    """Return the rows as docs/paper.md shows them."""
    axis = paper_axis(RIGID)
    slips = {'coasting (the engine)': exact_slip(axis),
             **{f'last sign of ẍ, steps of {step * 1e6:g} µs': naive_slip(step, axis) for step in STEPS}}
    heads = 'first slip', 'time / ms', 'peak speed / (mm/s)', 'changes of branch'
    return '\n'.join(markdown_table(heads, [
        (name, f'{slip.time * 1e3:.2f}', f'{slip.peak_speed * 1e3:.3f}', str(slip.switches))
        for name, slip in slips.items()])) + '\n'
