# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The reference simulator on the paper's data: first events, static coefficients and limit cycles, digit by digit."""

from __future__ import annotations

from typing import Any

import pytest

pytest.importorskip('mpmath')
from mpmath import mpf

from stickslip_sim.reference.exact_run import Run
from tests.reference.figures import agrees
from tests.reference.scenes import Parameters, paper
from tests.support.stored_objects import exact_run as simulate
from tests.support.stored_runs import stored

# kind, t, x, velocity, drive force: every digit counts
RIGID = [
    ('breakaway', '0.67979883333333', '0', '0', '823.7586'),
    ('coast', '0.76770114503556598', '5.3092642091498e-4', '1.45614975366e-2', '552.439531347'),
    ('decelerate', '0.79961346115854196', '9.9561753352655e-4', '1.45614975366e-2', '311.919643128'),
    ('stick', '0.83862368925988008', '1.3615322557025e-3', '0', '197.42907369'),
    ('breakaway', '1.3313467055455221', '1.3615322557025e-3', '0', '788.696693233'),
    ('coast', '1.4173257894649382', '1.8213175147126e-3', '1.26694996285e-2', '565.322440017'),
]
COMPLIANT = [
    ('breakaway', '0.76256755048235998', '1.6410886285782e-4', '2.14285714061e-4', '823.758600008'),
    ('coast', '0.850707630222697', '6.6535579038665e-4', '1.34355898952e-2', '575.893322454'),
    ('decelerate', '0.88805371587200703', '1.1671224813629e-3', '1.34355898952e-2', '319.648610648'),
    ('stick', '0.92738519742899923', '1.5072615660044e-3', '0', '216.505297312'),
    ('breakaway', '1.4463032091159095', '1.5828430395267e-3', '2.14282328562e-4', '793.000897909'),
    ('accelerate', '1.4463032134383819', '1.582843040453e-3', '2.14282328562e-4', '793.00090254'),
]
CONVENTIONAL = [
    ('breakaway', '0.67979883333333', '0', '0', None),
    ('knot', '0.7158107683398723', '7.2167822270819e-4', '0.035', None),
    ('decelerate', None, None, None, None),
    ('knot', '0.72765171843402951', None, '0.035', None),
    ('stick', '0.75893741627714234', '1.801901429588e-3', '0', '-162.41595822'),
    ('breakaway', '1.5749466192221413', None, '0', None),
]


def assert_events(run: Run, expected: list[tuple[str, str | None, str | None, str | None, str | None]]) -> None:
    for event, (kind, *figures) in zip(run, expected):
        found = (event.time, event.position, event.velocity, event.drive_force)
        assert event.kind == kind
        assert [agrees(a, b) for a, b in zip(found, figures)] == [True] * 4, (kind, found)


@pytest.mark.parametrize(
    ('parameters', 'expected'),
    [
        (paper(), RIGID),
        (paper(contact='compliant'), COMPLIANT),
        (paper(dependence=False), CONVENTIONAL),
    ],
    ids=['rigid', 'compliant', 'conventional'],
)
def test_first_events_of_the_paper_data(parameters: Parameters, expected: list[Any]) -> None:
    assert_events(simulate(parameters, 1.65), expected)


def test_static_coefficients_of_the_paper_data() -> None:
    found = {
        'rigid': simulate(paper(), 1.4)[4].static_coefficient,
        'compliant': simulate(paper(contact='compliant'), 1.45)[4].static_coefficient,
        'conventional': simulate(paper(dependence=False), 1.6)[5].static_coefficient,
    }
    assert agrees(found['rigid'], '0.2297848')
    assert agrees(found['compliant'], '0.23103882')
    assert agrees(found['conventional'], '0.2379712')


@pytest.mark.parametrize(
    ('name', 'period', 'jump', 'peak', 'force', 'stick_force'),
    [
        ('paper_fig7', '0.619075168', '1.238150336e-3', '1.23285921663e-2', '781.443710909', '235.301790949'),
        ('paper_fig8', '0.659065697', '1.31813139e-3', '1.16642823367e-2', '788.081203029', '246.606758267'),
    ],
)
def test_limit_cycles_of_the_paper_data(
    name: str, period: str, jump: str, peak: str, force: str, stick_force: str
) -> None:
    events = stored()[name]['events']

    def last(kind: str, column: str) -> list[Any]:
        return [mpf(x) for k, x in zip(events['kind'], events[column]) if k == kind][-2:]

    times, places = last('breakaway', 'time'), last('breakaway', 'position')
    assert agrees(times[1] - times[0], period)
    assert agrees(places[1] - places[0], jump)
    assert agrees(last('coast', 'velocity')[1], peak)
    assert agrees(last('breakaway', 'drive_force')[1], force)
    assert agrees(last('stick', 'drive_force')[1], stick_force)
