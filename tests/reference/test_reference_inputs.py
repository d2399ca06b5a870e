# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The reference with sines, periods, an end slope and long rests: closed forms, DOP853, and the law itself."""

import math
import random
from fractions import Fraction
from typing import Any

import pytest

from stickslip_sim.axis import Axis, Friction, InitialState, RigidContact
from stickslip_sim.core.errors import InputError, StickslipError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, steps, table
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.reference import simulate
from tests.conftest import Program
from tests.support.axes import COMPLIANT, RIGID, of_kind, paper_axis

mpmath = pytest.importorskip('mpmath')
from mpmath import mpf  # noqa: E402

from stickslip_sim.reference.exact_run import split  # noqa: E402
from tests.reference.inclusion import violations  # noqa: E402
from tests.reference.scenes import Parameters, paper  # noqa: E402
from tests.support.stored_objects import exact_run  # noqa: E402

NEVER = math.inf


def coulomb_axis(kinetic: KineticTable, stiffness: float, damping: float) -> Axis:
    static = StaticLaw(StaticLawKind.CONSTANT, 0.3, 0.3)
    return Axis(2.0, stiffness, damping, 16.0, RIGID, Friction(static, kinetic, None))


# ---- sines ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(('stiffness', 'damping', 'frequency'), [
    (800.0, 8.0, 2.5), (800.0, 0.0, 7.0), (0.0, 8.0, 2.5), (0.0, 0.0, 2.5), (8.0, 8.0, 40.0)])
def test_sliding_under_a_sine_is_the_closed_form(stiffness: float, damping: float, frequency: float) -> None:
    """Always ẋ > 0, so friction is constant: x = particular solution, plus a free oscillation from the start."""
    axis = coulomb_axis(KineticTable((0.0,), (0.25,)), stiffness, damping)
    sinusoid = Sinusoid(0.02, frequency, 0.7)
    drive = InputProfile((0.0,), (0.5,), (0.0,), NEVER, (sinusoid,))
    force = InputProfile((0.0,), (4.0,), (0.0,), NEVER, (Sinusoid(0.3, 11.0, -1.0),))
    run = simulate(axis, InitialState(velocity=0.5), drive, force, 1.5)
    assert not of_kind(run.events, EventKind.STICK)
    with mpmath.workdps(40):
        for t in (mpf('0.1'), mpf('0.77'), mpf('1.5')):
            got = run.exact.state_at([t])[0]
            want = sliding(stiffness, damping, sinusoid, t)
            assert abs(got.velocity - want) < mpf(10) ** -29


def sliding(stiffness: float, damping: float, sinusoid: Sinusoid, t: mpf) -> mpf:
    """Solve 2 u'' + h u' + c u = c v + h v' + F' for u by superposition; u(0) = 0.5, 2 u'(0) = h (v(0) - 0.5) + F(0).

    With the mean forces in balance (F_e = N mu_k) only the sines act.
    """
    m, c, h = mpf(2), mpf(stiffness), mpf(damping)
    parts = [(mpf(sinusoid.amplitude), mpf(sinusoid.frequency), mpf(sinusoid.phase), True),
             (mpf(0.3), mpf(11), mpf(-1), False)]
    steady, rate, push = mpf(0.5), mpf(0), mpf(0)
    now = steady
    for amplitude, frequency, phase, moves in parts:
        w = 2 * mpmath.pi * frequency
        s = mpmath.mpc(0, w)
        gain = amplitude * mpmath.expj(phase) * ((c + h * s) if moves else s) / (m * s * s + h * s + c)
        steady, rate, now = steady + gain.imag, rate + (gain * s).imag, now + (gain * mpmath.expj(w * t)).imag
        push += amplitude * mpmath.sin(phase) * (h if moves else 1)
    a, b = mpf(0.5) - steady, push / m - rate
    g = h / (2 * m)
    nu = mpmath.sqrt(c / m - g * g)
    swing = (mpmath.sin(nu * t) / nu).real if nu else t
    return now + (mpmath.exp(-g * t) * (a * mpmath.cos(nu * t) + (b + g * a) * swing)).real


def shaken(contact: str, **changes: Any) -> Parameters:
    parameters = paper(contact=contact)
    parameters['drive'] = {'segments': [[0.0, 0.004, 0.0], [0.3, -0.002, 0.01]], 'period': 0.7,
                           'waves': [[0.003, 2.0, 0.4], [0.001, 9.0, 0.0]]}
    parameters['force'] = {'segments': [[0.0, 50.0, -30.0]], 'waves': [[200.0, 6.0, 1.0]]}
    return {**parameters, **changes}


@pytest.mark.parametrize('contact', ['rigid', 'compliant'])
def test_sums_of_sines_on_a_periodic_profile_keep_the_law(contact: str) -> None:
    parameters = shaken(contact)
    run = exact_run(parameters, 2.0, 30)
    assert len(run) > 15
    rng = random.Random(7)
    times = [rng.uniform(0.0, 2.0) for _ in range(20)]
    assert violations(run, parameters, times) == []
    wrong = {**parameters, 'force': {**parameters['force'], 'waves': [[200.0, 6.001, 1.0]]}}
    assert violations(run, wrong, times) != []


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
@pytest.mark.parametrize('excess', [1e-6, 1e-12, -1e-12])
def test_a_grazing_sine_breaks_away_where_it_passes_the_limit(contact: Any, excess: float) -> None:
    """A slow force A sin(ωt + φ) on a stuck axis: rigid, |F| = A |sin|; a yielding contact answers in closed form."""
    axis = paper_axis(contact)
    rng = random.Random(f'{excess}')
    with mpmath.workdps(50):
        limit = mpf(axis.normal_force) * mpf(0.24)
        # from a phase at which it is small, so that the first peak comes after the ringing of the start is over
        phase, frequency = rng.uniform(-0.2, 0.2), 0.05
        omega = 2 * mpmath.pi * mpf(frequency)
        gain = contact_gain(axis, omega)
        amplitude = float(limit / abs(gain) * (1 + mpf(excess)))
        assert (amplitude * abs(gain) > limit) == (excess > 0)
        force = InputProfile((0.0,), (0.0,), (0.0,), NEVER, (Sinusoid(amplitude, frequency, phase),))
        run = simulate(axis, InitialState(), constant(0.0), force, 8.0)
        assert [e.kind for e in run.events[:1]] == ([EventKind.BREAKAWAY] if excess > 0 else [])
        if run.events:
            want = (mpmath.asin(limit / (amplitude * abs(gain))) - mpf(phase) - mpmath.arg(gain)) / omega
            assert abs(run.exact[0].time - want) < mpf(10) ** -20


def contact_gain(axis: Axis, omega: mpf) -> Any:
    """Return contact force over external force at a frequency."""
    if isinstance(axis.contact, RigidContact):
        return mpmath.mpc(1)
    s = mpmath.mpc(0, omega)
    held = mpf(axis.contact.stiffness) + mpf(axis.contact.damping) * s
    return held / (mpf(axis.mass) * s * s + mpf(axis.drive_damping) * s + mpf(axis.drive_stiffness) + held)


# ---- periods, end slope, laws, long rests -------------------------------------------------------------


def test_a_period_is_the_profile_written_out() -> None:
    there = steps('drive', [0.0, 0.25], [0.004, -0.001], 0.75)
    back = table('force', [0.0, 0.125], [0.0, 100.0], 0.5)
    long = steps('drive', [n * 0.75 + t for n in range(4) for t in (0.0, 0.25)], [0.004, -0.001] * 4)
    slow = table('force', [n * 0.5 + t for n in range(6) for t in (0.0, 0.125)], [0.0, 100.0] * 6)
    axis = paper_axis(COMPLIANT)
    periodic, written = (simulate(axis, InitialState(), *inputs, 2.6) for inputs in ((there, back), (long, slow)))
    assert len(periodic.events) == 5
    assert [e.kind for e in periodic.events] == [e.kind for e in written.events]
    with mpmath.workdps(40):
        # the rates of the table are the same doubles
        assert max(abs(a.time - b.time) for a, b in zip(periodic.exact, written.exact)) < mpf(10) ** -30


def test_the_end_slope_is_a_linear_damping() -> None:
    """2 u' = −16 (0.25 + 3 u) with neither spring nor damper: the stop at (m / N k) ln(1 + k u_0 / mu)."""
    axis = coulomb_axis(KineticTable((0.0,), (0.25,), 3.0), 0.0, 0.0)
    run = simulate(axis, InitialState(velocity=0.5), constant(0.0), constant(0.0), 1.0)
    with mpmath.workdps(40):
        assert abs(run.exact[0].time - mpmath.log(1 + 3 * mpf(0.5) / mpf(0.25)) / 24) < mpf(10) ** -29
    assert run.final.mode == Mode.STICK


@pytest.mark.parametrize('kind', StaticLawKind)
@pytest.mark.parametrize('contact', ['rigid', 'compliant'])
def test_every_static_law_breaks_away_at_its_limit(kind: StaticLawKind, contact: str) -> None:
    law = {'law': kind.name.lower(), 'initial': 0.12, 'limit': 0.15, 'time_constant': 0.2, 'exponent': 0.7}
    parameters = paper(contact=contact)
    parameters['friction']['static'] = law
    parameters['friction']['kinetic']['end_slope'] = 0.01
    parameters['initial']['rest_time'] = 0.05
    run = exact_run(parameters, 1.5, 30)
    assert [e.kind for e in run].count('breakaway') >= 2
    assert violations(run, parameters, [0.01 + 0.06 * k for k in range(25)]) == []


def test_a_year_of_rest_is_a_few_steps() -> None:
    """Held at 500 N the yielding contact ends in balance, c_c δ = 500 − c x, and breaks away at the jump to come."""
    year = 31557600.0
    force = steps('force', [0.0, year], [500.0, -900.0])
    run = simulate(paper_axis(COMPLIANT), InitialState(), constant(0.0), force, year + 0.05)
    assert len(run.exact.stretches) < 2000
    with mpmath.workdps(50):
        held = run.exact.state_at([year - 1.0])[0]
        assert abs(held.position - mpf(500) / mpf(5.6e6)) < mpf(10) ** -33
    assert run.events[0].second == year
    assert 0.0 < run.events[0].fraction < 0.05


# ---- the door -----------------------------------------------------------------------------------------


def test_events_are_the_nearest_floats() -> None:
    run = simulate(paper_axis(COMPLIANT), InitialState(position=0.1), constant(0.002), constant(0.0), 2.5)
    assert len(run.events) > 8
    for event, exact in zip(run.events, run.exact):
        time = as_fraction(exact.time)
        assert event.second == time // 1
        assert event.fraction == float(time % 1)
        assert event.position == float(as_fraction(exact.position))
        assert event.drive_position == float(as_fraction(exact.drive_position))
        assert event.friction_force == float(as_fraction(exact.friction_force))
        assert 0.0 <= event.fraction < 1.0
    assert run.final.drive_position == pytest.approx(0.105, rel=1e-15)


def test_a_time_that_rounds_to_a_whole_second_is_that_second() -> None:
    with mpmath.workdps(40):
        assert split(mpf(3) - mpf(10) ** -30) == (3.0, 0.0)


def as_fraction(number: mpf) -> Fraction:
    sign, mantissa, exponent, _ = number._mpf_
    size = Fraction(int(mantissa)) * Fraction(2) ** exponent
    return Fraction(-size if sign else size)


def test_what_cannot_be_simulated_is_refused() -> None:
    axis = paper_axis(RIGID)
    with pytest.raises(InputError, match='duration'):
        simulate(axis, InitialState(), constant(0.0), constant(0.0), math.nan)
    with pytest.raises(InputError, match='digits'):
        simulate(axis, InitialState(), constant(0.0), constant(0.0), 1.0, digits=10)


def test_missing_mpmath_is_one_line(in_a_process: Program) -> None:
    program = f'''
import sys
sys.modules['mpmath'] = None
from stickslip_sim.axis import InitialState
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.errors import {StickslipError.__name__}
from stickslip_sim.reference import simulate
from tests.support.axes import RIGID, paper_axis
try:
    simulate(paper_axis(RIGID), InitialState(), constant(0.0), constant(0.0), 1.0)
except StickslipError as error:
    print(error, error.exit_code)
'''
    said = in_a_process(program, compiled=False)
    assert 'pip install mpmath' in said
    assert said.split()[-1] == '2'
