# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The adaptive solver: near the exact engine within its tolerance, under sinusoids and smooth laws too, and it ends."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import pytest

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState, RigidContact
from stickslip_sim.core.errors import InputError, SolverError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant, steps, table
from stickslip_sim.core.types import Event, EventKind, Mode
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.friction.kinetic import default_excess
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import simulate as simulate_run
from stickslip_sim.runs import simulate_events
from stickslip_sim.runs.error_estimate import error_estimate
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import adaptive
from stickslip_sim.solvers.adaptive.engine import SAMPLED_AT, first_fall
from tests.conftest import Program
from tests.support.axes import COMPLIANT, RIGID, Contact, instant, of_kind, paper_axis
from tests.support.solver_runs import EXACT, firm, make, of_scene, simulate
from tests.support.tool import Capture, answered

pytestmark = pytest.mark.slow

TIGHT = adaptive.solver('DOP853', 1e-11, 1e-13)


def assert_near(found: list[Event], expected: list[Event], seconds: float) -> None:
    found, expected = firm(found), firm(expected)
    assert [(e.kind, e.direction) for e in found] == [(e.kind, e.direction) for e in expected]
    for event, other in zip(found, expected):
        assert event.time == pytest.approx(other.time, rel=0.0, abs=seconds)
        assert event.position == pytest.approx(other.position, rel=0.0, abs=0.1 * seconds)
        assert event.friction_force == pytest.approx(other.friction_force, rel=0.0, abs=2e4 * seconds)


class TestAgainstTheExactEngine:

    @pytest.mark.parametrize(('method', 'seconds', 'contact', 'branches'), [
        ('RK45', 1e-7, COMPLIANT, True), ('DOP853', 1e-7, RIGID, True), ('DOP853', 1e-7, COMPLIANT, False),
        ('Radau', 1e-7, COMPLIANT, True), ('BDF', 1e-4, COMPLIANT, True), ('LSODA', 1e-5, COMPLIANT, True)])
    def test_every_method(self, method: str, seconds: float, contact: Contact, branches: bool) -> None:
        axis = paper_axis(contact, branches=branches)
        expected = simulate(EXACT, axis, 0.002, 1.4)[0]
        assert_near(simulate(adaptive.solver(method, 1e-8, 1e-11), axis, 0.002, 1.4)[0], expected, seconds)

    def test_a_tighter_tolerance_is_nearer(self) -> None:
        scene = load_scene('paper_fig7')
        expected = of_scene(EXACT, scene, 3.0)[0]
        errors = []
        for rtol in (1e-5, 1e-7, 1e-9, 1e-11):
            found = of_scene(adaptive.solver('RK45', rtol, rtol * 1e-2), scene, 3.0)[0]
            errors.append(max(abs(a.time - b.time) for a, b in zip(found, expected, strict=True)))
        assert all(after < 0.1 * before for before, after in pairwise(errors))
        assert errors[-1] < 1e-9

    @pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
    def test_profiles_commands_and_other_parameters(self, contact: object) -> None:
        axis = paper_axis(COMPLIANT if contact is COMPLIANT else RIGID)
        drive = table('drive', [0.0, 0.4, 0.9, 1.4], [0.0, 0.01, -0.02, -0.02])
        force = steps('force', [0.0, 0.3, 0.302], [0.0, 9000.0, -50.0])
        runs = []
        for solver in (EXACT, TIGHT):
            simulator = make(solver, axis, drive, force)
            events = simulator.advance(instant(1.2))
            simulator.command_force(70.0)
            events += simulator.advance(instant(1.7))
            simulator.command_drive(0.004)
            simulator.change_axis(replace(axis, mass=200.0, contact=COMPLIANT if contact is RIGID else RIGID))
            events += simulator.advance(instant(2.5))
            runs.append(([e for e in events if e.kind != EventKind.KNOT], simulator.sample()))
        assert len(runs[0][0]) > 10
        assert_near(runs[1][0], runs[0][0], 1e-8)
        for name in ('position', 'velocity', 'drive_force', 'friction_force', 'contact_deflection', 'rest_time'):
            assert getattr(runs[1][1], name) == pytest.approx(getattr(runs[0][1], name), rel=1e-6, abs=1e-9)

    def test_samples_agree_in_every_mode(self) -> None:
        exact, found = (make(solver, paper_axis(COMPLIANT), 0.002) for solver in (EXACT, TIGHT))
        modes = set()
        for k in range(1, 161):
            exact.advance(instant(k / 100))
            found.advance(instant(k / 100))
            a, b = exact.sample(), found.sample()
            modes.add(a.mode)
            assert (a.mode, a.direction) == (b.mode, b.direction)
            assert b[4:] == pytest.approx(a[4:], rel=1e-6, abs=1e-7)
        assert modes == set(Mode) - {Mode.YIELDING}


def test_splits_agree_within_the_tolerance() -> None:
    scene = load_scene('paper_fig8')
    whole = of_scene(TIGHT, scene, 2.0)[0]
    simulator = make(TIGHT, scene.axis, scene.drive, scene.force, scene.initial)
    parts = [event for k in range(1, 401) for event in simulator.advance(instant(k / 200))]
    assert_near([e for e in parts if e.kind != EventKind.KNOT], whole, 2e-8)


@dataclass(frozen=True)
class Falling:
    """The paper's falling branch as a law: the same as its table, but for the events of kind knot."""

    def coefficient(self, speed: float) -> float:
        return max(0.05, 0.12 - 2.0 * speed)


@dataclass(frozen=True)
class Stribeck:
    def coefficient(self, speed: float) -> float:
        return 0.05 + 0.07 * math.exp(-(speed / 0.01) ** 2) + 0.2 * speed


class TestSmoothLaws:
    @pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
    @pytest.mark.parametrize('branches', [True, False])
    def test_a_law_that_equals_the_table_gives_the_same(self, contact: object, branches: bool) -> None:
        axis = paper_axis(COMPLIANT if contact is COMPLIANT else RIGID, branches=branches)
        solver = adaptive.solver('DOP853', 1e-11, 1e-13, Falling())
        assert_near(simulate(solver, axis, 0.002, 2.2)[0], simulate(EXACT, axis, 0.002, 2.2)[0], 1e-7)

    @pytest.mark.parametrize(('contact', 'branches'), [(RIGID, False), (COMPLIANT, True)])
    def test_fine_tables_come_to_the_law(self, contact: Contact, branches: bool) -> None:
        """The error of a table falls with the square of its width: the law is their limit."""
        law = Stribeck()
        errors = []
        for count in (50, 200, 800):
            speeds = tuple(0.08 * i / count for i in range(count + 1))
            kinetic = KineticTable(speeds, tuple(map(law.coefficient, speeds)), 0.2)
            excess = default_excess(KineticTable((0.0, 0.05), (0.1, 0.1))) if branches else None
            friction = Friction(StaticLaw(StaticLawKind.EXPONENTIAL, 0.125, 0.24, 0.2), kinetic, excess)
            axis = replace(paper_axis(contact), friction=friction)
            smooth = firm(simulate(adaptive.solver('DOP853', 1e-10, 1e-13, law), axis, 0.002, 1.8)[0])
            tabled = firm(simulate(EXACT, axis, 0.002, 1.8)[0])
            assert [e.kind for e in smooth] == [e.kind for e in tabled]
            errors.append(max(abs(a.time - b.time) for a, b in zip(smooth, tabled)))
        assert errors[1] < errors[0] / 8.0
        assert errors[2] < errors[1] / 8.0


class TestSinusoids:
    def test_a_mass_alone_follows_the_integral(self) -> None:
        """No spring, damper or friction: the motion is known, and so is the drive's."""
        free = replace(paper_axis(RIGID, branches=False), normal_force=0.0, drive_stiffness=0.0, drive_damping=0.0)
        force = InputProfile((0.0,), (3.5,), (0.0,), sinusoids=(Sinusoid(700.0, 2.0, 0.4),))
        drive = InputProfile((0.0,), (0.1,), (0.0,), sinusoids=(Sinusoid(0.3, 1.5, -0.2), Sinusoid(0.1, 1e-9,
                                                                                                   0.5 * math.pi)))
        final = simulate(TIGHT, free, drive, 1.3, force, InitialState(velocity=5.0))[1]
        omega = 4.0 * math.pi
        assert final.velocity == pytest.approx(
            5.0 + 0.01 * 1.3 + 2.0 / omega * (math.cos(0.4) - math.cos(omega * 1.3 + 0.4)), rel=1e-11)
        omega = 3.0 * math.pi
        assert final.drive_position == pytest.approx(
            0.2 * 1.3 + 0.3 / omega * (math.cos(-0.2) - math.cos(omega * 1.3 - 0.2)), rel=1e-12)

    def test_no_sinusoid_of_a_stuck_axis_is_passed_over(self) -> None:
        """At rest nothing bounds the step but the sinusoid; its first crest beyond the limit breaks the contact."""
        force = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(900.0, 0.5, 0.0),))
        event = simulate(TIGHT, paper_axis(RIGID), 0.0, 3.0, force)[0][0]
        assert event.time == pytest.approx(math.asin(0.24 * 350 * 9.80665 / 900.0) / math.pi, rel=1e-12)

    def test_no_crest_is_passed_over_when_steps_have_grown(self) -> None:
        """The 62 crests before stay below the limit."""
        force = InputProfile((0.0,), (0.0,), (100.0,), sinusoids=(Sinusoid(700.0, 50.0, 0.0),))
        event, other = (simulate(solver, paper_axis(RIGID), 0.0, 3.0, force)[0][0] for solver in (TIGHT, EXACT))
        assert 1.24 < event.time == pytest.approx(other.time, rel=1e-12)


class TestItEnds:
    def test_a_guard_at_its_limit_on_entry_does_not_fire_for_ever(self) -> None:
        """mu_k(0) = mu_s(0): a compliant stick begins exactly on its limit, and goes inwards."""
        events = simulate(adaptive.solver(), paper_axis(COMPLIANT), 0.002, 2.0)[0]
        stops = of_kind(events, EventKind.STICK)
        assert len(stops) == 2
        after = events[events.index(stops[0]) + 1]
        assert after.time - stops[0].time > 0.4

    @pytest.mark.parametrize('contact', [RIGID, COMPLIANT, CompliantContact(5e6, 0.0)])
    def test_nothing_holds_and_nothing_brakes(self, contact: object) -> None:
        assert isinstance(contact, (type(RIGID), CompliantContact))
        free = replace(paper_axis(contact, branches=False), normal_force=0.0, drive_damping=0.0)
        simulator = make(adaptive.solver('RK45', 1e-8), free, 0.001)
        simulator.advance(instant(1.0))
        assert abs(simulator.sample().velocity) < 0.01

    def test_steady_sliding_is_not_a_flood_of_events(self) -> None:
        for branches in (True, False):
            events, final = simulate(adaptive.solver(), paper_axis(RIGID, branches=branches), 0.08, 10.0)
            assert final.velocity == pytest.approx(0.08, rel=1e-6)
            assert len(events) < 500

    def test_sliding_that_settles_ends_in_no_flood_of_events(self) -> None:
        """It decays to the speed of the drive, where guards are zero to within the tolerances."""
        wanted, found = (simulate_events(load_scene('fast_feed', {'solver.name': name}), 10.0).events
                         for name in ('exact', 'adaptive'))
        assert 30 < len(found) <= len(wanted)
        assert [event.kind for event in found] == [event.kind for event in wanted[:len(found)]]

    def test_numbers_that_end_are_a_solver_error(self) -> None:
        simulator = make(adaptive.solver(), paper_axis(RIGID), 0.0, 0.0, InitialState(velocity=1e305))
        with pytest.raises(SolverError, match=r'another solver\.method or other tolerances'):
            simulator.advance(instant(1.0))

    def test_a_year_at_rest(self) -> None:
        simulator = make(adaptive.solver('Radau'), paper_axis(COMPLIANT), 0.0, 100.0)
        assert simulator.advance(instant(3.15e7)) == []
        assert simulator.sample().contact_deflection == pytest.approx(100.0 / 5.6e6, rel=1e-6)


@pytest.mark.parametrize(('settings', 'name'), [
    ({'method': 'rk4'}, 'solver.method'), ({'rtol': 0.0}, 'solver.rtol'), ({'rtol': 1e-14}, 'solver.rtol'),
    ({'rtol': math.nan}, 'solver.rtol'), ({'rtol': 1.0}, 'solver.rtol'), ({'atol': 0.0}, 'solver.atol'),
    ({'atol': math.inf}, 'solver.atol'), ({'atol': -1.0}, 'solver.atol'),
])
def test_bad_settings_are_refused(settings: dict[str, Any], name: str) -> None:
    with pytest.raises(InputError) as caught:
        adaptive.solver(**settings)
    assert caught.value.name == name


def test_scipy_is_loaded_only_by_those_who_use_it(in_a_process: Program) -> None:
    program = 'import sys\nimport stickslip_sim.runs.simulated\nprint("scipy" in sys.modules)'
    assert in_a_process(program, compiled=False).split() == ['False']


# A normal force that varies smoothly: closed forms where a slip has one, and a rest that it ends.

SWAY = InputProfile((0.0,), (0.0,), (0.0,), math.inf, (Sinusoid(6.0, 1.5, 0.4),))
RISE = table('normal_load', (0.0, 0.4, 1.0), (-8.0, 10.0, 0.0))


def simulator(load: InputProfile, slope: float = 0.0, force: float = 0.0, velocity: float = 0.0) -> Simulator:
    """Return 2 kg under 16 N and a load, without a spring: mu_k = 0.25 + slope |ẋ|, mu_s = 0.3."""
    friction = Friction(StaticLaw(StaticLawKind.CONSTANT, 0.3, 0.3), KineticTable((0.0,), (0.25,), slope), None)
    axis = Axis(2.0, 0.0, 0.0, 16.0, RigidContact(), friction)
    return Simulator(axis, InitialState(velocity=velocity), constant(0.0), constant(force),
                     adaptive.solver(rtol=1e-11, atol=1e-13), load=load)


def pressed(load: InputProfile, time: float) -> float:
    """Return ∫ N dt from 0 on, N s."""
    if load is SWAY:
        omega = 2.0 * math.pi * 1.5
        return 16.0 * time + 6.0 * (math.cos(0.4) - math.cos(omega * time + 0.4)) / omega
    first, rest = min(time, 0.4), max(time - 0.4, 0.0)
    return 16.0 * time + (-8.0 + 22.5 * first) * first + (10.0 - 10.0 / 0.6 * 0.5 * rest) * rest


@pytest.mark.parametrize('load', [SWAY, RISE])
@pytest.mark.parametrize('slope', [0.0, 0.2])
def test_a_slip_is_the_closed_form(load: InputProfile, slope: float) -> None:
    """m u′ = −N (a + b u): u + a/b falls as exp(−(b/m) ∫N dt)."""
    sim = simulator(load, slope, velocity=8.0)
    for time in (0.2, 0.5, 0.9):
        assert sim.advance(instant(time)) == []
        impulse = pressed(load, time)
        wanted = 8.0 - 0.125 * impulse
        if slope:
            wanted = (8.0 + 0.25 / slope) * math.exp(-0.5 * slope * impulse) - 0.25 / slope
        assert sim.sample().velocity == pytest.approx(wanted, abs=1e-9)


def test_a_rest_ends_where_the_limit_comes_down_to_the_force() -> None:
    """0.3 N(t) = 3.6 N, N = 16 + 6 sin(ωt + 0.4): at N = 12, the first time behind its largest value."""
    sim = simulator(SWAY, force=3.6)
    first, *_ = sim.advance(instant(0.6))
    wanted = (math.pi + math.asin(4.0 / 6.0) - 0.4) / (2.0 * math.pi * 1.5)
    assert first.kind == EventKind.BREAKAWAY
    assert first.time == pytest.approx(wanted, abs=1e-10)
    assert first.friction_force == pytest.approx(3.6, rel=1e-9)


@pytest.mark.parametrize(('law', 'how'), [
    ({}, 'of the exact solver'),
    ({'friction.static.law': 'kato', 'friction.static.exponent': 0.5}, '0.001 of the tolerances')])
def test_the_error_is_estimated_and_holds(law: dict[str, object], how: str) -> None:
    """Against a run with tolerances near rounding; with Kato's law no exact run can be had."""
    changes = {**law, 'solver.name': 'adaptive', 'solver.rtol': 1e-6, 'solver.atol': 1e-9, 'normal_load.course': 'sine',
               'normal_load.amplitude': 800.0, 'normal_load.frequency': 3.0}
    run = simulate_events(load_scene('paper_fig7', changes), 1.5)
    estimate = error_estimate(run)
    fine = simulate_events(load_scene('paper_fig7', {**changes, 'solver.rtol': 1e-12, 'solver.atol': 1e-15}), 1.5)
    kinds = [EventKind.BREAKAWAY, EventKind.STICK]
    pairs = list(zip((e for e in run.events if e.kind in kinds), (e for e in fine.events if e.kind in kinds)))
    assert len(pairs) >= 4
    assert estimate.until_s == 1.5
    assert 0.0 < max(abs(a.time - b.time) for a, b in pairs) <= estimate.event_time_s < 1e-4
    assert how in estimate.how


@pytest.mark.parametrize(('scene', 'amplitude', 'frequency'), [
    ('paper_fig7', 1000.0, 7.0), ('paper_fig7', 1500.0, 0.9), ('paper_fig8', 343.0, 25.0), ('paper_fig8', 1000.0, 7.0)])
def test_events_are_the_same_with_and_without_samples(scene: str, amplitude: float, frequency: float) -> None:
    """A limit that is touched for less than a step is no longer passed over: 31 break-aways in 8 s of the first."""
    end = 2.0   # s
    changes = {'solver.name': 'adaptive', 'normal_load.course': 'sine', 'normal_load.constant': 0.0,
               'normal_load.amplitude': amplitude, 'normal_load.frequency': frequency}
    loaded = load_scene(scene, changes)
    whole = simulate_events(loaded, end).events
    assert all(simulate_run(loaded, end, period).events == whole for period in (0.0173, 0.6))
    split_run = Simulator(loaded.axis, loaded.initial, loaded.drive, loaded.force, loaded.solver.make,
                          load=loaded.normal_load)
    split = [event for time in (0.0, 0.31, 0.310001, 1.2, 1.9, end) for event in split_run.advance(instant(time))]
    assert split == [*whole]
    if frequency == 7.0 and scene == 'paper_fig7':
        breaks = [event.time for event in whole if event.kind == EventKind.BREAKAWAY]
        assert breaks[5] == pytest.approx(1.81893, abs=5e-6)   # the first that was missed


@pytest.mark.parametrize(('times', 'values', 'wanted'), [
    ((0.0, 1.0), (1.0, 1.0), None), ((0.0, 1.0), (1.0, -1.0), 0.5), ((0.0, 1.0), (0.0, -1.0), 0.0),
    ((0.0, 1.0), (0.0, 1.0), None)])
def test_a_straight_guard_falls_where_it_says(times: tuple[float, float], values: tuple[float, float],
                                              wanted: float | None) -> None:
    found = root_of(lambda t: values[0] + (values[1] - values[0]) * t, *times)
    assert found == (wanted if wanted is None else pytest.approx(wanted, abs=1e-15))


@pytest.mark.parametrize('depth', [1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize('place', [0.003, 0.11, 0.4999, 0.7312, 0.9981])
def test_a_guard_that_comes_and_goes_is_found(place: float, depth: float) -> None:
    """A parabola that is below 0 for 6e-6 to 0.2 of the step, at any place of it."""
    assert root_of(lambda t: 3.0 * (t - place) ** 2 + depth, 0.0, 1.0) is None
    start = max(place - math.sqrt(depth / 3.0), 0.0)
    found = root_of(lambda t: 3.0 * (t - place) ** 2 - depth, 0.0, 1.0)
    if start > 0.0:
        assert found == pytest.approx(start, abs=1e-9)


def root_of(guard: Callable[[float], float], begin: float, end: float) -> float | None:
    samples = [guard(begin + (end - begin) * float(share)) for share in SAMPLED_AT]
    return first_fall(guard, begin, end, samples, 1e-15)


SINE = {'normal_load.course': 'sine', 'normal_load.constant': 0.0, 'normal_load.amplitude': 300.0,
        'normal_load.frequency': 7.0}
KATO = {'friction.static.law': 'kato', 'friction.static.exponent': 0.6}


@pytest.mark.parametrize(('changes', 'says'), [
    (SINE, 'solver.name: exact misses none'), (SINE | KATO, "no solver takes Kato's law there without"),
    (SINE | {'solver.name': 'exact'}, ''), ({}, ''),
    ({'normal_load.course': 'steps', 'normal_load.times': [0.0, 0.1], 'normal_load.forces': [0.0, 50.0]}, '')],
    ids=['adaptive', 'kato', 'exact', 'constant', 'steps'])
def test_a_run_says_that_it_may_miss_an_event(changes: dict[str, Any], says: str, capsys: Capture) -> None:
    """In its receipt, and in the summary of the tool."""
    values = {'solver.name': 'adaptive'} | changes
    note = simulate_run(load_scene('paper_fig7', values), 0.05).receipt['results'].get('note', '')
    assert (says in note, 'may miss an event' in note) == (True, says != '')
    settings = [word for name, value in values.items() for word in ('--set', f'{name}={value}')]
    code, said, _ = answered(capsys, 'simulate', 'paper_fig7', '--duration', '0.05', *settings)
    assert (code, 'may miss an event' in said) == (0, says != '')
