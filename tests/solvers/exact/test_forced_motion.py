# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs under sines, piece by piece against an integrator: the motion, every guard on the way, the event at its end."""

import math
import random
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stickslip_sim.axis import Axis, CompliantContact
from stickslip_sim.core.input_profile import InputProfile, constant
from stickslip_sim.core.types import Event, EventKind, Mode
from tests.support.axes import COMPLIANT, RIGID, make, paper_axis, random_axis
from tests.support.forced_profiles import random_profiles, with_sinusoids

pytestmark = pytest.mark.slow


class Piece:
    """The motion from one event to the next as the model states it."""

    def __init__(self, axis: Axis, drive: InputProfile, force: InputProfile, event: Event, excess: float,
                 deflection: float) -> None:
        self.axis, self.drive, self.force, self.event, self.excess = axis, drive, force, event, excess
        self.deflection = deflection
        self.compliant = axis.contact if isinstance(axis.contact, CompliantContact) else None
        self.rest0 = event.rest_time if event.kind is EventKind.BREAKAWAY else 0.0

    def residual(self, t: float, x: float, u: float, s: float) -> float:
        """Return F_d + F_e."""
        a = self.axis
        return (a.drive_stiffness * (s - x) + a.drive_damping * (self.drive.value_at(t) - u) + self.force.value_at(t))

    def friction(self, u: float, *, upper: bool) -> float:
        kinetic, excess = self.axis.friction.kinetic, self.axis.friction.excess
        w = abs(u)
        mu = float(np.interp(w, kinetic.velocities, kinetic.coefficients))
        mu += kinetic.end_slope * max(w - kinetic.velocities[-1], 0.0)
        if upper and excess is not None:
            mu += self.excess * float(np.interp(w, excess.velocities, excess.fractions))
        return self.axis.normal_force * mu

    def contact(self, x: float, u: float) -> float:
        assert self.compliant is not None
        return self.compliant.stiffness * (self.deflection + x) + self.compliant.damping * u

    def acceleration(self, t: float, x: float, u: float, s: float) -> float:
        mode, direction = self.event.mode, self.event.direction
        if mode is Mode.COASTING or (mode is Mode.STICK and self.compliant is None):
            return 0.0
        if mode is Mode.STICK:
            return (self.residual(t, x, u, s) - self.contact(x, u)) / self.axis.mass
        friction = self.friction(u, upper=mode is Mode.ACCELERATING)
        return (self.residual(t, x, u, s) - direction * friction) / self.axis.mass

    def motion(self, end: float, s0: float, u0: float) -> Any:
        def rates(t: float, y: Any) -> list[float]:
            t = float(t)   # scipy hands over its own numbers
            return [y[1], self.acceleration(t, *map(float, y)), self.drive.value_at(t)]
        start = self.event.time
        breaks = [c + k * (profile.period if profile.period < math.inf else 0.0)
                  for profile in (self.drive, self.force) for c in profile.starts for k in range(4)]
        y, parts = [0.0, u0, s0], []
        for a, b in pairwise(sorted({start, end, *(t for t in breaks if start < t < end)})):
            part = solve_ivp(rates, (a, np.nextafter(b, 0.0)), y, method='DOP853', rtol=1e-12, atol=1e-15,
                             max_step=0.01, dense_output=True)
            y = part.y[:, -1]
            parts.append(part)
        return parts

    def check_guards(self, t: float, y: Any, slack: float) -> None:
        """Assert that no guard was passed; `slack` N."""
        mode, direction = self.event.mode, self.event.direction
        x, u, s = y
        force = self.residual(t, x, u, s)
        if mode is Mode.STICK:
            held = self.contact(x, u) if self.compliant else force
            limit = self.axis.normal_force * self.axis.friction.static.coefficient(self.rest0 + t - self.event.time)
            assert abs(held) <= limit + slack
            return
        assert direction * u >= -1e-9
        if mode is Mode.COASTING:
            assert direction * force >= self.friction(u, upper=False) - slack
            assert direction * force <= self.friction(u, upper=True) + slack
        else:
            sense = 1.0 if mode is Mode.ACCELERATING else -1.0
            assert sense * direction * self.axis.mass * self.acceleration(t, x, u, s) >= -slack


def follow(axis: Axis, drive: InputProfile, force: InputProfile, duration: float) -> int:
    """Check every piece of a run; return how many there were."""
    simulator = make(axis, drive, force)
    events = simulator.advance(simulator.time._replace(second=math.floor(duration), fraction=duration % 1.0))
    start = Event(0.0, 0.0, EventKind.STICK, Mode.STICK, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    excess, deflection, pieces = 0.0, 0.0, 0
    scale = axis.normal_force * 0.3
    for event, after in pairwise([start, *events]):
        if event.kind in (EventKind.BREAKAWAY, EventKind.REVERSE):
            table_ = axis.friction.excess
            psi = float(np.interp(abs(event.velocity), table_.velocities, table_.fractions)) if table_ else 0.0
            kinetic = axis.friction.kinetic
            mu = float(np.interp(abs(event.velocity), kinetic.velocities, kinetic.coefficients))
            excess = max(event.static_coefficient - mu, 0.0) / psi if psi > 0.0 else 0.0
        if event.mode is Mode.STICK:
            at_rest = axis.friction.kinetic.coefficients[0] * axis.normal_force * event.direction
            deflection = at_rest / axis.contact.stiffness if isinstance(axis.contact, CompliantContact) else 0.0
        piece = Piece(axis, drive, force, event, excess, deflection)
        if event is start:
            piece.rest0 = math.inf
        if after.time <= event.time:
            continue
        u0 = 0.0 if event.mode is Mode.STICK else event.velocity
        x0 = event.position
        parts = piece.motion(after.time, event.drive_position - x0, u0)
        for part in parts:
            times = np.linspace(part.t[0], part.t[-1], 60)
            for t, y in zip(times.tolist(), part.sol(times).T.tolist()):
                piece.check_guards(t, y, 1e-7 * scale)
        x, u, s = parts[-1].y[:, -1]
        assert x + x0 == pytest.approx(after.position, abs=1e-10)
        assert u == pytest.approx(after.velocity, abs=1e-9)
        assert s + x0 == pytest.approx(after.drive_position, abs=1e-10)
        pieces += 1
    return pieces


@pytest.mark.parametrize('seed', range(16))
def test_random_axes_under_random_sinusoids_follow_the_model(seed: int) -> None:
    rng = random.Random(seed)
    axis = random_axis(rng)
    drive, force = random_profiles(rng, axis)
    follow(axis, drive, force, 1.0)


@pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
def test_paper_axis_under_sinusoids_follows_the_model(contact: Any) -> None:
    drive = with_sinusoids(constant(0.002), (0.001, 3.0, 0.3))
    force = with_sinusoids(constant(0.0), (100.0, 20.0, 0.0), (50.0, 6.5896, 1.0))
    assert follow(paper_axis(contact), drive, force, 2.0) > 25
