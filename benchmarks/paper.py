# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure what docs/paper.md shows, and put it between its markers: `python3 -m benchmarks.paper` (seconds).

All figures behind the page go to docs/data/paper_choices.csv and docs/data/paper_classics.csv.
"""

import csv
import io
import math
import pathlib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from stickslip_sim.axis import Axis
from stickslip_sim.figures.cycles import cycle_figures
from stickslip_sim.inputs import load_scene
from stickslip_sim.proof.axes import RIGID, paper_axis, run_events
from stickslip_sim.report.text import markdown_table
from stickslip_sim.runs import SimulatedRun, simulate_events
from stickslip_sim.study.critical import critical_drop, critical_feed

from .classics import DAMPING_RATIOS, DROP, EXACT, GROUPS, PAPER, Result, damped, light_damping_feed
from .page import replace_generated

# How much the choices that the paper leaves open change its limit cycle.
#
# One choice at a time is changed in a shipped scene, from prolonged rest, and the cycle is the mean of the last ten.
# docs/paper.md shows the extremes of each choice, docs/data/paper_choices.csv every value.

Changes = Mapping[str, object]

BASE = 'paper_fig8'
DURATION = 60.0   # s

_WEIGHT = 350 * 9.80665   # N
_FIRST, _STATIC, _KINETIC = 'as shipped', 'friction.static', 'friction.kinetic'
_SMOOTH: Changes = {f'{_KINETIC}.initial': 0.12, f'{_KINETIC}.limit': 0.05, f'{_KINETIC}.tolerance': 1e-5}


class Choice(NamedTuple):
    """One value of one choice."""

    what: str
    value: str
    changes: Changes
    on_page: bool = True


class Outcome(NamedTuple):
    """The limit cycle of a choice: texts, in the units of the heads; without stick-slip all but `period` are empty."""

    choice: Choice
    period: str
    stick: str = ''
    slip: str = ''
    jump: str = ''
    peak_speed: str = ''
    break_away: str = ''


def ring_down_time(share: float) -> float:
    """Return how long the ring-down of the paper's contact takes to come down to a share of its start, s."""
    return -math.log(share) * 2.0 * 350.0 / (4000.0 + 15000.0)


def _numbers(what: str, name: str, values: Sequence[float], unit: str, scale: float = 1.0) -> list[Choice]:
    """Return a choice for each value, of which the page shows the first and the last."""
    return [Choice(what, f'{value * scale:.5g}{unit}', {name: value}, value in (values[0], values[-1]))
            for value in values]


CHOICES = [
    Choice(_FIRST, 'Fig. 8', {}),
    Choice('contact', 'rigid (Fig. 7)', {'contact.model': 'rigid'}),
    *_numbers('contact spring c_c', 'contact.stiffness', (2.5e6, 1e7), ' kN/mm', 1e-6),
    *_numbers('contact damper h_c', 'contact.damping', (0.0, 7500.0, 30000.0), ' Ns/mm', 1e-3),
    Choice('contact as stick begins', 'undeflected', {'contact.arrest': 'undeflected'}),
    Choice('break-away decided by', 'F_d + F_e', {'contact.break_away': 'drive_force'}, False),
    Choice('break-away decided by', 'F_d + F_e, at 10 mm/s', {'drive.velocity': 0.01,
           'contact.break_away': 'drive_force'}),
    *(Choice('rest time starts', f'after ring-down to {share:g} %', {f'{_STATIC}.delay': ring_down_time(0.01 * share)})
      for share in (10.0, 1.0)),
    Choice('damper h', 'between slider and slideway', {'axis.damper': 'slideway'}, False),
    *_numbers('feed v', 'drive.velocity', (0.0005, 0.001, 0.003, 0.004, 0.005, 0.01), ' mm/s', 1e3),
    *_numbers('normal force N', 'axis.normal_force', (0.5 * _WEIGHT, 0.8 * _WEIGHT, 1.25 * _WEIGHT, 2.0 * _WEIGHT),
              ' kN', 1e-3),
    *_numbers('rest-time constant τ', f'{_STATIC}.time_constant', (0.05, 0.1, 0.4, 1.0, 2.0), ' s'),
    Choice('growth of mu_s', 'Kato, n = 0.5', {f'{_STATIC}.law': 'kato', f'{_STATIC}.initial': 0.12, f'{_STATIC}.limit':
           0.24, f'{_STATIC}.time_constant': 0.2, f'{_STATIC}.exponent': 0.5}, False),
    Choice('growth of mu_s', 'hyperbolic', {f'{_STATIC}.law': 'hyperbolic', f'{_STATIC}.initial': 0.12,
           f'{_STATIC}.limit': 0.24, f'{_STATIC}.time_constant': 0.2}, False),
    Choice('growth of mu_s', 'none (0.24)', {f'{_STATIC}.law': 'constant', f'{_STATIC}.initial': 0.24}),
    Choice('loop ψ', 'cosine', {'friction.excess.law': 'cosine', 'friction.excess.tolerance': 1e-5}),
    Choice('loop ψ', '(1 − z)²', {'friction.excess.law': 'power', 'friction.excess.exponent': 2.0,
           'friction.excess.tolerance': 1e-5}, False),
    Choice('loop ψ', 'up to v_gr/2', {'friction.excess.velocities': [0.0, 0.0175],
           'friction.excess.fractions': [1.0, 0.0]}, False),
    Choice('loop ψ', 'none (Fig. 3)', {'friction.acceleration_dependence': False}),
    Choice('mu_k between its points', 'exponential', {f'{_KINETIC}.law': 'exponential',
           f'{_KINETIC}.stribeck_velocity': 0.035 / math.log(100.0), **_SMOOTH}),
    Choice('mu_k between its points', 'Gaussian', {f'{_KINETIC}.law': 'stribeck',
           f'{_KINETIC}.stribeck_velocity': 0.035 / math.sqrt(math.log(100.0)), **_SMOOTH}, False),
    Choice('v_gr = 35', 'read as m/s', {f'{_KINETIC}.velocities': [0.0, 35.0],
           f'{_KINETIC}.coefficients': [0.12, 0.05]}, False),
]


def outcomes() -> list[Outcome]:
    """Return every choice and its limit cycle."""
    return [_outcome(choice, _run(choice)) for choice in CHOICES]


def choices_table(found: Sequence[Outcome]) -> str:
    """Return the main figures of the choices that docs/paper.md shows."""
    heads = 'choice', 'value', 'period / s', 'peak speed / (mm/s)', 'break-away / kN'
    return '\n'.join(markdown_table(heads, [
        (one.choice.what, one.choice.value, one.period, one.peak_speed, one.break_away)
        for one in found if one.choice.on_page])) + '\n'


def all_rows(found: Sequence[Outcome]) -> list[tuple[str, ...]]:
    """Return every figure of every choice, under heads with their units."""
    heads = ('choice', 'value', 'period (s)', 'stick (s)', 'slip (s)', 'jump (mm)', 'peak speed (mm/s)',
             'break-away (kN)')
    return [heads, *((one.choice.what, one.choice.value, *one[1:]) for one in found)]


def _run(choice: Choice) -> SimulatedRun:
    return simulate_events(load_scene(BASE, choice.changes), DURATION)


def _outcome(choice: Choice, run: SimulatedRun) -> Outcome:
    last, cycle = run.summary.last, run.summary.mean
    if last is None or cycle is None or DURATION - last.begin > 3.0 * last.period:
        return Outcome(choice, 'none: slides')
    about = '' if run.summary.settled else '≈ '
    return Outcome(choice, f'{about}{cycle.period:.4f}', f'{cycle.stick_time:.4f}', f'{cycle.slip_time:.4f}',
                   f'{cycle.jump * 1e3:.4f}', f'{cycle.peak_speed * 1e3:.3f}', f'{cycle.break_away_force * 1e-3:.4f}')


# One slip of the paper's axis by a stepper that takes the branch of friction from the last sign of ẍ.
#
# Its friction flickers between the branches step by step, which on average is friction half way between them: what it
# converges to with smaller steps is not the coasting motion.

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


def switching_table() -> str:
    """Return the rows as docs/paper.md shows them."""
    axis = paper_axis(RIGID)
    slips = {'coasting (the engine)': exact_slip(axis),
             **{f'last sign of ẍ, steps of {step * 1e6:g} µs': naive_slip(step, axis) for step in STEPS}}
    heads = 'first slip', 'time / ms', 'peak speed / (mm/s)', 'changes of branch'
    return '\n'.join(markdown_table(heads, [
        (name, f'{slip.time * 1e3:.2f}', f'{slip.peak_speed * 1e3:.3f}', str(slip.switches))
        for name, slip in slips.items()])) + '\n'


# The page and its files of data.

PAGE, DATA = pathlib.Path('docs/paper.md'), pathlib.Path('docs/data')


def made() -> tuple[dict[str, str], dict[str, str]]:
    """Return the tables of the page by the names of their markers, and the text of each file of data by its name."""
    choices, results = outcomes(), [result for group in GROUPS for result in group()]
    shown = {'sensitivity': choices_table(choices), 'switching': switching_table(),
             'classics': closeness(results), 'critical': critical_table()}
    return shown, {'paper_choices.csv': _as_csv(all_rows(choices)),
                   'paper_classics.csv': _as_csv(all_results(results))}


def closeness(results: Iterable[Result]) -> str:
    """Return in a sentence how many figures the engine has within each bound."""
    counts = Counter(map(_bound, results))
    return 'The engine agrees with ' + ', with '.join(f'{n} figures to {bound}' for bound, n in counts.items()) + '.\n'


def all_results(results: Iterable[Result]) -> list[tuple[str, ...]]:
    """Return each figure of the classical results, and how close the engine is to it, under heads."""
    return [('result', 'value', 'unit', 'engine within'),
            *((one.name, f'{one.expected:.10g}', one.unit, _bound(one)) for one in results)]


def critical_table() -> str:
    """Return critical feeds beside the usual estimate of them."""
    heads = 'ζ', 'A_c', 'v_c / (mm/s) for ΔF = 412 N', 'error of the estimate'
    return '\n'.join(markdown_table(heads, [
        (f'{zeta:.4g}', f'{critical_drop(zeta):.6f}', f'{critical_feed(damped(zeta), DROP) * 1e3:.4f}',
         f'{light_damping_feed(damped(zeta), DROP) / critical_feed(damped(zeta), DROP) - 1.0:+.0%}')
        for zeta in (*DAMPING_RATIOS, PAPER.damping_ratio)])) + '\n'


def _bound(result: Result) -> str:
    return f'{EXACT:.0e}' if result.tolerance == EXACT else f'{result.tolerance * abs(result.expected):.0e} absolute'


def _as_csv(rows: Sequence[Sequence[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator='\n').writerows(rows)
    return text.getvalue()


if __name__ == '__main__':
    page_parts, files = made()
    for name, text in page_parts.items():
        replace_generated(PAGE, text, name)
    for name, text in files.items():
        (DATA / name).write_text(text, encoding='utf-8')
