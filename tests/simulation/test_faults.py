# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Faults: each equals what it stands for, begins and ends in its step; by which id, how many, in a scene; refused."""

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any, ClassVar

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from stickslip_sim.axis import Axis, InitialState
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.input_profile import constant, steps
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.core.types import Instant
from stickslip_sim.inputs import load_scene
from stickslip_sim.simulation import Fault, RigEventKind
from stickslip_sim.simulation.faults import MAX_FAULTS, RULES, Faults
from stickslip_sim.simulation.simulator import Simulator
from tests.support.rigs import AXIS, STUCK, Script, bits, force, inject, make, rig_events_of, run, velocity
from tests.support.scene_files import refusal


def scaled(axis: Axis, factor: float) -> Axis:
    """Return the axis with other friction, written out."""
    static, kinetic = axis.friction.static, axis.friction.kinetic
    return replace(axis, friction=replace(
        axis.friction, static=replace(static, initial=static.initial * factor, limit=static.limit * factor),
        kinetic=replace(kinetic, coefficients=tuple(value * factor for value in kinetic.coefficients))))


class TestFrictionScale:
    @pytest.mark.parametrize('axis', [AXIS, STUCK])
    def test_is_an_axis_with_other_coefficients(self, axis: Axis) -> None:
        results = run(make(axis), 3000, {1000: [inject('friction_scale', duration=1.0, value=1.7)]})
        other = Simulator(axis, InitialState(), constant(0.002), constant(0.0))
        for result in results:
            if result.step in (1000, 2000):
                other.change_axis(scaled(axis, 1.7) if result.step == 1000 else axis)
            assert bits(result.events) == bits(other.advance(GRID.instant(result.step)))
            assert repr(result.sample) == repr(other.sample())

    def test_two_that_overlap_multiply(self) -> None:
        rig = make()
        run(rig, 200, {10: [inject('friction_scale', value=2.0, duration=0.1)],
                       50: [inject('friction_scale', value=0.25, duration=1.0)]})
        assert rig.simulator.axis == scaled(AXIS, 0.25)
        rig.reset()
        run(rig, 80, {10: [inject('friction_scale', value=2.0, duration=0.1)],
                      50: [inject('friction_scale', value=0.25, duration=1.0)]})
        assert rig.simulator.axis == scaled(AXIS, 0.5)

    def test_no_friction_at_all(self) -> None:
        results = run(make(STUCK), 2000, {1: [inject('friction_scale', duration=math.inf, value=0.0)]})
        force = [result.sample.friction_force for result in results[2:]]
        assert max(map(abs, force)) == 0.0

    @pytest.mark.parametrize('scene', ['stribeck', 'paper_fig4_falling', 'cutting_force'])
    def test_of_any_law(self, scene: str) -> None:
        rig = load_scene(scene).make_rig()
        before = rig.simulator.axis.friction
        run(rig, 3, {1: [inject('friction_scale', value=3.0)]})
        after = rig.simulator.axis.friction
        for time in (0.0, 0.1, math.inf):
            assert after.static.coefficient(time) == pytest.approx(3.0 * before.static.coefficient(time), rel=1e-14)
        for speed in (0.0, 1e-3, 0.02, 0.5, 3.0):
            assert after.kinetic.coefficient(speed) == pytest.approx(3.0 * before.kinetic.coefficient(speed), rel=1e-14)


class TestForcePulse:
    @pytest.mark.parametrize('base', [0.0, 120.0])
    def test_is_a_profile_with_that_pulse(self, base: float) -> None:
        results = run(make(force=base), 1500, {701: [inject('force_pulse', duration=0.1, value=400.0)]})
        profile = steps('force', [0.0, 0.7, 0.8], [base, base + 400.0, base])
        other = Simulator(AXIS, InitialState(), constant(0.002), profile)
        events = []
        for result in results:
            events += other.advance(GRID.instant(result.step))
            if result.step not in (700, 800):     # a border: here a step ends, there the next piece begins
                assert repr(result.sample) == repr(other.sample())
        assert bits(event for result in results for event in result.events) == bits(events)

    def test_those_that_overlap_add_to_each_other_and_to_commands(self) -> None:
        script: Script = {10: [inject('force_pulse', duration=0.02, value=100.0)],
                          20: [inject('force_pulse', duration=0.02, value=-30.0)],
                          25: [force(7.0)]}
        forces = [result.sample.external_force for result in run(make(), 50, script)]
        assert [forces[step] for step in (9, 10, 20, 25, 30, 40)] == [0.0, 100.0, 70.0, 77.0, -23.0, 7.0]

    def test_on_top_of_a_sine(self) -> None:
        given = {'faults.ids': ['k'], 'faults.kinds': ['force_pulse'], 'faults.starts': [0.1],
                 'faults.durations': [0.2]}
        rigs = [load_scene('cutting_force', {**given, 'faults.values': [value]}).make_rig() for value in (0.0, 50.0)]
        for without, with_it in zip(*(run(rig, 400) for rig in rigs)):
            pulse = 50.0 if 100 < without.step <= 300 else 0.0
            assert with_it.sample.external_force - without.sample.external_force == pytest.approx(pulse, abs=1e-9)


class TestTimes:
    @given(st.floats(0.0, 100.0), st.floats(1e-2, 100.0), st.sampled_from([1000.0, 333.3, 20_000.0, 3.0, 0.1 + 0.2]),
           st.integers(1, 10**6))
    @example(0.01, 0.02, 1000.0, 1)
    @example(0.0105, 0.0205, 1000.0, 7)
    def test_begins_and_ends_not_before_and_less_than_a_step_after(self, start: float, duration: float, rate: float,
                                                                   step: int) -> None:
        duration += 1.0 / rate
        faults = Faults(Grid(rate), ())
        faults.inject(Fault('a', 'drive_freeze', start, duration, 0.0), step)
        exact, period = Fraction(repr(rate)), 1 / Fraction(repr(rate))
        first = int(faults.next_change)
        late = (first - step) * period - Fraction(repr(start))
        assert 0 <= late < period
        assert not faults.enter(first - 1)[1]
        assert faults.enter(first)[1]
        end = int(faults.next_change)
        assert 0 <= (end - first) * period - Fraction(repr(duration)) < 1 / exact
        assert not faults.enter(end - 1)[0]
        assert [fault.id for fault in faults.enter(end)[0]] == ['a']
        assert faults.ids == []

    def test_are_reported_with_their_step(self) -> None:
        results = run(make(), 60, {10: [inject('force_pulse', 0.02, 0.01, 5.0, 'knock')]})
        assert rig_events_of(results) == [(10, RigEventKind.FAULT_INJECTED), (30, RigEventKind.FAULT_BEGIN),
                                 (40, RigEventKind.FAULT_END)]
        assert {(event.id, event.value, event.fault) for result in results for event in result.rig_events} == {
            ('knock', 5.0, Fault('knock', 'force_pulse', 0.02, 0.01, 5.0))}

    def test_one_begins_as_another_ends(self) -> None:
        script = {10: [inject('force_pulse', 0.0, 0.01, 5.0), inject('force_pulse', 0.01, 0.01, 7.0)]}
        forces = [result.sample.external_force for result in run(make(), 40, script)]
        assert forces[10:30] == [5.0] * 10 + [7.0] * 10


def test_a_reset_plans_the_faults_of_the_scene_again_and_forgets_the_others() -> None:
    rig = make(faults=(Fault('s', 'force_pulse', 0.01, 0.01, 5.0),))
    first = run(rig, 40)
    rig.inject(Fault('x', 'drive_freeze', 0.0, math.inf, 0.0))
    rig.clear_faults()
    run(rig, 5)
    rig.reset()
    assert list(rig.fault_ids) == ['s']
    assert bits(run(rig, 40)) == bits(first)


def test_offline_runs_go_through_the_same_faults() -> None:
    faults = (Fault('p', 'force_pulse', 0.3, 0.2, 300.0), Fault('s', 'friction_scale', 0.4, 0.5, 0.5),
              Fault('f', 'drive_freeze', 0.6, 0.1, 0.0))
    stepped, free = make(faults=faults), make(faults=faults)
    results = run(stepped, 1501)
    events = free.advance(Instant(1.5, 0.0))
    ours = [event for result in results for event in result.events]
    assert [event.kind for event in events] == [event.kind for event in ours]
    assert [event.time for event in events] == pytest.approx([event.time for event in ours], abs=1e-12)


GRID = Grid(1000.0)


class TestIds:
    def test_are_chosen_when_left_out(self) -> None:
        rig = make()
        names = [rig.inject(Fault(name, 'drive_freeze', 1.0, 1.0, 0.0)).id for name in ('', 'drive_freeze_2', '', '')]
        assert len(set(names)) == 4
        assert list(rig.fault_ids) == names

    @pytest.mark.parametrize('started', [False, True])
    def test_in_use_are_refused(self, started: bool) -> None:
        rig = make()
        rig.inject(Fault('a', 'drive_freeze', 0.0 if started else 9.0, 1.0, 0.0))
        run(rig, 5)
        error = refusal(lambda: rig.inject(Fault('a', 'force_pulse', 0.0, 1.0, 0.0)))
        assert "id = 'a' is refused: must be not in use" in str(error)
        rig.clear_fault('a')
        assert rig.inject(Fault('a', 'force_pulse', 0.0, 1.0, 0.0)).id == 'a'

    def test_unknown_are_refused_with_those_there_are(self) -> None:
        rig = make()
        assert 'none at the moment' in str(refusal(lambda: rig.clear_fault('x')))
        rig.inject(Fault('a', 'drive_freeze', 1.0, 1.0, 0.0))
        assert "id = 'x' is refused: must be the id of a fault: a;" in str(refusal(lambda: rig.clear_fault('x')))

    def test_a_planned_one_is_cleared_before_it_begins(self) -> None:
        rig = make()
        results = run(rig, 100, {10: [inject('force_pulse', 0.05, 0.02, 1.0, 'a'), inject('drive_freeze', 0.05)],
                                  20: [lambda rig: rig.clear_fault('a')]})
        assert not any(result.sample.external_force for result in results)
        assert results[60].sample.drive_velocity == 0.0

    def test_the_most_there_can_be(self) -> None:
        rig = make()
        for _ in range(MAX_FAULTS):
            rig.inject(Fault('', 'force_pulse', 0.001, 0.001, 1.0))
        error = refusal(lambda: rig.inject(Fault('', 'force_pulse', 0.001, 0.001, 1.0)))
        assert f'at most {MAX_FAULTS} at a time' in str(error)
        assert len(str(refusal(lambda: rig.clear_fault('x')))) < 500
        assert [result.sample.external_force for result in run(rig, 4)] == [0.0, 0.0, MAX_FAULTS, 0.0]
        assert list(rig.fault_ids) == []


class TestRefused:
    @pytest.mark.parametrize(('change', 'reason'), [
        ({'kind': 'gremlin'}, "kind = 'gremlin'"), ({'kind': ''}, 'one of friction_scale'),
        ({'start': -1e-9}, 'start = -1e-09'), ({'start': math.nan}, 'start = nan'),
        ({'start': math.inf}, 'start = inf'),
        ({'duration': 0.0}, 'duration = 0.0'), ({'duration': 0.0009}, 'from a step (0.001 s)'),
        ({'duration': math.nan}, 'duration = nan'), ({'duration': -math.inf}, 'duration = -inf'),
        ({'value': math.nan}, 'value = nan'), ({'value': math.inf}, 'value = inf'),
        ({'id': 'a' * 65}, '1 to 64 characters'), ({'id': 'a\nb'}, 'printable'), ({'id': '\x00'}, 'printable'),
    ])
    def test_without_a_meaning(self, change: dict[str, Any], reason: str) -> None:
        fault = Fault('a', 'force_pulse', 0.0, 1.0, 5.0)._replace(**change)
        rig = make()
        assert reason in str(refusal(lambda: rig.inject(fault)))
        assert list(rig.fault_ids) == []
        assert bits(run(rig, 20)) == bits(run(make(), 20))

    VALUES: ClassVar[dict[str, tuple[list[float], list[float]]]] = {    # by kind: those that are taken, and refused
        'friction_scale': ([0.0, 100.0], [-1e-9, 100.1]), 'force_pulse': ([-1e9, 1e9], [-1.1e9, 1.1e9]),
        'encoder_freeze': ([0.0], [1.0, -1.0]), 'encoder_step': ([-1e3, 1e3], [1001.0, -1001.0]),
        'encoder_dropout': ([1e-9, 1.0], [0.0, 1.1, -0.1]), 'command_loss': ([1e-9, 1.0], [0.0, 1.1, -0.1]),
        'command_delay': ([1e-9, 60.0], [0.0, 60.1, -1.0]), 'drive_freeze': ([0.0], [0.1]),
    }

    @pytest.mark.parametrize('kind', RULES)
    def test_values_by_kind(self, kind: str) -> None:
        rig, (good, bad) = make(measures=True), self.VALUES[kind]
        for value in good:
            rig.inject(Fault('', kind, 0.0, 0.005, value))
        for value in bad:
            assert f'with {kind}: ' in str(refusal(rig.inject, Fault('', kind, 0.0, 1.0, value)))
        run(rig, 20, {5: [velocity(0.01)]})


class TestScene:
    GIVEN: ClassVar[dict[str, Any]] = {'faults.ids': ['a', 'b'], 'faults.kinds': ['force_pulse', 'drive_freeze'],
                             'faults.starts': [0.5, 1.0], 'faults.durations': [0.5, math.inf],
                             'faults.values': [300.0, 0.0]}

    def test_are_those_injected_at_the_start(self) -> None:
        of_scene = run(load_scene('paper_fig8', self.GIVEN).make_rig(), 1500)
        rig = load_scene('paper_fig8').make_rig()
        injected = run(rig, 1500, {0: [inject('force_pulse', 0.5, 0.5, 300.0, 'a'),
                                       inject('drive_freeze', 1.0, math.inf, 0.0, 'b')]})
        assert bits(result.sample for result in of_scene) == bits(result.sample for result in injected)
        assert rig_events_of(of_scene) == [(501, RigEventKind.FAULT_BEGIN), (1001, RigEventKind.FAULT_END),
                                  (1001, RigEventKind.FAULT_BEGIN)]

    @pytest.mark.parametrize(('change', 'reason'), [
        ({'faults.ids': ['a', 'a']}, "faults (a): id = 'a'"),
        ({'faults.ids': ['a', 'a'], 'faults.kinds': ['drive_freeze'] * 2, 'faults.starts': [1.0] * 2,
          'faults.durations': [1.0] * 2, 'faults.values': [0.0] * 2}, "faults (a): id = 'a'"),
        ({'faults.kinds': ['force_pulse', 'goblin']}, "faults (b): kind = 'goblin'"),
        ({'faults.values': [300.0, 1.0]}, 'faults (b): value = 1.0'),
        ({'faults.durations': [1e-4, 1.0]}, 'faults (a): duration = 0.0001'),
        ({'faults.starts': [0.5]}, 'faults.starts = [0.5]'),
        ({'faults.starts': [-0.5, 0.5]}, 'faults.starts'),
    ])
    def test_refused_when_the_scene_is_read(self, change: dict[str, Any], reason: str) -> None:
        error = refusal(lambda: load_scene('paper_fig8', {**self.GIVEN, **change}))
        assert reason in str(error)

    @pytest.mark.parametrize('missing', ['ids', 'kinds', 'starts', 'durations'])
    def test_lists_belong_together(self, missing: str) -> None:
        given = {name: value for name, value in self.GIVEN.items() if name != f'faults.{missing}'}
        with pytest.raises(InputError, match='as many as there are faults'):
            load_scene('paper_fig8', given)

    def test_as_many_as_there_can_be_are_read_also_without_values(self) -> None:
        count = MAX_FAULTS
        given = {'faults.ids': [f'f{i}' for i in range(count)], 'faults.kinds': ['force_pulse'] * count,
                 'faults.starts': [float(i) for i in range(count)], 'faults.durations': [1.0] * count}
        assert [fault.value for fault in load_scene('paper_fig8', given).rig.faults] == [0.0] * count
