# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The exact break-away of every static law against 50-digit roots: rigid contact, a growing force, any rest before."""

import math
import random
from dataclasses import replace

import mpmath as mp
import pytest

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.core.errors import InputError, UnsoundError
from stickslip_sim.core.input_profile import ramp
from stickslip_sim.core.types import EventKind, Instant
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind, kinetic
from stickslip_sim.proof.axes import random_axis, random_profiles
from stickslip_sim.proof.closed_form import exact_static_coefficient
from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import RIGID, run_events

NORMAL, STIFFNESS, DAMPING = 3432.3275, 6e5, 4000.0
KIND = StaticLawKind
LAWS = [
    StaticLaw(KIND.CONSTANT, 0.2, 0.2), StaticLaw(KIND.EXPONENTIAL, 0.12, 0.24, 0.2),
    StaticLaw(KIND.EXPONENTIAL, 0.12, 0.24, 20.0), StaticLaw(KIND.KATO, 0.12, 0.24, 0.2, 0.4),
    StaticLaw(KIND.KATO, 0.12, 0.24, 0.2, 0.9), StaticLaw(KIND.KATO, 0.12, 0.24, 0.3, 1.5),
    StaticLaw(KIND.KATO, 0.12, 0.24, 0.6, 4.0), StaticLaw(KIND.HYPERBOLIC, 0.12, 0.24, 0.2),
    StaticLaw(KIND.LOGARITHMIC, 0.12, 0.13, 0.01), StaticLaw(KIND.LOGARITHMIC, 0.01, 0.03, 1.0),
]


def break_away(law: StaticLaw, rest: float, speed: float, rate: float, push: float) -> mp.mpf:
    """Return the first t at which c (v t + a t²/2) + h (v + a t) + f t reaches N mu_s(rest + t)."""
    v, a, f = mp.mpf(speed), mp.mpf(rate), mp.mpf(push)

    def beyond(t: mp.mpf) -> mp.mpf:
        force = STIFFNESS * (v * t + a * t * t / 2) + DAMPING * (v + a * t) + f * t
        return force - mp.mpf(NORMAL) * exact_static_coefficient(law, mp.mpf(rest) + t)

    step = mp.mpf(1) / 512
    before = mp.mpf(0)
    while beyond(before + step) < 0:
        before += step
    return mp.findroot(beyond, (before, before + step), solver='anderson', tol=1e-80, maxsteps=200)


@pytest.mark.parametrize(('speed', 'rate', 'push'), [(0.002, 0.0, 0.0), (0.0, 0.003, 0.0), (0.0005, 0.001, 120.0)])
@pytest.mark.parametrize('rest', [0.0, 0.05, 3.0, math.inf])
@pytest.mark.parametrize('law', LAWS)
def test_break_away_from_a_rigid_contact(law: StaticLaw, rest: float, speed: float, rate: float, push: float) -> None:
    if math.isinf(rest) and not law.bounded:
        rest = 1e6
    friction = Friction(law, KineticTable((0.0,), (law.initial,)), None)
    axis = Axis(350.0, STIFFNESS, DAMPING, NORMAL, RIGID, friction)
    with mp.workdps(50):
        expected = break_away(law, rest, speed, rate, push)
        limit = exact_static_coefficient(law, mp.mpf(rest) + expected)
    events = run_events(axis, ramp(speed, rate, math.inf), float(expected) + 1e-3, ramp(0.0, push, math.inf),
                        InitialState(rest_time=rest))
    first = events[0]
    assert first.kind == EventKind.BREAKAWAY
    assert abs(mp.mpf(first.second) + mp.mpf(first.fraction) - expected) <= 1e-12 * expected
    assert abs(first.static_coefficient - limit) <= 1e-12 * limit
    assert first.rest_time == pytest.approx(rest + float(expected), rel=1e-12)
    assert first.drive_force + push * first.time == pytest.approx(float(NORMAL * limit), rel=1e-12)


@pytest.mark.parametrize('law', LAWS)
def test_the_laws_equal_their_formulas(law: StaticLaw) -> None:
    for age in (0.0, 1e-9, 1e-3, 0.1, 1.0, 10.0, 1e4):
        with mp.workdps(50):
            expected = exact_static_coefficient(law, mp.mpf(age))
        assert abs(law.coefficient(age) - expected) <= 1e-15 * max(expected, 1e-3)


@pytest.mark.parametrize('law', LAWS)
def test_a_stiff_contact_breaks_away_as_a_rigid_one(law: StaticLaw) -> None:
    """The compliant search is another one: with c_c → ∞ its break-away tends to that of the rigid contact."""
    friction = Friction(law, KineticTable((0.0,), (law.initial,)), None)
    times = []
    for contact in (RIGID, CompliantContact(6e14, 3e8)):
        axis = Axis(350.0, STIFFNESS, DAMPING, NORMAL, contact, friction)
        times.append(run_events(axis, 0.002, 2.0, 0.0, InitialState(rest_time=0.05))[0].time)
    assert times[1] == pytest.approx(times[0], rel=1e-5)


# Friction that jumps between two breakpoints close together: refused, or followed soundly.

def with_a_jump(axis: Axis, rng: random.Random, distance: float) -> Axis:
    """Return the axis with another breakpoint a little faster than one of its own, of any coefficient."""
    table = axis.friction.kinetic
    k = rng.randrange(1, len(table.velocities))
    speeds, coefficients = [*table.velocities], [*table.coefficients]
    speeds.insert(k + 1, speeds[k] * (1.0 + distance))
    coefficients.insert(k + 1, rng.choice((0.0, 1.0, rng.random())))
    changed = kinetic.KineticTable(tuple(speeds), tuple(coefficients))
    excess = axis.friction.excess and kinetic.default_excess(changed)
    return replace(axis, friction=replace(axis.friction, kinetic=changed, excess=excess))


def unsound_runs(distance: float) -> int:
    """Return how many of 300 runs contradict themselves."""
    count = 0
    for seed in range(300):
        rng = random.Random(seed)
        axis, (drive, force) = with_a_jump(random_axis(rng), rng, distance), random_profiles(rng)
        simulator = Simulator(axis, InitialState(), drive, force, accounting=True)
        try:
            simulator.advance(Instant(3.0, 0.0))
            simulator.require_sound()
        except UnsoundError:
            count += 1
    return count


def test_what_is_not_refused_is_sound() -> None:
    assert unsound_runs(1.1e-8) == 0


def test_nearer_ones_are_refused() -> None:
    """Of runs with a distance of 1e-11 about a tenth contradict themselves."""
    with pytest.raises(InputError, match=r'at least .* m/s apart, 1e-08 of the speed; they are .* m/s apart'):
        unsound_runs(0.9e-8)
