# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The power series of a slip under a normal force that varies, and of a contact that yields: against 50 digits."""

import math
import random
from dataclasses import replace
from typing import Any

import pytest

from stickslip_sim.axis import Friction, slip_series
from stickslip_sim.axis.codes import (
    ACCELERATE,
    ACCELERATING,
    ARREST,
    BREAKAWAY,
    COAST,
    COASTING,
    DECELERATE,
    DECELERATING,
    REVERSE,
    STICK,
    YIELDING,
)
from stickslip_sim.axis.forces import kinetic_at_rest, slip_friction
from stickslip_sim.axis.layout import Parameters
from stickslip_sim.axis.motion import begin_motion, drive_travel
from stickslip_sim.axis.rows import Sinusoids
from stickslip_sim.axis.sinusoids import load_sinusoids
from stickslip_sim.axis.slip_series import series_deflection, series_travel
from stickslip_sim.axis.smooth_load import begin_load, normal_force_at
from stickslip_sim.axis.state_record import State
from stickslip_sim.friction import KineticTable
from tests.support.plain_axes import COMPLIANT, FRICTION, SIDED, STATIC, applied, parameters, slip, state

mpmath = pytest.importorskip('mpmath')
mpf = mpmath.mpf
EPSILON = 2.0 ** -52


def made_up(seed: int, mode: float) -> tuple[Parameters, State]:
    """Return an axis and a state that moves by series: sizes over decades, tables that fall or rise, 0 to 3 sines."""
    rng = random.Random(seed)
    table = KineticTable((0.0, 0.5), (0.25, 0.25 * rng.uniform(0.0, 1.5)), rng.choice([0.0, 0.1]))
    contact: dict[str, Any] = {'contact': COMPLIANT} if mode == YIELDING else {}
    damping = rng.choice([0.0, 10 ** rng.uniform(-1.0, 2.0)])
    p = parameters(drive_stiffness=10 ** rng.uniform(0.0, 5.0), drive_damping=damping,
                   friction=Friction(STATIC, table, None), **contact)
    count = rng.randrange(4)
    p.normal_rate = rng.choice([0.0, 1.0]) * rng.uniform(-20.0, 20.0) if count else 20.0
    s = State(count)
    s.mode, s.direction, s.segment = mode, rng.choice([1.0, -1.0]), 0.0
    s.velocity = s.direction * rng.choice([0.0, 10 ** rng.uniform(-4.0, -0.4)])
    s.spring, s.deflection = rng.uniform(-0.02, 0.02), rng.uniform(-0.01, 0.01)
    s.second, s.fraction = float(rng.randrange(100)), rng.random()
    s.inputs.v, s.inputs.v_rate = rng.uniform(-0.1, 0.1), rng.choice([0.0, rng.uniform(-1.0, 1.0)])
    s.inputs.f, s.inputs.f_rate = rng.uniform(-5.0, 5.0), rng.choice([0.0, rng.uniform(-9.0, 9.0)])
    s.inputs.base_n = p.normal_force
    numbers = [(10 ** rng.uniform(-0.5, 2.0), rng.random(), rng.uniform(-0.05, 0.05), rng.uniform(-3.0, 3.0),
                rng.uniform(-15.0, 15.0)) for _ in range(count)]
    load_sinusoids(s, Sinusoids([number for row in numbers for number in row]))
    begin_load(p, s)
    s.acceleration = float(Flow(p, s).rates(mpf(0), mpf(s.spring), mpf(s.velocity), mpf(s.deflection))[1])
    begin_motion(p, s)
    return p, s


class Flow:
    """The equations of motion from a state on, in mpmath; they know nothing of series."""

    def __init__(self, p: Parameters, s: State) -> None:
        self.p, self.s = p, s
        self.steady, self.slope = slip_friction(p, s) if s.mode != YIELDING else (kinetic_at_rest(p, s.direction), 0.0)

    def rates(self, t: Any, w: Any, u: Any, delta: Any) -> tuple[Any, Any, Any]:
        p, s = self.p, self.s
        v, f = s.inputs.base_v + s.inputs.v_rate * t, s.inputs.base_f + s.inputs.f_rate * t
        n = s.inputs.base_n + p.normal_rate * t
        for one in s.sinusoids:
            sine = mpmath.sin(2 * mpmath.pi * (one.turns + mpf(one.frequency) * t))
            v, f, n = v + one.v * sine, f + one.f * sine, n + one.n * sine
        friction = n * (s.direction * mpf(self.steady) + mpf(self.slope) * u)
        force = p.stiffness * w + p.damping * (v - u) + f - friction
        yields = (friction - p.contact_stiffness * delta) / p.contact_damping if s.mode == YIELDING else mpf(0)
        return v - u, force / p.mass, yields

    def after(self, t: float) -> list[Any]:
        """Return w, u and the deflection at t, by Gragg, Bulirsch and Stoer's method to some 25 digits."""
        start = [mpf(self.s.spring), mpf(self.s.velocity), mpf(self.s.deflection)]
        table: list[list[Any]] = []
        for k in range(1, 18):
            row = [self._midpoint(start, mpf(t), 2 * k)]
            for j in range(1, k):
                ratio = mpf(k) / (k - j)
                row.append([a + (a - b) / (ratio * ratio - 1) for a, b in zip(row[-1], table[-1][j - 1])])
            table.append(row)
        last: list[Any] = table[-1][-1]
        return last

    def _midpoint(self, start: list[Any], t: Any, count: int) -> list[Any]:
        h = t / count
        before, now = start, [a + h * b for a, b in zip(start, self.rates(mpf(0), *start))]
        for k in range(1, count):
            before, now = now, [a + 2 * h * b for a, b in zip(before, self.rates(h * k, *now))]
        return [(a + b + h * c) / 2 for a, b, c in zip(before, now, self.rates(t, *now))]


@pytest.mark.parametrize('mode', [DECELERATING, ACCELERATING, YIELDING])
@pytest.mark.parametrize('seed', range(4))
def test_the_error_of_a_series_is_below_its_bound(seed: int, mode: float) -> None:
    """The bound holds, and is itself rounding of the velocities in the segment."""
    p, s = made_up(seed, mode)
    with mpmath.workdps(34):
        for share in (0.3, 1.0):
            t = share * s.series_end
            w, u, delta = Flow(p, s).after(t)
            y, velocity, acceleration = series_travel(s, t)
            rate = Flow(p, s).rates(mpf(t), w, u, delta)[1]
            scale = sum(abs(one.u) for one in s.series)
            assert abs(velocity - u) <= s.series_error + 4.0 * EPSILON * scale
            assert abs(acceleration - rate) * s.series_end <= s.series_error + 100.0 * EPSILON * scale
            slack = (s.series_error + 8.0 * EPSILON * scale) * s.series_end + 8.0 * EPSILON * abs(s.spring)
            assert abs(y - (s.spring - w + drive_travel(s, t))) <= slack
            if mode == YIELDING:
                slack = (s.series_error + 4.0 * EPSILON * scale) * s.series_end
                assert abs(series_deflection(s, t)[0] - delta) <= slack
    forces = p.stiffness * abs(s.spring) + p.damping * (abs(s.inputs.v) + scale) + abs(s.inputs.f) + p.normal_force
    size = scale + s.series_end / p.mass * (forces + 60.0) + abs(s.deflection) * 64.0
    assert s.series_error < 400.0 * EPSILON * size


def shares_of_the_bound(mode: float) -> tuple[list[float], list[float]]:
    """Return what the velocity, and the deflection, are off by at the ends of five segments, of the bound.

    The polynomials are evaluated without rounding.
    """
    found = []
    for seed in range(5):
        p, s = made_up(seed, mode)
        with mpmath.workdps(34):
            _, u, delta = Flow(p, s).after(s.series_end)
            found.append((float(abs(sum(mpf(one.u) for one in s.series) - u) / s.series_error),
                          float(abs(sum(mpf(one.deflection) for one in s.series) - delta)
                                / (s.series_error * s.series_end))))
    velocities, deflections = zip(*found)
    return list(velocities), list(deflections)


@pytest.mark.parametrize('mode', [DECELERATING, ACCELERATING, YIELDING])
@pytest.mark.parametrize('theta', [slip_series.THETA, 5.0], ids=['rounding', 'truncation'])
def test_a_thousandth_of_the_bound_would_be_none(theta: float, mode: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each part is needed: rounding in segments as they are, the orders left out in ones that are too long."""
    monkeypatch.setattr(slip_series, 'THETA', theta)
    if theta == 5.0:   # none is shortened
        monkeypatch.setattr(slip_series, 'velocity_scale', lambda _: math.inf)
    velocities, deflections = shares_of_the_bound(mode)
    assert 1e-3 < max(velocities) <= 1.0
    if mode == YIELDING:
        assert 1e-4 < max(deflections) <= 1.0


def test_the_normal_force_is_the_sum_of_its_parts() -> None:
    p, s = made_up(1, DECELERATING)
    assert (s.sinusoid_count, p.normal_rate != 0.0) == (3.0, True)
    t = 0.125
    n, rate = normal_force_at(p, s, t)
    expected = s.inputs.base_n + p.normal_rate * t + sum(
        one.n * math.sin(2.0 * math.pi * (one.turns + one.frequency * t)) for one in s.sinusoids)
    assert n == pytest.approx(expected, rel=1e-13)
    later, _ = normal_force_at(p, s, t + 1e-6)
    earlier, _ = normal_force_at(p, s, t - 1e-6)
    assert rate == pytest.approx((later - earlier) / 2e-6, rel=1e-6)


# An input or a parameter that jumps chooses the mode anew at that instant; docs/model.md, "Rules at the edges".

both_ways = pytest.mark.parametrize('direction', [1.0, -1.0])


@both_ways
@pytest.mark.parametrize(('push', 'kind', 'mode', 'gain', 'friction'), [
    (30.0, ACCELERATE, ACCELERATING, (30.0 - 24.0) / 2.0, 24.0), (20.0, COAST, COASTING, 0.0, 20.0),
    (12.5, COAST, COASTING, 0.0, 12.5), (11.0, DECELERATE, DECELERATING, (11.0 - 12.0) / 2.0, 12.0),
    (-9.0, DECELERATE, DECELERATING, (-9.0 - 12.0) / 2.0, 12.0)])
@pytest.mark.parametrize('before', [ACCELERATING, COASTING, DECELERATING])
def test_a_slip_takes_the_sub_mode_of_the_new_force(before: float, push: float, kind: float, mode: float, gain: float,
                                                    friction: float, direction: float) -> None:
    """At 0.125 m/s N mu_k = 12 N and N (mu_k + E psi) = 24 N; an event only where the mode changes."""
    p = parameters()
    s = slip(p, before, 0.125, direction=direction, push=push, excess=0.25)
    row = applied(p, s)
    assert (s.mode, s.acceleration, s.excess, s.direction) == (mode, direction * gain, 0.25, direction)
    assert s.velocity == direction * 0.125
    assert (row is None) == (mode == before)
    if row is not None:
        assert (row.kind, row.mode, row.direction, row.friction) == (kind, mode, direction, direction * friction)
        assert (row.static, row.rest) == (0.25, 0.0)
    if mode == COASTING:
        assert s.residual == push - 12.0


@both_ways
@pytest.mark.parametrize('rest', [math.inf, 2.0, 0.0])
def test_stick_holds_up_to_its_limit(rest: float, direction: float) -> None:
    """A force that stays exactly on the limit holds."""
    p = parameters()
    limit = 64.0 * {math.inf: 0.5, 2.0: 0.5 - 0.25 / math.e, 0.0: 0.25}[rest]
    for force in (0.0, 0.5 * limit, limit):
        s = state(mode=STICK, f=direction * force, rest=rest)
        assert applied(p, s) is None
        assert (s.mode, s.rest, s.velocity) == (STICK, rest, 0.0)
    s = state(mode=STICK, f=direction * (limit + 3.0), rest=rest)
    row = applied(p, s)
    assert row is not None
    assert (row.kind, row.mode, row.direction, row.rest) == (BREAKAWAY, ACCELERATING, direction, rest)
    assert (row.friction, s.acceleration) == pytest.approx((direction * limit, direction * 3.0 / 2.0), rel=1e-14)


@pytest.mark.parametrize(('force', 'holds'), [(16.0, True), (17.0, False), (-24.0, True), (-17.0, True),
                                              (-25.0, False)])
def test_each_direction_holds_as_much_as_its_own_limit(force: float, holds: bool) -> None:
    p = parameters(friction=SIDED)
    s = state(mode=STICK, f=force, rest=0.0)
    assert (applied(p, s) is None) is holds


@both_ways
def test_a_normal_force_that_falls_lets_go(direction: float) -> None:
    """N jumps from 64 N to 32 N: the limit is 16 N, and what the force is beyond it accelerates the slider."""
    s = state(mode=STICK, f=direction * 20.0, rest=math.inf)
    assert applied(parameters(), s) is None
    row = applied(parameters(normal_force=32.0), s)
    assert row is not None
    assert (row.kind, row.friction, s.acceleration) == (BREAKAWAY, direction * 16.0, direction * (20.0 - 16.0) / 2.0)


@both_ways
def test_a_compliant_contact_yields_to_a_jump(direction: float) -> None:
    """Its own force is below the limit, however strong the drive: m ẍ = F_d + F_e − F_c."""
    p = parameters(contact=COMPLIANT)
    s = state(mode=STICK, f=direction * 100.0, deflection=direction * 8.0 / 4096.0, velocity=direction * 0.0625,
              rest=math.inf)
    assert applied(p, s) is None
    assert s.acceleration == direction * (100.0 - 32.0 * 0.0625 - 8.0 - 64.0 * 0.0625) / 2.0
    assert (s.mode, s.deflection) == (STICK, direction * 8.0 / 4096.0)
    by_drive = parameters(contact=replace(COMPLIANT, ends_by_drive=True))
    row = applied(by_drive, s)
    assert row is not None
    assert (row.kind, row.direction, row.friction) == (BREAKAWAY, direction, direction * 32.0)


@both_ways
def test_a_slip_at_standstill_ends_or_turns_round(direction: float) -> None:
    """A velocity that is backwards by rounding alone counts as standstill."""
    p = parameters(friction=replace(FRICTION, static=replace(STATIC, initial=0.375)))
    for push, kind, mode in ((10.0, ARREST, STICK), (-20.0, ARREST, STICK), (-30.0, REVERSE, ACCELERATING)):
        s = slip(p, DECELERATING, 0.0, direction=direction, push=push, excess=0.25)
        s.velocity = -direction * 1e-18
        row = applied(p, s)
        assert row is not None
        assert (row.kind, row.mode, s.mode, s.velocity) == (kind, mode, mode, 0.0)
    s = slip(p, DECELERATING, 0.0, direction=direction, push=16.0 + 16.0 + 5.0, excess=0.25)
    row = applied(p, s)      # pushed on: the slip goes on
    assert row is not None
    assert (row.kind, s.mode, s.acceleration, s.direction) == (ACCELERATE, ACCELERATING, direction * 2.5, direction)


@both_ways
def test_steady_sliding_stays(direction: float) -> None:
    """ẋ = v within the band is an equilibrium."""
    p = parameters()
    for push in (12.0, 18.0, 24.0):
        s = slip(p, COASTING, 0.125, direction=direction, push=push, excess=0.25, v=direction * 0.125)
        assert applied(p, s) is None
        assert (s.mode, s.residual, s.velocity) == (COASTING, push - 12.0, direction * 0.125)
