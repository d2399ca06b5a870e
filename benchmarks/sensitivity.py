# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How much the choices that the paper leaves open change its limit cycle: `python3 -m benchmarks.paper` shows it.

One choice at a time is changed in a shipped scene, from prolonged rest, and the cycle is the mean of the last ten.
docs/paper.md shows the extremes of each choice, docs/data/paper_choices.csv every value.
"""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from stickslip_sim.inputs import load_scene
from stickslip_sim.report.text import markdown_table
from stickslip_sim.runs import SimulatedRun, simulate_events

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
           f'{_KINETIC}.coefficients': [0.12, 0.05]}),
]


def outcomes() -> list[Outcome]:
    """Return every choice and its limit cycle."""
    return [_outcome(choice, _run(choice)) for choice in CHOICES]


def table(found: Sequence[Outcome]) -> str:
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
