# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The exact engine against the check values of the model, and against a classical cycle in closed form."""

import math

import pytest

from stickslip_sim.axis import Axis, Friction
from stickslip_sim.core.types import EventKind
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from tests.support.axes import COMPLIANT, RIGID, Contact, of_kind, paper_axis, run_events

# model.md: kind, t / s, x / m, ẋ / (m/s), F_d / N, from 40-digit arithmetic
RIGID_EVENTS = [
    (EventKind.BREAKAWAY, 0.67979883333333, 0.0, 0.0, 823.7586),
    (EventKind.COAST, 0.76770114503556598, 5.3092642091498e-4, 1.45614975366e-2, 552.439531347),
    (EventKind.DECELERATE, 0.79961346115854196, 9.9561753352655e-4, 1.45614975366e-2, 311.919643128),
    (EventKind.STICK, 0.83862368925988008, 1.3615322557025e-3, 0.0, 197.42907369),
    (EventKind.BREAKAWAY, 1.3313467055455221, 1.3615322557025e-3, 0.0, 788.696693233),
    (EventKind.COAST, 1.4173257894649382, 1.8213175147126e-3, 1.26694996285e-2, 565.322440017),
]
COMPLIANT_EVENTS = [
    (EventKind.BREAKAWAY, 0.76256755048235998, 1.6410886285782e-4, 2.14285714061e-4, 823.758600008),
    (EventKind.COAST, 0.850707630222697, 6.6535579038665e-4, 1.34355898952e-2, 575.893322454),
    (EventKind.DECELERATE, 0.88805371587200703, 1.1671224813629e-3, 1.34355898952e-2, 319.648610648),
    (EventKind.STICK, 0.92738519742899923, 1.5072615660044e-3, 0.0, 216.505297312),
    (EventKind.BREAKAWAY, 1.4463032091159095, 1.5828430395267e-3, 2.14282328562e-4, 793.000897909),
    (EventKind.ACCELERATE, 1.4463032134383819, 1.582843040453e-3, 2.14282328562e-4, 793.00090254),
]
CONVENTIONAL_EVENTS = [
    (EventKind.BREAKAWAY, 0.67979883333333, 0.0, 0.0, 823.7586),
    (EventKind.KNOT, 0.7158107683398723, 7.2167822270819e-4, 0.035, None),
    (EventKind.DECELERATE, None, None, None, None),
    (EventKind.KNOT, 0.72765171843402951, None, 0.035, None),
    (EventKind.STICK, 0.75893741627714234, 1.801901429588e-3, 0.0, -162.41595822),
    (EventKind.BREAKAWAY, 1.5749466192221413, 1.801901429588e-3, 0.0, None),
]


@pytest.mark.parametrize(('contact', 'branches', 'expected'), [
    (RIGID, True, RIGID_EVENTS), (COMPLIANT, True, COMPLIANT_EVENTS), (RIGID, False, CONVENTIONAL_EVENTS)])
def test_check_values_of_the_model(contact: Contact, branches: bool, expected: list[tuple[object, ...]]) -> None:
    events = run_events(paper_axis(contact, branches=branches), 0.002, 1.6)
    assert [e.kind for e in events[:len(expected)]] == [row[0] for row in expected]
    for event, (_, *values) in zip(events, expected):
        got = (event.time, event.position, event.velocity, event.drive_force)
        for value, want, last_digit in zip(got, values, (2e-14, 1e-16, 1e-13, 1e-9)):
            if want is not None:
                assert value == pytest.approx(want, rel=1e-11 if last_digit == 1e-9 else 0.0, abs=last_digit), event


@pytest.mark.parametrize(('contact', 'period', 'jump', 'peak', 'break_force', 'stick_force'), [
    (RIGID, 0.619075168, 1.238150336e-3, 1.23285921663e-2, 781.443710909, 235.301790949),
    (COMPLIANT, 0.659065697, 1.31813139e-3, 1.16642823367e-2, 788.081203029, 246.606758267)])
def test_limit_cycle_of_the_model(contact: Contact, period: float, jump: float, peak: float, break_force: float,
                                  stick_force: float) -> None:
    events = run_events(paper_axis(contact), 0.002, 60.0)
    first, second = of_kind(events, EventKind.BREAKAWAY)[-2:]
    assert second.time - first.time == pytest.approx(period, abs=6e-10)
    assert second.position - first.position == pytest.approx(jump, abs=6e-12)
    assert second.drive_force == pytest.approx(break_force, abs=6e-10)
    assert of_kind(events, EventKind.COAST)[-1].velocity == pytest.approx(peak, abs=6e-14)
    assert of_kind(events, EventKind.STICK)[-1].drive_force == pytest.approx(stick_force, abs=6e-10)


def test_second_static_coefficients_of_the_model() -> None:
    for contact, branches, value, digit in ((RIGID, True, 0.2297848, 1e-7), (COMPLIANT, True, 0.23103882, 1e-8),
                                            (RIGID, False, 0.2379712, 1e-7)):
        events = run_events(paper_axis(contact, branches=branches), 0.002, 1.6)
        assert of_kind(events, EventKind.BREAKAWAY)[1].static_coefficient == pytest.approx(value, abs=0.5 * digit)


def test_undamped_coulomb_cycle_in_closed_form() -> None:
    """m u′ = c w − F with F_s = 824 N, F_k = 412 N, no damping, v = 5 mm/s: docs of the classical cycle."""
    v, c, m = 0.005, 6e5, 350.0
    friction = Friction(StaticLaw(StaticLawKind.CONSTANT, 0.24, 0.24), KineticTable((0.0,), (0.12,)), None)
    events = run_events(Axis(m, c, 0.0, 412.0 / 0.12, RIGID, friction), v, 20.0)
    omega, a = math.sqrt(c / m), 412.0 / (v * math.sqrt(c * m))
    breaks, sticks = of_kind(events, EventKind.BREAKAWAY)[5:], of_kind(events, EventKind.STICK)[5:]
    assert sticks[0].time - breaks[0].time == pytest.approx(2.0 / omega * (math.pi - math.atan(a)), rel=1e-12)
    assert breaks[1].time - sticks[0].time == pytest.approx(2.0 * 412.0 / (c * v), rel=1e-12)
    assert of_kind(events, EventKind.DECELERATE)[5].velocity == pytest.approx(v * (1 + math.hypot(1, a)), rel=1e-13)
    assert sticks[0].time - breaks[0].time == pytest.approx(84.28583e-3, abs=5e-9)
