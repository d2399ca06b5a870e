# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Classical results on stick-slip, and the paper's gaps: the exact engine against closed forms, docs against both."""

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise

import pytest

from benchmarks.classics import (
    DAMPING_RATIOS,
    DROP,
    EXACT,
    FEED,
    GROUPS,
    HEALING,
    LEINE_TOLERANCE,
    NORMAL,
    UNDAMPED,
    Result,
    coulomb_cycle,
    damped,
    den_hartog,
    forced_axis,
    grown,
    half_range,
    healing_axis,
    leine_cycle,
    shaken,
    sticks_again,
    turning_points,
)
from benchmarks.paper import DATA, PAGE, exact_slip, made, naive_slip
from stickslip_sim.axis import Axis, Friction, InitialState, RigidContact
from stickslip_sim.core.input_profile import constant, ramp
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.figures.cycles import cycle_figures
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.study.critical import critical_drop, critical_feed, healing_critical_feed
from tests.support.axes import RIGID, instant, of_kind, paper_axis, run_events

HEALING_FEED = healing_critical_feed(UNDAMPED.stiffness, NORMAL * 0.12 / HEALING.time_constant)   # m/s


@pytest.mark.parametrize('group', GROUPS, ids=lambda group: group.__name__)
def test_the_engine_has_the_classical_figures(group: Callable[[], list[Result]]) -> None:
    for result in group():
        assert result.found == pytest.approx(result.expected, rel=result.tolerance, abs=0.0), result.name


def test_the_closed_forms_have_the_published_figures() -> None:
    """Figures from the literature, to the digits they were given with."""
    cycle = coulomb_cycle(UNDAMPED, DROP, FEED)
    assert cycle.slip_time == pytest.approx(84.28583e-3, abs=5e-9)
    assert cycle.period == pytest.approx(0.3589525, abs=5e-8)
    assert cycle.peak_speed == pytest.approx(33.86702e-3, abs=5e-9)
    assert cycle.jump == pytest.approx(1.794762e-3, abs=5e-10)
    assert [round(critical_drop(zeta), 6) for zeta in DAMPING_RATIOS] == [0.365065, 1.470118, 2.724989]
    assert [round(den_hartog(r, f).amplitude, 6) for r, f in ((0.8, 0.5), (1.5, 0.3), (2.0, 0.2))] == [
        2.332235, 0.721110, 0.317980]


@pytest.mark.parametrize('zeta', DAMPING_RATIOS)
@pytest.mark.parametrize('margin', [1e-2, 1e-6, 1e-12])
def test_constant_friction_sticks_below_the_critical_feed_and_slides_above_it(zeta: float, margin: float) -> None:
    critical = critical_feed(damped(zeta), DROP)
    assert sticks_again(zeta, critical * (1.0 - margin))
    assert not sticks_again(zeta, critical * (1.0 + margin))


@pytest.mark.parametrize('kind', [StaticLawKind.EXPONENTIAL, StaticLawKind.HYPERBOLIC])
@pytest.mark.parametrize('share', [0.5, 0.9, 0.99, 1.01, 1.1, 2.0])
def test_growth_at_rest_keeps_stick_slip_up_below_its_critical_feed_only(kind: StaticLawKind, share: float) -> None:
    """Drops before and after a stick add up to c v t at any feed; above the critical one every drop is smaller.

    A slip after a drop D ends with ẋ falling by D/m only: rounding of the speed, ε v, is worth ε c m v²/D of force.
    """
    law, feed = replace(HEALING, kind=kind), share * HEALING_FEED
    cycles = cycle_figures(run_events(healing_axis(law), feed, 100.0))
    drops = [cycle.break_away_force - 0.12 * NORMAL for cycle in cycles]
    scale = feed * UNDAMPED.impedance   # N
    for (before, after), cycle in zip(pairwise(drops), cycles):
        rounding = 8.0 * sys.float_info.epsilon * (scale * scale / before + NORMAL)
        assert before + after == pytest.approx(UNDAMPED.stiffness * feed * cycle.stick_time, abs=rounding)
    if share < 1.0:
        assert drops[-1] == pytest.approx(grown(law, cycles[-1].rest_time), rel=EXACT)
        assert drops[-1] == pytest.approx(drops[-2], rel=1e-6)
        assert drops[-1] > 1e-3 * scale
    else:
        assert all(after < before for before, after in pairwise(drops) if before > 1e-5 * scale)
        assert drops[-1] < 1e-5 * scale


@pytest.mark.parametrize(('normal_force', 'grows'), [(1980.0, False), (2020.0, True)])
def test_steady_sliding_is_unstable_where_friction_falls_faster_than_the_damper_rises(
        normal_force: float, grows: bool) -> None:
    axis = paper_axis(RIGID, branches=False)
    axis = replace(axis, normal_force=normal_force)
    balance = normal_force * axis.friction.kinetic.coefficient(0.0175)
    events = run_events(axis, 0.0175, 100.0, balance, InitialState(velocity=0.0175 + 1e-3))
    assert bool(of_kind(events, EventKind.STICK)) == grows


@pytest.mark.parametrize(('ratio', 'friction', 'shift'), [
    (0.8, 0.5, 0.0), (1.5, 0.3, 0.0), (2.0, 0.2, 0.0), (0.5, 0.3, 0.0), (0.5, 0.3, 0.03), (0.5, 0.3, -0.02)])
def test_den_hartogs_oscillation_goes_on_from_its_own_start(ratio: float, friction: float, shift: float) -> None:
    """At w/ω = 1/2 a free swing of up to 1/3 − F/P on top shifts the motion for good, without a stop."""
    swing = den_hartog(ratio, friction)
    amplitude = swing.amplitude + shift
    turns = turning_points(forced_axis(friction), shaken(ratio, swing.phase, -amplitude), 20.5 * math.pi / ratio)
    assert {event.kind for event in turns} == {EventKind.REVERSE}
    assert [event.time for event in turns] == pytest.approx([k * math.pi / ratio for k in range(1, 21)], rel=EXACT)
    far = -2.0 * swing.amplitude   # the axis starts at 0, where its spring is unstretched
    assert [event.position for event in turns] == pytest.approx([far, 0.0] * 10, abs=EXACT * swing.amplitude)


@pytest.mark.parametrize('phase', [0.0, 1.0, 2.5])
def test_from_rest_den_hartogs_half_frequency_approaches_the_end_of_its_family(phase: float) -> None:
    """The family of w/ω = 1/2 ends where stops begin, at a shift of 1/3 − F/P: what is left of the way falls as 1/n."""
    turns = turning_points(forced_axis(0.3), shaken(0.5, phase), 4000.0 * 4.0 * math.pi)
    assert half_range(turns) == pytest.approx(4.0 / 3.0, rel=1e-6)
    assert abs(turns[-1].position + turns[-2].position) / 2.0 == pytest.approx(1.0 / 3.0 - 0.3, abs=2e-4)


@pytest.mark.parametrize(('ratio', 'friction'), [(0.5, 0.4), (0.3, 0.5), (0.8, 0.9), (0.5, 0.3)])
def test_forced_oscillations_with_stops_are_those_of_the_reference(ratio: float, friction: float) -> None:
    pytest.importorskip('mpmath')
    from stickslip_sim.reference import simulate
    axis, force, duration = forced_axis(friction), shaken(ratio, 0.7), 8.0 * math.pi / ratio
    events, expected = run_events(axis, 0.0, duration, force), simulate(axis, InitialState(), constant(0.0), force,
                                                                        duration).events
    assert [(e.kind, e.mode, e.direction) for e in events] == [(e.kind, e.mode, e.direction) for e in expected]
    assert of_kind(events, EventKind.STICK)
    for event, other in zip(events, expected):
        assert event.time == pytest.approx(other.time, abs=EXACT * duration)
        assert event.position == pytest.approx(other.position, abs=EXACT)


@pytest.mark.parametrize('tolerance', [1e-3, 1e-4, 1e-5, LEINE_TOLERANCE])
def test_leines_figures_are_off_by_no_more_than_the_table(tolerance: float) -> None:
    """In their units, per unit of friction; measured: at most 0.52."""
    for result in leine_cycle(tolerance):
        assert result.found == pytest.approx(result.expected, abs=tolerance), result.name


def test_a_coast_lasts_as_long_as_the_force_takes_through_the_band() -> None:
    """B/(c (w − v)), B = N E (1 − w/v_gr), in every slip of the paper's axis."""
    events = run_events(paper_axis(RIGID), 0.002, 10.0)
    band, coasts = 0.0, 0
    for event, following in pairwise(events):
        if event.kind == EventKind.BREAKAWAY:
            band = NORMAL * (event.static_coefficient - 0.12)
        if event.kind == EventKind.COAST:
            lasts = band * (1.0 - event.velocity / 0.035) / (6e5 * (event.velocity - 0.002))
            assert following.time - event.time == pytest.approx(lasts, rel=EXACT)
            coasts += 1
    assert coasts > 10


def test_switching_by_the_last_sign_of_acceleration_converges_to_another_motion() -> None:
    axis = paper_axis(RIGID)
    exact, coarse, fine = exact_slip(axis), naive_slip(1e-4, axis), naive_slip(1e-5, axis)
    assert fine.switches == pytest.approx(10 * coarse.switches, rel=0.01)
    assert fine.peak_speed == pytest.approx(coarse.peak_speed, rel=1e-3)
    assert fine.peak_speed > 1.2 * exact.peak_speed


@pytest.mark.parametrize('name', ['sensitivity', 'switching', 'classics', 'critical'])
def test_the_page_shows_what_is_measured_now(name: str, measured: tuple[dict[str, str], dict[str, str]]) -> None:
    assert f'<!-- {name}: begin -->\n\n{measured[0][name]}\n<!-- {name}: end -->' in PAGE.read_text(encoding='utf-8'), (
        'python3 -m benchmarks.paper writes it anew')


@pytest.mark.parametrize('name', ['paper_choices.csv', 'paper_classics.csv'])
def test_the_data_of_the_page_are_what_is_measured_now(name: str,
                                                       measured: tuple[dict[str, str], dict[str, str]]) -> None:
    assert (DATA / name).read_text(encoding='utf-8') == measured[1][name], 'python3 -m benchmarks.paper writes it anew'


@pytest.fixture(scope='module')
def measured() -> tuple[dict[str, str], dict[str, str]]:
    return made()


# The belt and the brake of the paper's Fig. 1 are this axis, seen from the belt.

PRESSED, STATIC, KINETIC = 100.0, 0.3, 0.2   # N


def coulomb(mass: float, stiffness: float, damping: float = 0.0) -> Axis:
    friction = Friction(StaticLaw(StaticLawKind.CONSTANT, STATIC, STATIC), KineticTable((0.0,), (KINETIC,)), None)
    return Axis(mass, stiffness, damping, PRESSED, RigidContact(), friction)


def times(end: float) -> Iterator[float]:
    return (end * k / 200 for k in range(1, 201))


def test_a_spring_that_is_fixed_over_a_belt() -> None:
    """In its own frame: x grows with the belt up to F_s/c, then swings about F_k/c until it moves as the belt again."""
    mass, stiffness, belt = 2.0, 800.0, 0.05
    omega, held, middle = math.sqrt(stiffness / mass), PRESSED * STATIC / stiffness, PRESSED * KINETIC / stiffness
    until = held / belt
    slip = 2.0 * (math.pi - math.atan((held - middle) * omega / belt)) / omega
    simulator = Simulator(coulomb(mass, stiffness), InitialState(), constant(-belt), constant(0.0))
    for time in times(until + slip):
        simulator.advance(instant(time))
        sample = simulator.sample()
        since = max(time - until, 0.0)
        x = min(belt * time, held) if since == 0.0 else (
            middle + (held - middle) * math.cos(omega * since) + belt / omega * math.sin(omega * since))
        assert sample.position + belt * time == pytest.approx(x, abs=1e-13)
        assert (sample.mode == Mode.STICK) == (since == 0.0 or since >= slip)


def test_a_belt_that_speeds_up_adds_the_force_of_its_inertia() -> None:
    """On the belt x = a t²/2, so that the limit is reached where c a t²/2 + m a = F_s."""
    mass, stiffness, a = 2.0, 800.0, 0.4
    simulator = Simulator(coulomb(mass, stiffness), InitialState(), ramp(0.0, -a, math.inf), constant(-mass * a))
    first = next(event for event in simulator.advance(instant(1.0)) if event.kind == EventKind.BREAKAWAY)
    assert first.time == pytest.approx(math.sqrt(2.0 * (PRESSED * STATIC - mass * a) / (stiffness * a)), rel=1e-14)


def test_a_brake_is_a_belt_of_the_speed_of_its_disc() -> None:
    """The damped block on a turning disc: angle, and the torque that holds it, by J, k, d and Ω alone."""
    inertia, arm, spring, damper, disc = 0.03, 0.1, 9.0, 0.06, 0.5   # kg m², m, N m/rad, N m s/rad, rad/s
    axis = coulomb(inertia / arm**2, spring / arm**2, damper / arm**2)
    simulator = Simulator(axis, InitialState(), constant(-disc * arm), constant(0.0))
    until = (PRESSED * STATIC * arm - damper * disc) / (spring * disc)   # k Ω t + d Ω = F_s r
    gamma, omega2 = 0.5 * damper / inertia, spring / inertia
    nu = math.sqrt(omega2 - gamma**2)
    begin, middle = disc * until, PRESSED * KINETIC * arm / spring
    for time in times(until + 0.5 / nu):
        simulator.advance(instant(time))
        since = max(time - until, 0.0)
        swing = math.exp(-gamma * since) * ((begin - middle) * math.cos(nu * since)
                                            + (disc + gamma * (begin - middle)) / nu * math.sin(nu * since))
        angle = disc * time if since == 0.0 else middle + swing
        assert simulator.sample().position / arm + disc * time == pytest.approx(angle, abs=1e-12)
