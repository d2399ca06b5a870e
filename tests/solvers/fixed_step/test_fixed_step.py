# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Fixed steps: the order that is declared, the limits that are stated, and a motion that no question changes."""

import math
import random
from dataclasses import replace

import pytest

from stickslip_sim.axis import Axis, Friction, InitialState
from stickslip_sim.core.errors import InputError, SolverError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, steps, table
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.solvers import adaptive, fixed_step
from tests.support.axes import COMPLIANT, RIGID, instant, of_kind, paper_axis
from tests.support.solver_runs import EXACT, firm, make, order, simulate

METHODS = ('euler', 'rk4')
ORDER = {'euler': 1.0, 'rk4': 4.0}
STEPS = [4e-3, 2e-3, 1e-3, 5e-4]
SLIDING = InitialState(velocity=0.05)


def smooth_axis(contact: object = RIGID, damping: float = 4000.0) -> Axis:
    """Return an axis whose slip has no breakpoint: mu_k rises with one slope."""
    axis = paper_axis(COMPLIANT if contact is COMPLIANT else RIGID, branches=False)
    return replace(axis, drive_damping=damping,
                   friction=Friction(StaticLaw(StaticLawKind.CONSTANT, 0.12, 0.12), KineticTable((0.0,), (0.1,), 0.3),
                                     None))


class TestOrder:
    @pytest.mark.parametrize('method', METHODS)
    def test_within_a_slip(self, method: str) -> None:
        drive = table('drive', [0.0, 0.4], [0.04, 0.06])
        expected = simulate(EXACT, smooth_axis(), drive, 0.4, 30.0, SLIDING)[1]
        self._check(method, smooth_axis(), drive, expected.position, expected.velocity)

    @pytest.mark.parametrize('method', METHODS)
    def test_within_the_ringing_of_a_compliant_contact(self, method: str) -> None:
        axis = replace(paper_axis(COMPLIANT), drive_damping=1000.0)
        events, expected = simulate(EXACT, axis, 0.002, 0.1)
        assert events == []
        errors = [simulate(fixed_step.solver(method, step), axis, 0.002, 0.1)[1] for step in STEPS]
        measured = order(STEPS, [abs(s.position - expected.position) for s in errors])
        assert measured == pytest.approx(ORDER[method], rel=0.1)

    @pytest.mark.parametrize('method', METHODS)
    def test_under_sinusoids(self, method: str) -> None:
        """Sinusoids at the stages of a step; the adaptive solver, at a tight tolerance, is the measure."""
        drive = InputProfile((0.0,), (0.05,), (0.0,), sinusoids=(Sinusoid(0.005, 3.0, 0.3),))
        force = InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(100.0, 5.0, 0.0), Sinusoid(50.0, 2.0, 1.0)))
        tight = adaptive.solver('DOP853', 1e-13, 1e-15)
        expected = simulate(tight, smooth_axis(), drive, 0.4, force, SLIDING)[1]
        self._check(method, smooth_axis(), drive, expected.position, expected.velocity, force)

    @pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
    @pytest.mark.parametrize('branches', [True, False])
    @pytest.mark.parametrize('method', METHODS)
    def test_across_events_it_is_one(self, method: str, contact: object, branches: bool) -> None:
        axis = paper_axis(COMPLIANT if contact is COMPLIANT else RIGID, branches=branches)
        expected = firm(simulate(EXACT, axis, 0.002, 3.0)[0])
        lengths = [1e-3 * 0.5 ** k for k in range(8)]
        errors = []
        for step in lengths:
            events = simulate(fixed_step.solver(method, step), axis, 0.002, 3.0)[0]
            assert [e.kind for e in events] == [e.kind for e in expected]
            errors.append(max(abs(a.time - b.time) for a, b in zip(events, expected)))
            assert errors[-1] < 12.0 * step
        assert 0.7 < order(lengths, errors) < 1.3

    @staticmethod
    def _check(method: str, axis: Axis, drive: InputProfile, position: float, velocity: float,
               force: float | InputProfile = 30.0) -> None:
        ends = [simulate(fixed_step.solver(method, step), axis, drive, 0.4, force, SLIDING)[1] for step in STEPS]
        for errors in ([abs(s.position - position) for s in ends], [abs(s.velocity - velocity) for s in ends]):
            assert order(STEPS, errors) == pytest.approx(ORDER[method], rel=0.12)


class TestAskingChangesNothing:
    @pytest.mark.parametrize('method', METHODS)
    def test_one_call_or_many_give_the_same_bits(self, method: str) -> None:
        rng = random.Random(7)
        drive = steps('drive', [0.0, 0.7001, 1.5], [0.003, -0.02, 0.001])
        whole, parts = (make(fixed_step.solver(method, 1e-3), paper_axis(COMPLIANT), drive) for _ in range(2))
        expected = whole.advance(instant(2.0))
        events, t = [], 0.0
        while t < 2.0:
            t = min(t + rng.choice((1e-9, 1e-5, 1e-3, 0.05)) * rng.random(), 2.0)
            events += parts.advance(instant(t))
            parts.sample()
        assert events == expected
        assert parts.sample() == whole.sample()

    def test_a_repeated_command_changes_nothing(self) -> None:
        quiet, busy = (make(fixed_step.solver('rk4', 1e-3), paper_axis(COMPLIANT), 0.002) for _ in range(2))
        expected = quiet.advance(instant(2.0))
        events = []
        for k in range(1, 5001):
            events += busy.advance(instant(k * 0.0004))
            busy.command_drive(0.002)
        assert (events, busy.sample()) == (expected, quiet.sample())

    @pytest.mark.parametrize('method', METHODS)
    def test_mirror_image_is_bit_identical(self, method: str) -> None:
        for contact in (RIGID, COMPLIANT):
            here, there = (simulate(fixed_step.solver(method, 1e-3), paper_axis(contact), v, 3.0, -20.0 * v)[1]
                           for v in (0.003, -0.003))
            assert there == here._replace(
                direction=-here.direction, position=-here.position, velocity=-here.velocity,
                acceleration=-here.acceleration, drive_position=-here.drive_position,
                drive_velocity=-here.drive_velocity, drive_force=-here.drive_force,
                external_force=-here.external_force, friction_force=-here.friction_force,
                contact_deflection=-here.contact_deflection)


class TestTheGrid:
    @pytest.mark.parametrize(('step', 'per_second'), [(1e-3, 1000), (1e-4, 10_000), (0.0125, 80)])
    def test_it_does_not_drift(self, step: float, per_second: int) -> None:
        simulator = make(fixed_step.solver('euler', step), paper_axis(RIGID), 0.002)
        events = [event for k in range(30) for event in simulator.advance(instant(10.0 * (k + 1)))]
        assert len(events) > 1000
        assert all(event.fraction == round(event.fraction * per_second) / per_second for event in events)

    def test_a_jump_between_two_points_takes_effect_at_once(self) -> None:
        """A blow shorter than a step, and off the grid, moves the slider by what it should."""
        free = replace(smooth_axis(), normal_force=0.0, drive_stiffness=0.0, drive_damping=0.0)
        blow = steps('force', [0.0, 0.01031, 0.01062], [0.0, 1e4, 0.0])
        final = simulate(fixed_step.solver('rk4', 1e-3), free, 0.0, 0.02, blow, SLIDING)[1]
        gain = 1e4 * 0.00031 / 350.0
        assert final.velocity == pytest.approx(0.05 + gain, rel=1e-12)
        assert final.position == pytest.approx(0.05 * 0.02 + gain * (0.02 - 0.5 * (0.01031 + 0.01062)), rel=1e-12)

    @pytest.mark.parametrize('step', [1e-3, 7e-4, 0.3, 1.0])
    def test_a_drive_without_friction_and_spring_arrives(self, step: float) -> None:
        free = replace(smooth_axis(), normal_force=0.0, drive_stiffness=0.0, drive_damping=0.0)
        final = simulate(fixed_step.solver('rk4', step), free, table('d', [0.0, 3.0], [0.0, 0.3]), 2.5, 0.0, SLIDING)[1]
        assert (final.drive_position, final.position) == pytest.approx((0.05 * 2.5 ** 2, 0.05 * 2.5), rel=1e-12)


class TestModes:
    def test_steady_sliding_stays(self) -> None:
        for method in METHODS:
            events, final = simulate(fixed_step.solver(method, 1e-3), paper_axis(RIGID), 0.08, 30.0)
            assert final.mode != Mode.STICK
            assert final.velocity == pytest.approx(0.08, rel=1e-9)
            assert [e for e in events if e.time > 5.0 and e.kind in (EventKind.STICK, EventKind.BREAKAWAY)] == []

    def test_reverses_at_once_where_a_rigid_contact_cannot_hold(self) -> None:
        slippery = replace(paper_axis(RIGID, branches=False), normal_force=100.0, drive_damping=0.0)
        force = steps('force', [0.0, 0.01], [2000.0, 0.0])
        expected = of_kind(simulate(EXACT, slippery, 0.0, 1.0, force)[0], EventKind.REVERSE)
        assert len(expected) > 5
        for method in METHODS:
            found = of_kind(simulate(fixed_step.solver(method, 1e-5), slippery, 0.0, 1.0, force)[0], EventKind.REVERSE)
            assert [e.direction for e in found] == [e.direction for e in expected]
            assert max(abs(a.time - b.time) for a, b in zip(found, expected)) < 1e-3

    @pytest.mark.parametrize('contact', [RIGID, COMPLIANT])
    def test_other_parameters_in_the_middle(self, contact: object) -> None:
        axis = paper_axis(COMPLIANT if contact is COMPLIANT else RIGID)
        heavier = replace(axis, mass=500.0, contact=COMPLIANT if contact is RIGID else RIGID)
        runs = []
        for solver in (EXACT, fixed_step.solver('rk4', 1e-5)):
            simulator = make(solver, axis, 0.002)
            simulator.advance(instant(1.30000321))
            simulator.change_axis(heavier)
            runs.append((of_kind(simulator.advance(instant(4.0)), EventKind.BREAKAWAY), simulator.sample()))
        assert len(runs[0][0]) == len(runs[1][0]) > 2
        assert max(abs(a.time - b.time) for a, b in zip(runs[0][0], runs[1][0])) < 5e-4
        assert runs[0][1].position == pytest.approx(runs[1][1].position, abs=2e-6)

    def test_a_feed_within_the_band_is_stopped_and_a_shorter_step_lets_it_go_on(self) -> None:
        """Constant friction: the truth is one break-away and sliding for ever; Karnopp's band stops it again."""
        axis = replace(smooth_axis(), friction=Friction(StaticLaw(StaticLawKind.CONSTANT, 0.12, 0.12),
                                                        KineticTable((0.0,), (0.12,)), None))
        feed, initial = 1e-4, InitialState(rest_time=0.0)
        solvers = (fixed_step.solver('rk4', 1e-3), fixed_step.solver('rk4', 1e-5), EXACT)
        stops = [len(of_kind(simulate(solver, axis, feed, 10.0, 0.0, initial)[0], EventKind.STICK))
                 for solver in solvers]
        assert stops[0] > 0
        assert stops[1:] == [0, 0]


class TestTooLongSteps:
    @pytest.mark.parametrize('damping', [0.0, 2000.0, 4e4, 1e6])
    @pytest.mark.parametrize('method', METHODS)
    def test_the_stated_limit_is_sharp(self, method: str, damping: float) -> None:
        """Just below it a free swing stays, just above it grows beyond all bounds."""
        free = replace(smooth_axis(damping=damping), normal_force=0.0)
        longest = self._longest(free, method)
        initial = InitialState(velocity=100.1)
        for factor, grows in ((0.999, False), (1.001, True)):
            solver = fixed_step.solver(method, longest * factor)
            simulator = make(solver, free, 100.0, 0.0, initial)
            try:
                simulator.advance(instant(20000.0 * longest))
                assert (abs(simulator.sample().velocity - 100.0) > 1.0) == grows
            except SolverError:
                assert grows

    @staticmethod
    def _longest(axis: Axis, method: str) -> float:
        low, high = 1e-9, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            try:
                fixed_step.check_step(axis, method, middle)
                low = middle
            except InputError:
                high = middle
        return low

    @pytest.mark.parametrize('method', METHODS)
    def test_overflow_ends_with_a_word_about_the_step(self, method: str) -> None:
        stiff = replace(smooth_axis(), normal_force=0.0, drive_stiffness=1e14)
        simulator = make(fixed_step.solver(method, 1e-2), stiff, 0.0, 0.0, SLIDING)
        with pytest.raises(SolverError, match=r'solver.step = 0.01 s'):
            simulator.advance(instant(100.0))
        assert math.isfinite(simulator.sample().velocity)

    def test_a_scene_refuses_a_step_that_the_contact_does_not_bear(self) -> None:
        fixed = {'solver.name': 'fixed_step', 'solver.step': 0.03}
        with pytest.raises(InputError, match=r'solver.step = 0.03 .* stick of this axis with euler'):
            load_scene('paper_fig8', fixed)
        assert load_scene('paper_fig7', fixed).solver.step == 0.03
        with pytest.raises(InputError, match=r' s for slip'):
            load_scene('paper_fig7', {**fixed, 'axis.mass': 1e-9})


@pytest.mark.parametrize(('method', 'step', 'name'), [
    ('heun', 1e-3, 'solver.method'), ('euler', 0.0, 'solver.step'), ('euler', -1e-3, 'solver.step'),
    ('euler', math.nan, 'solver.step'), ('euler', math.inf, 'solver.step'), ('rk4', 1.5, 'solver.step'),
    ('rk4', 1e-10, 'solver.step'),
])
def test_bad_settings_are_refused(method: str, step: float, name: str) -> None:
    with pytest.raises(InputError) as caught:
        fixed_step.solver(method, step)
    assert caught.value.name == name
