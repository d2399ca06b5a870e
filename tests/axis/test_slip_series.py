# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The power series of a slip under a normal force that varies, and of a contact that yields: against 50 digits."""

import math
import random
from typing import Any

import pytest

from stickslip_sim.axis import Friction, slip_series
from stickslip_sim.axis.codes import ACCELERATING, DECELERATING, YIELDING
from stickslip_sim.axis.friction_segments import kinetic_at_rest, slip_friction
from stickslip_sim.axis.layout import Parameters
from stickslip_sim.axis.motion import begin_motion, drive_travel
from stickslip_sim.axis.rows import Sinusoids
from stickslip_sim.axis.sinusoids import load_sinusoids
from stickslip_sim.axis.slip_series import series_deflection, series_travel
from stickslip_sim.axis.smooth_load import begin_load, normal_force_at
from stickslip_sim.axis.state_record import State
from stickslip_sim.friction import KineticTable
from tests.support.plain_axes import COMPLIANT, STATIC, parameters

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
@pytest.mark.parametrize('seed', range(10))
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
    """Return what the velocity, and the deflection, are off by at the ends of ten segments, of the bound.

    The polynomials are evaluated without rounding.
    """
    found = []
    for seed in range(10):
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
    p, s = made_up(3, DECELERATING)
    t = 0.125
    n, rate = normal_force_at(p, s, t)
    expected = s.inputs.base_n + p.normal_rate * t + sum(
        one.n * math.sin(2.0 * math.pi * (one.turns + one.frequency * t)) for one in s.sinusoids)
    assert n == pytest.approx(expected, rel=1e-13)
    later, _ = normal_force_at(p, s, t + 1e-6)
    earlier, _ = normal_force_at(p, s, t - 1e-6)
    assert rate == pytest.approx((later - earlier) / 2e-6, rel=1e-6)
