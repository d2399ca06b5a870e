# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The reference under a normal force that varies smoothly: closed forms, DOP853, the rule of a contact that yields."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, ramp, steps, table
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.reference import ReferenceRun, simulate
from tests.support.axes import COMPLIANT, RIGID, of_kind, paper_axis

mpmath = pytest.importorskip('mpmath')
from mpmath import mpf  # noqa: E402

NEVER = math.inf
SINE = InputProfile((0.0,), (0.0,), (0.0,), NEVER, (Sinusoid(1000.0, 7.0, 0.0),))
FAST = InputProfile((0.0,), (0.0,), (0.0,), NEVER, (Sinusoid(343.2, 25.0, 0.0),))
SUM = replace(table('load', [0.0, 0.4, 0.7], [0.0, 900.0, -1500.0], 1.1),
              sinusoids=(Sinusoid(500.0, 3.3, 0.5), Sinusoid(150.0, 31.0, 2.0)))
WILD = InputProfile((0.0, 1.5), (0.0, -300.0), (-200.0, 150.0), NEVER, (Sinusoid(700.0, 19.0, 0.5),
                                                                        Sinusoid(300.0, 41.0, 2.0)))
JUMPS = steps('load', [0.0, 0.929, 0.9292, 0.9296], [0.0, -1500.0, 0.0, -1500.0])


def run_of(axis: Axis, load: InputProfile, duration: float, drive: InputProfile | None = None) -> ReferenceRun:
    return simulate(axis, InitialState(), drive or constant(0.002), constant(0.0), duration, load=load)


# ---- slip -------------------------------------------------------------------------------------------


@pytest.mark.parametrize('load', [SINE, ramp(0.0, 400.0, NEVER), table('load', [0.0, 0.1, 0.3], [0.0, 5.0, -3.0]), SUM],
                         ids=['sine', 'ramp', 'table', 'sum'])
def test_a_slip_without_a_spring_is_the_closed_form(load: InputProfile) -> None:
    """m u' = −N (a + b u): a + b u falls by exp(−b/m ∫N), until u = 0."""
    a, b, mass, normal = 0.25, 3.0, 2000.0, 4000.0
    axis = Axis(mass, 0.0, 0.0, normal, RIGID, Friction(StaticLaw(StaticLawKind.CONSTANT, 0.3, 0.3),
                                                        KineticTable((0.0,), (a,), b), None))
    run = simulate(axis, InitialState(velocity=0.5), constant(0.0), constant(0.0), 1.0, load=load)
    assert [event.kind for event in run.events] == [EventKind.STICK]
    with mpmath.workdps(40):
        end = run.exact[0].time
        assert abs(mpf(b) / mass * pressed(load, normal, end) - mpmath.log(1 + mpf(b) * mpf(0.5) / mpf(a))) < 1e-28
        for t in (end / 7, end / 2):
            want = ((mpf(a) + mpf(b) * mpf(0.5)) * mpmath.exp(-mpf(b) / mass * pressed(load, normal, t)) - mpf(a)) / b
            assert abs(run.exact.state_at([t])[0].velocity - want) < mpf(10) ** -28


def pressed(load: InputProfile, normal: float, t: mpf) -> mpf:
    """Return the integral of the normal force."""
    total = normal * t
    ends = [*map(mpf, load.starts[1:]), mpf(load.period)]
    for start, end, value, rate in zip(map(mpf, load.starts), ends, load.values, load.rates):
        span = max(min(t, end) - start, mpf(0))
        total += mpf(value) * span + mpf(rate) * span * span / 2
    for amplitude, frequency, phase in load.sinusoids:
        omega = 2 * mpmath.pi * mpf(frequency)
        total += mpf(amplitude) * (mpmath.cos(mpf(phase)) - mpmath.cos(omega * t + mpf(phase))) / omega
    return total


def test_more_digits_change_none_of_those_promised() -> None:
    """The remainder of the series is below the working precision: 20 digits more leave 30 as they are."""
    axis = paper_axis(COMPLIANT)
    few, many = (simulate(axis, InitialState(), constant(0.002), constant(0.0), 1.1, digits, WILD).exact
                 for digits in (30, 50))
    assert len(few) == len(many) >= 6
    with mpmath.workdps(60):
        for a, b in zip(few, many):
            assert abs(a.time - b.time) < mpf(10) ** -30
            assert abs(a.velocity - b.velocity) < mpf(10) ** -30


def test_a_tie_is_decided_with_the_rate_of_the_normal_force() -> None:
    """The limit sinks onto a force that stays: the slip begins by accelerating, though no input moves the force."""
    axis = paper_axis(RIGID)
    load = InputProfile((0.0,), (0.0,), (0.0,), NEVER, (Sinusoid(343.0, 2.0, 0.0),))
    run = simulate(axis, InitialState(), constant(0.0), constant(780.0), 0.4, load=load)
    assert [event.mode for event in run.events[:1]] == [Mode.ACCELERATING]
    assert run.events[0].time == pytest.approx(0.2946, abs=1e-4)
    assert max(abs(event.velocity) for event in run.events) == pytest.approx(5.55e-3, abs=1e-5)


def test_a_rest_under_a_graze_holds_or_breaks_away_by_its_last_digits() -> None:
    """A load of −N0/2 cos: its least N mu_s is N0 mu_s/2 at t = 0.5; 1e-12 above it breaks away, below it holds."""
    static = StaticLaw(StaticLawKind.CONSTANT, 0.25, 0.25)
    axis = replace(paper_axis(RIGID), normal_force=4096.0,
                   friction=Friction(static, KineticTable((0.0,), (0.25,)), None))
    load = InputProfile((0.0,), (0.0,), (0.0,), NEVER, (Sinusoid(2048.0, 1.0, 0.5 * math.pi),))
    for above in (1e-12, -1e-12):
        run = simulate(axis, InitialState(), constant(0.0), constant(512.0 * (1.0 + above)), 1.0, load=load)
        assert bool(run.events) == (above > 0.0)


# ---- a contact that yields ------------------------------------------------------------------------------


@pytest.mark.parametrize('damping', [15000.0, 0.0])
@pytest.mark.parametrize('load', [FAST, JUMPS, WILD], ids=['sine', 'steps', 'sum'])
def test_the_rule_of_a_contact_that_yields_holds_all_along(damping: float, load: InputProfile) -> None:
    """In stick |F| <= N mu_s; while it yields F = s N mu_k(0), the slider does not go along s, the contact does."""
    axis = replace(paper_axis(COMPLIANT), contact=CompliantContact(5e6, damping))
    run = run_of(axis, load, 1.2)
    yields = [k for k, event in enumerate(run.events) if event.kind == EventKind.YIELD]
    assert yields
    for k, event in enumerate(run.events[:-1]):
        if event.mode in (Mode.STICK, Mode.YIELDING):
            held(axis, load, run, k)
    for k in yields:
        event, after = run.events[k], run.events[k + 1]
        assert event.direction * event.velocity <= 0.0
        assert (event.mode, after.kind) in {(Mode.YIELDING, EventKind.STICK), (Mode.YIELDING, EventKind.BREAKAWAY)}
        assert after.rest_time == 0.0
        assert after.direction == event.direction


def held(axis: Axis, load: InputProfile, run: ReferenceRun, k: int) -> None:
    event, until = run.events[k], run.events[k + 1].time
    steps_of_time = [event.time + (until - event.time) * share for share in np.linspace(0.001, 0.999, 12)]
    for here in run.exact.state_at(steps_of_time):
        t = float(here.time)
        normal = axis.normal_force + load.value_at(t)
        if here.mode == Mode.YIELDING:
            assert float(here.friction_force) == pytest.approx(event.direction * normal * 0.12, rel=1e-12)
            assert event.direction * here.velocity <= 0.0
        elif here.mode == Mode.STICK:
            limit = normal * axis.friction.static.coefficient(max(t - event.time, 0.0))
            assert abs(here.friction_force) <= limit * (1.0 + 1e-9)


def test_with_a_normal_force_that_stays_no_contact_yields() -> None:
    run = run_of(paper_axis(COMPLIANT), constant(0.0), 3.0)
    assert len(run.events) > 10
    assert not of_kind(run.events, EventKind.YIELD)


def test_the_rule_of_a_contact_that_yields_is_the_limit_of_a_viscous_one() -> None:
    """With η z' = s F − N mu_k(0) in place of the rule the speed at its end is off in proportion to η."""
    axis, contact = paper_axis(COMPLIANT), COMPLIANT
    events = run_of(axis, FAST, 1.0).events
    k = next(k for k, event in enumerate(events) if event.kind == EventKind.YIELD)
    begin, end = events[k], events[k + 1]

    def motion(t: float, y: np.ndarray[Any, Any], viscosity: float) -> list[float]:
        w, u, deflection = y
        force = contact.stiffness * deflection + contact.damping * u
        slide = (force - 0.12 * (axis.normal_force + FAST.value_at(float(t)))) / (viscosity + contact.damping)
        pull = axis.drive_stiffness * w + axis.drive_damping * (0.002 - u)
        return [0.002 - u, (pull - force + contact.damping * slide) / axis.mass, u - slide]

    start = [(begin.drive_force - axis.drive_damping * (0.002 - begin.velocity)) / axis.drive_stiffness, begin.velocity,
             (begin.friction_force - contact.damping * begin.velocity) / contact.stiffness]
    for viscosity in (100.0, 10.0, 1.0):
        done = solve_ivp(motion, (begin.time, end.time), start, method='Radau', rtol=1e-10, atol=1e-13,
                         args=(viscosity,))
        assert done.y[1, -1] / end.velocity - 1.0 == pytest.approx(1.63e-6 * viscosity, rel=0.02)
