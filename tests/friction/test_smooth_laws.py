# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Smooth laws as tables: the stated error holds at every speed, and the motion follows the smooth law as measured."""

import math
import random
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import mpmath as mp
import pytest

from benchmarks.smooth_tables import (
    CASES,
    FEED,
    LAW,
    SmoothEvent,
    SmoothRun,
    axis_of,
    breakpoints_on_the_curve,
    compared,
    smooth_events,
)
from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from stickslip_sim.core.errors import InputError, UnsoundError
from stickslip_sim.core.input_profile import ramp
from stickslip_sim.core.types import EventKind, Instant
from stickslip_sim.friction import (
    KineticTable,
    SmoothExcess,
    SmoothKinetic,
    StaticLaw,
    StaticLawKind,
    excess_table,
    kinetic,
    kinetic_table,
)
from stickslip_sim.friction.kinetic import MAX_BREAKPOINTS, default_excess
from stickslip_sim.friction.smooth import cosine, exponential, hyperbolic, power, stribeck
from stickslip_sim.inputs import load_scene
from stickslip_sim.proof.axes import random_axis, random_profiles
from stickslip_sim.proof.closed_form import exact_static_coefficient
from stickslip_sim.scene import scene_from_values
from stickslip_sim.simulation.simulator import Simulator
from tests.support.axes import COMPLIANT, RIGID, instant, run_events
from tests.support.scene_files import refusal

KINETIC = [
    stribeck(0.12, 0.05, 0.015), stribeck(0.12, 0.05, 0.015, 0.4), stribeck(0.12, 0.05, 0.015, 0.0, 0.5),
    stribeck(0.3, 0.1, 1e-5, 0.0, 1.001), stribeck(0.3, 0.1, 2.0, 1e-6, 0.2), stribeck(0.3, 0.0, 0.1, 0.0, 20.0),
    stribeck(0.05, 0.12, 0.015), exponential(0.12, 0.05, 0.015), exponential(0.12, 0.05, 0.015, 1.0),
    hyperbolic(0.12, 0.0, 0.015), hyperbolic(0.12, 0.05, 0.015, 0.1),
]
EXCESS = [cosine(0.035), power(0.035, 2.0), power(0.1, 1.01), power(0.1, 1.0000001), power(0.1, 1.5), power(0.1, 20.0)]
TOLERANCES = [0.5, 0.01, 1e-3, 1e-5]
C = 30.0   # s of the worst event per unit of tolerance, for tolerances from 1e-3 on; measured: at most 23


def _speeds(last: float) -> list[float]:
    """Return speeds that no construction knows, up to and far beyond the last breakpoint."""
    inside = [last * (k + 0.5 * math.sqrt(2.0)) / 3000 for k in range(3000)]
    return [0.0, *(last * 1e-9 ** (k / 500) for k in range(500)), *inside, *(last * 10.0 ** k for k in range(1, 12))]


@pytest.mark.parametrize('tolerance', TOLERANCES)
@pytest.mark.parametrize('law', KINETIC)
def test_a_kinetic_table_has_its_stated_error_at_every_speed(law: SmoothKinetic, tolerance: float) -> None:
    table = kinetic_table(law, tolerance)
    assert table.error <= tolerance
    assert table.coefficients[0] == law.initial
    worst = 0.0
    for speed in _speeds(table.velocities[-1]):
        rounding = 1e-15 * (law.initial + law.limit + law.viscous * speed)
        difference = abs(table.coefficient(speed) - law.coefficient(speed))
        assert difference <= table.error + rounding, speed
        worst = max(worst, difference - rounding)
    assert worst == pytest.approx(table.error, rel=0.02)
    assert min(table.coefficients) >= 0.0
    assert table.law is law


@pytest.mark.parametrize('tolerance', TOLERANCES)
@pytest.mark.parametrize('law', EXCESS)
def test_an_excess_table_has_its_stated_error_at_every_speed(law: SmoothExcess, tolerance: float) -> None:
    table = excess_table(law, tolerance)
    assert table.error <= tolerance
    assert (table.fractions[0], table.fractions[-1]) == (1.0, 0.0)
    assert all(a > b for a, b in pairwise(table.fractions))
    worst = max(abs(table.fraction(speed) - law.fraction(speed)) for speed in _speeds(table.velocities[-1]))
    assert worst <= table.error + 1e-15
    assert worst == pytest.approx(table.error, rel=0.02)


@pytest.mark.parametrize('law', [*KINETIC, *EXCESS])
def test_the_slope_of_a_law_is_its_derivative(law: SmoothKinetic | SmoothExcess) -> None:
    value = law.coefficient if isinstance(law, SmoothKinetic) else law.fraction
    scale = law.stribeck_velocity if isinstance(law, SmoothKinetic) else law.limit_velocity
    for z in (0.03, 0.4, 0.6, 0.93):
        w, step = z * scale, 1e-5 * scale
        assert law.slope(w) * scale == pytest.approx((value(w + step) - value(w - step)) / 2e-5, rel=1e-5, abs=1e-9)


@pytest.mark.parametrize('law', [KINETIC[0], KINETIC[1], exponential(0.12, 0.05, 0.015)])
def test_breakpoints_grow_with_the_root_of_the_tolerance_and_off_the_curve_they_are_fewer(law: SmoothKinetic) -> None:
    coarse, fine = (len(kinetic_table(law, tolerance).velocities) for tolerance in (1e-4, 1e-6))
    assert 8.0 < fine / coarse < 10.5


def test_the_error_has_almost_no_mean() -> None:
    """Over the falling part; with those on the curve it would be two thirds of the tolerance, of changing sign."""
    for tolerance in (1e-4, 1e-5, 1e-6):
        table = kinetic_table(LAW, tolerance)
        assert table.error == pytest.approx(tolerance, rel=2e-3)
        assert abs(_mean(table, LAW.inflection * 1.2, 2.0 * LAW.stribeck_velocity)) < 0.08 * tolerance
        on_the_curve = breakpoints_on_the_curve(tolerance)
        assert _mean(on_the_curve, LAW.inflection * 1.2, 2.0 * LAW.stribeck_velocity) > 0.5 * tolerance


def _mean(table: KineticTable, low: float, high: float) -> float:
    speeds = [low + (high - low) * (k + 0.5) / 20_000 for k in range(20_000)]
    return math.fsum(table.coefficient(w) - LAW.coefficient(w) for w in speeds) / len(speeds)


def test_a_law_without_a_falling_part_is_a_line() -> None:
    table = kinetic_table(stribeck(0.1, 0.1, 0.01, 0.5), 1e-9)
    assert (table.velocities, table.coefficients, table.end_slope, table.error) == ((0.0,), (0.1,), 0.5, 0.0)


@pytest.mark.parametrize('tolerance', [1e-7, 1e-9, 1e-300])
def test_a_tolerance_that_needs_too_many_breakpoints_is_refused_with_one_that_fits(tolerance: float) -> None:
    law = stribeck(0.3, 0.1, 0.01, 0.0, 0.5)
    error = refusal(kinetic_table, law, tolerance)
    assert error.name == 'friction.kinetic.tolerance'
    fits = float(error.fix.removesuffix(' fits'))
    assert 0.9 * MAX_BREAKPOINTS < len(kinetic_table(law, fits).velocities) <= MAX_BREAKPOINTS


@pytest.mark.parametrize(('law', 'tolerance', 'name'), [
    (stribeck(1e8, 1e8 - 1e-7, 0.1), 1e-9, 'tolerance'), (stribeck(0.12, 0.05, 1e308), 1e-3, 'stribeck_velocity'),
    (stribeck(0.12, 0.05, 5e-324), 1e-3, 'stribeck_velocity'), (LAW, 0.0, 'tolerance'), (LAW, math.nan, 'tolerance'),
    (LAW, math.inf, 'tolerance'),
])
def test_tables_beyond_the_range_of_numbers_are_refused(law: SmoothKinetic, tolerance: float, name: str) -> None:
    assert refusal(kinetic_table, law, tolerance).name == f'friction.kinetic.{name}'


@pytest.mark.parametrize(('make', 'arguments', 'name'), [
    (stribeck, (-0.1, 0.05, 0.01), 'kinetic.initial'), (stribeck, (0.1, math.inf, 0.01), 'kinetic.limit'),
    (stribeck, (0.1, 0.05, 0.0), 'kinetic.stribeck_velocity'), (stribeck, (0.1, 0.05, 0.1, -1.0), 'kinetic.viscous'),
    (stribeck, (0.1, 0.05, 0.1, 0.0, 0.1), 'kinetic.exponent'), (cosine, (0.0,), 'excess.limit_velocity'),
    (stribeck, (0.1, 0.05, 0.1, 0.0, math.nan), 'kinetic.exponent'), (power, (0.1, 1.0), 'excess.exponent'),
])
def test_laws_without_a_meaning_are_refused(make: Callable[..., object], arguments: tuple[float, ...],
                                            name: str) -> None:
    with pytest.raises(InputError) as caught:
        make(*arguments)
    assert caught.value.name == f'friction.{name}'


def test_the_branches_meet_where_one_percent_is_left_at_any_tolerance() -> None:
    for law in KINETIC:
        meets = {default_excess(kinetic_table(law, tolerance)).velocities[-1] for tolerance in (1e-2, 1e-3, 1e-4)}
        assert meets == {law.limit_velocity}
        left = law.coefficient(law.limit_velocity) - law.viscous * law.limit_velocity - law.limit
        assert left == pytest.approx(0.01 * (law.initial - law.limit), rel=1e-9)


def test_the_smooth_reference_reproduces_the_check_values_of_the_model() -> None:
    """Its law may be any function; with the paper's straight line it must give docs' 40-digit events."""
    for contact, expected in (
            (RIGID, [0.67979883333333, 0.76770114503556598, 0.79961346115854196, 0.83862368925988008]),
            (COMPLIANT, [0.76256755048235998, 0.850707630222697, 0.88805371587200703, 0.92738519742899923])):
        line = KineticTable((0.0, 0.035), (0.12, 0.05))
        psi = default_excess(line)
        events = SmoothRun(axis_of(line, contact, True), FEED, line.coefficient, psi.fraction).advance(1.0)
        assert [event.kind for event in events] == [EventKind.BREAKAWAY, EventKind.COAST, EventKind.DECELERATE,
                                                    EventKind.STICK]
        assert [event.time for event in events] == pytest.approx(expected, rel=0.0, abs=1e-12)


@pytest.fixture(scope='module', params=CASES, ids=lambda case: f'{type(case[0]).__name__}-{case[1]}')
def case(request: pytest.FixtureRequest) -> tuple[RigidContact | CompliantContact, bool, list[SmoothEvent]]:
    contact, branches = request.param
    return contact, branches, smooth_events(contact, branches)


def test_the_error_of_the_motion_falls_with_the_tolerance(
        case: tuple[RigidContact | CompliantContact, bool, list[SmoothEvent]]) -> None:
    contact, branches, smooth = case
    times = {}
    for tolerance in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        result = compared(smooth, contact, branches, kinetic_table(LAW, tolerance))
        assert result.same
        assert result.time < C * tolerance
        assert result.position < 0.01 * C * tolerance   # m
        times[tolerance] = result.time
    order = math.log(times[1e-4] / times[1e-7]) / math.log(1e3)
    assert 0.9 < order < 1.8


def test_breakpoints_on_the_curve_are_more_and_worse(
        case: tuple[RigidContact | CompliantContact, bool, list[SmoothEvent]]) -> None:
    contact, branches, smooth = case
    ours, theirs = kinetic_table(LAW, 1e-6), breakpoints_on_the_curve(1e-6)
    assert len(ours.velocities) < 0.85 * len(theirs.velocities)
    assert compared(smooth, contact, branches, ours).time < 0.2 * compared(smooth, contact, branches, theirs).time


def test_a_scene_with_smooth_laws() -> None:
    scene = load_scene('stribeck')
    kinetic, excess = scene.axis.friction.kinetic, scene.axis.friction.excess
    assert kinetic.law == stribeck(0.12, 0.05, 0.015, 0.1)
    assert 0.5e-4 < kinetic.error <= 1e-4
    assert excess is not None
    assert excess.velocities == (0.0, 0.015 * math.sqrt(math.log(100.0)))
    curved = load_scene('stribeck', {'friction.excess.law': 'power', 'friction.excess.exponent': 3.0,
                                     'friction.kinetic.law': 'exponential', 'friction.kinetic.tolerance': 1e-3}).axis
    assert curved.friction.kinetic.law == exponential(0.12, 0.05, 0.015, 0.1)
    assert curved.friction.excess is not None
    assert curved.friction.excess.law == power(exponential(0.12, 0.05, 0.015).limit_velocity, 3.0)
    given = load_scene('paper_fig8', {'friction.excess.law': 'cosine', 'friction.excess.limit_velocity': 0.02})
    assert given.axis.friction.excess == excess_table(cosine(0.02), 1e-3)
    assert load_scene('paper_fig8', {'friction.excess.law': 'cosine'}).axis.friction.excess == excess_table(
        cosine(0.035), 1e-3)


def test_an_override_of_the_branches_takes_the_shape_of_the_excess_with_it() -> None:
    base = {'friction.acceleration_dependence': True, 'friction.excess.law': 'power', 'friction.excess.exponent': 2.0,
            'friction.excess.limit_velocity': 0.1}
    scene = scene_from_values(base)
    assert scene.axis.friction.excess is not None
    error = refusal(scene_from_values, {**scene.values, 'friction.acceleration_dependence': False})
    assert error.name == 'friction.excess.law'


def test_a_law_changes_on_the_way() -> None:
    """At an instant of stick nothing happens at once; from then on the motion is that of the new law."""
    scene = load_scene('stribeck')
    slower = scene_from_values({**scene.values, 'friction.kinetic.stribeck_velocity': 0.005})
    simulator = Simulator(scene.axis, scene.initial, scene.drive, scene.force)
    simulator.advance(instant(0.5))
    simulator.change_axis(slower.axis)
    changed = [e for e in simulator.advance(instant(0.9)) if e.kind != EventKind.KNOT]
    whole = Simulator(slower.axis, slower.initial, slower.drive, slower.force).advance(instant(0.9))
    same = [e for e in whole if e.kind != EventKind.KNOT]
    assert [e.kind for e in changed] == [e.kind for e in same]
    assert [e.time for e in changed] == pytest.approx([e.time for e in same], rel=1e-10)


# The exact break-away of every static law against 50-digit roots: rigid contact, a growing force, any rest before.

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

    step = mp.mpf(1) / 128
    before = mp.mpf(0)
    while beyond(before + step) < 0:
        before += step
    return mp.findroot(beyond, (before, before + step), solver='anderson', tol=1e-80, maxsteps=200)


@pytest.mark.parametrize(('rest', 'speed', 'rate', 'push'), [
    (0.0, 0.002, 0.0, 0.0), (0.0, 0.0, 0.003, 0.0), (0.05, 0.0005, 0.001, 120.0), (3.0, 0.0, 0.003, 0.0),
    (math.inf, 0.002, 0.0, 0.0)])
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
    """Return how many of 150 runs contradict themselves."""
    count = 0
    for seed in range(150):
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
