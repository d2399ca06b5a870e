# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The rig as a whole: a function of scene, seed and orders by step, and of nothing else; and the marks of its run."""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import pytest

from stickslip_sim.axis import InitialState
from stickslip_sim.core.errors import InputError, SolverError
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.realtime.commands import CommandSlot, Watchdog
from stickslip_sim.realtime.pacing import Unpaced
from stickslip_sim.realtime.step_loop import StepLoop
from stickslip_sim.simulation import Fault, Rig, RigEventKind, StepResult
from stickslip_sim.simulation.drive import DriveLimits
from stickslip_sim.simulation.encoder import EncoderSettings
from stickslip_sim.simulation.rig import RigSettings
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.simulation.step_result import Mark, TimedRigEvent, marks_of_events, marks_of_faults
from tests.support.rigs import (
    AXIS,
    STUCK,
    Order,
    Script,
    bits,
    force,
    given,
    inject,
    make,
    random_script,
    run,
    tired_after,
    velocity,
)

STEPS = 600
FULL: dict[str, Any] = {
    'seed': 2**40 + 3, 'measures': True, 'on_timeout': 'ramp_to_zero', 'timeout_deceleration': 0.5,
    'encoder': EncoderSettings(1e-6, 1e-3, 2e-6, 0.003, 4), 'encoder_delay_steps': 3,
    'limits': DriveLimits(0.01, 0.4),
    'faults': (Fault('dry', 'friction_scale', 0.1, 0.2, 1.7), Fault('', 'command_loss', 0.2, 0.3, 0.5)),
}


class TestDeterminism:
    @pytest.mark.parametrize('seed', range(4))
    def test_reset_gives_the_same_run_again(self, seed: int) -> None:
        rig, script = make(**FULL), random_script(seed, STEPS)
        first = run(rig, STEPS, script)
        rig.change_axis(AXIS)
        rig.reset()
        assert bits(run(rig, STEPS, script)) == bits(first)

    @pytest.mark.parametrize('groups', [[1] * STEPS, [STEPS], [7, 1, 92, 300, 200]])
    def test_however_the_steps_are_grouped(self, groups: Sequence[int]) -> None:
        script = random_script(5, STEPS)
        assert bits(in_groups(make(**FULL), groups, script)) == bits(run(make(**FULL), STEPS + 1, script))

    def test_reset_keeps_the_parameters_of_the_axis(self) -> None:
        other = replace(AXIS, mass=200.0)
        rig = make()
        run(rig, 50, {20: [lambda rig: rig.change_axis(other)]})
        rig.reset()
        assert bits(run(rig, 900)) == bits(run(make(other), 900))

    def test_reset_forgets_what_was_ordered_and_not_yet_obeyed(self) -> None:
        rig = make()
        run(rig, 20)
        rig.time_out(1.0)
        rig.inject(Fault('', 'drive_freeze', 0.0, math.inf, 0.0))
        rig.reset()
        assert bits(run(rig, 100)) == bits(run(make(), 100))

    @pytest.mark.parametrize('settings', [{}, {'measures': True}, {'limits': DriveLimits(0.01, 0.4)}])
    def test_seeds_do_not_matter_without_randomness(self, settings: dict[str, Any]) -> None:
        script = {100: [velocity(0.02), inject('friction_scale', value=2.0)]}
        one, other = (run(make(seed=seed, **settings), 300, script) for seed in (1, 2))
        assert bits(one) == bits(other)

    def test_noise_is_in_the_measurement_alone(self) -> None:
        one, other = (run(make(seed=seed, measures=True, encoder=EncoderSettings(noise=1e-6)), 300) for seed in (1, 2))
        assert bits(result.sample for result in one) == bits(result.sample for result in other)
        assert all(a.measured != b.measured for a, b in zip(one, other))

    def test_seeds_matter_to_the_motion_when_commands_are_lost(self) -> None:
        script: Script = {step: [change_velocity(step)] for step in range(300)}
        runs = [run(make(seed=seed, faults=(Fault('l', 'command_loss', 0.0, math.inf, 0.5),)), 300, script)
                for seed in (1, 2)]
        assert runs[0][-1].sample != runs[1][-1].sample

    def test_one_purpose_of_chance_does_not_disturb_another(self) -> None:
        noisy: dict[str, Any] = {'measures': True, 'encoder': EncoderSettings(noise=1e-6)}
        script: Script = {step: [change_velocity(step)] for step in range(300)}
        loss = Fault('l', 'command_loss', 0.0, math.inf, 0.5)
        without, with_noise = (run(make(faults=(loss,), **settings), 300, script) for settings in ({}, noisy))
        assert bits(result.sample for result in without) == bits(result.sample for result in with_noise)


def change_velocity(step: int) -> Order:
    return velocity(step * 1e-5)


def in_groups(rig: Rig, groups: Sequence[int], script: Script) -> list[StepResult]:
    """Make step 0 and then steps group by group, in the thread of a loop; orders are given as steps come."""
    results: list[StepResult] = []
    slots = CommandSlot('velocity', 'm/s', math.inf), CommandSlot('force', 'N', math.inf)

    def order(step: int) -> None:
        for slot, value in zip(slots, given(rig, script.get(step, ()))):
            if value is not None:
                slot.offer(value, 1)

    def take(result: StepResult) -> None:
        results.append(result)
        order(result.step + 1)

    order(0)
    loop = StepLoop(rig, Unpaced(Grid(1000.0)), slots, [take], Watchdog(0.0), by_request=True)
    loop.start()
    for count in groups:
        assert loop.at_boundary(partial(loop.run_steps, count, None, None, lambda: False))
    loop.stop()
    assert loop.crash is None
    return results


class TestNeutral:
    @pytest.mark.parametrize('settings', [{}, {'measures': True}, {'seed': 9, 'on_timeout': 'fault'}])
    @pytest.mark.parametrize('scene', ['paper_fig7', 'paper_fig8', 'cutting_force', 'positioning', 'stribeck'])
    def test_a_rig_without_anything_is_the_simulator(self, scene: str, settings: dict[str, Any]) -> None:
        loaded = load_scene(scene)
        grid = Grid(loaded.time.rate)
        bare = Simulator(loaded.axis, loaded.initial, loaded.drive, loaded.force, loaded.solver.make(loaded.axis))
        rig = Rig(loaded.axis, loaded.initial, loaded.drive, loaded.force, loaded.solver.make(loaded.axis), grid,
                  RigSettings(**settings))
        commands: dict[int, tuple[float | None, float | None]] = {
            1000: (0.004, None), 1300: (None, 300.0), 1500: (-0.01, -200.0), 1501: (-0.01, 0.0)}
        for step in range(2000):
            speed, push = commands.get(step, (None, None))
            if speed is not None:
                bare.command_drive(speed)
            if push is not None:
                bare.command_force(push)
            result = rig.make_step(speed, push)
            assert bits(result.events) == bits(bare.advance(grid.instant(step)))
            assert repr(result.sample) == repr(bare.sample())
            if result.measured:
                assert result.measured == (result.sample.position, result.sample.velocity,
                                            result.sample.drive_position, result.sample.drive_velocity)

    def test_what_is_not_measured_is_not_there(self) -> None:
        assert run(make(encoder=EncoderSettings(1e-6)), 3)[-1].measured is None


class TestOrders:
    def test_of_several_before_a_step_the_last_counts(self) -> None:
        rig = make()
        result = run(rig, 11, {10: [change_velocity(5), change_velocity(1000)]})[-1]
        assert (result.velocity, result.sample.drive_velocity, rig.counts.heard) == (0.01, 0.01, 1)

    @pytest.mark.parametrize('step', [0, 1])
    def test_a_fault_ordered_before_the_start_counts_from_it(self, step: int) -> None:
        results = run(make(), 20, {step: [inject('force_pulse', 0.005, 0.003, 50.0)]})
        assert [result.step for result in results if result.sample.external_force] == [6, 7, 8]

    @pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
    def test_what_is_no_number_is_refused(self, value: float) -> None:
        rig = make()
        for name in ('velocity', 'force'):
            with pytest.raises(InputError, match=f'{name} = {value}'):
                rig.make_step(**{name: value})
        assert bits(run(rig, 2)) == bits(run(make(), 2))


class TestAtOnce:
    """What changes together does so together: nothing breaks away in between."""

    HELD = 900.0     # N: beyond the static limit, and within it when friction is doubled

    @pytest.mark.parametrize('kinds', [('force_pulse', 'friction_scale'), ('friction_scale', 'force_pulse')])
    def test_faults_that_begin_and_end_together(self, kinds: tuple[str, str]) -> None:
        values = {'force_pulse': self.HELD, 'friction_scale': 2.0}
        results = run(make(STUCK, 0.0), 200, {10: [inject(kind, value=values[kind]) for kind in kinds]})
        assert [result.step for result in results if result.sample.external_force] == [*range(10, 60)]
        assert [event for result in results for event in result.events] == []

    def test_a_pulse_that_begins_as_friction_falls_breaks_away_once(self) -> None:
        results = run(make(STUCK, 0.0), 40, {10: [inject('force_pulse', value=500.0),
                                                   inject('friction_scale', value=0.5)]})
        first = next(event for result in results for event in result.events)
        assert (first.kind, first.time) == (EventKind.BREAKAWAY, 0.009)

    def test_faults_that_are_cleared_together(self) -> None:
        results = run(make(STUCK, 0.0), 200, {
            10: [inject('friction_scale', value=10.0, duration=1.0), inject('friction_scale', value=0.1, duration=1.0),
                 force(500.0)],
            60: [lambda rig: rig.clear_faults()]})
        assert [event for result in results for event in result.events] == []

    def test_a_change_of_parameters_keeps_the_scaled_friction(self) -> None:
        heavy = replace(STUCK, mass=700.0)
        one = run(make(STUCK, 0.01), 900, {0: [inject('friction_scale', value=2.0, duration=2.0)],
                                           5: [lambda rig: rig.change_axis(heavy)]})
        other = run(make(heavy, 0.01), 900, {0: [inject('friction_scale', value=2.0, duration=2.0)]})
        for of_one, of_other in zip(one, other):
            assert [event.kind for event in of_one.events] == [event.kind for event in of_other.events]
            assert of_one.sample.position == pytest.approx(of_other.sample.position, rel=1e-9, abs=1e-12)
        first = next(event for result in one for event in result.events)
        assert first.friction_force == pytest.approx(2.0 * 823.7586, rel=1e-12)


class TestFailure:
    def test_reset_after_a_solver_gave_up(self) -> None:
        rig = Rig(AXIS, InitialState(), constant(0.002), constant(0.0), tired_after(0.0495), Grid(1000.0),
                  RigSettings(faults=(Fault('s', 'friction_scale', 0.01, 1.0, 3.0),)))
        first = run(rig, 50)
        for _ in range(2):
            with pytest.raises(SolverError, match='time hardly advances'):
                rig.make_step()
        assert rig.step == 49
        rig.reset()
        assert bits(run(rig, 50)) == bits(first)

    def test_reset_after_the_state_left_the_range_of_numbers(self) -> None:
        rig = make(drive=InputProfile((0.0,), (0.0,), (0.0,), sinusoids=(Sinusoid(1e-3, 5.0, 0.0),)))
        first = run(rig, 100)
        with pytest.raises(SolverError):
            run(rig, 100, {100: [velocity(1.7e308)]})
        rig.reset()
        assert bits(run(rig, 100)) == bits(first)


INJECTED, BEGIN, END, CLEARED, TIMEOUT, RESUMED = (
    RigEventKind.FAULT_INJECTED, RigEventKind.FAULT_BEGIN, RigEventKind.FAULT_END, RigEventKind.FAULT_CLEARED,
    RigEventKind.COMMAND_TIMEOUT, RigEventKind.COMMAND_RESUMED)


AGAIN = (3.5, RESUMED, 'velocity', '')


@pytest.mark.parametrize(('events', 'expected'), [
    ([(1.0, INJECTED, 'a', 'force_pulse'), (2.0, BEGIN, 'a', 'force_pulse'), (3.0, END, 'a', 'force_pulse')],
     [Mark(2.0, 3.0, 'force_pulse')]),
    ([(2.0, BEGIN, 'a', 'drive_freeze'), (2.5, BEGIN, 'b', 'command_loss'), (4.0, CLEARED, 'a', 'drive_freeze')],
     [Mark(2.0, 4.0, 'drive_freeze'), Mark(2.5, 10.0, 'command_loss')]),    # cut short, and going on
    ([(1.0, INJECTED, 'a', 'force_pulse'), (1.5, CLEARED, 'a', 'force_pulse')], []),    # cleared before it began
    ([(3.0, END, 'a', 'force_pulse')], [Mark(0.5, 3.0, 'force_pulse')]),    # from before the recording
    ([(1.0, TIMEOUT, 'velocity', ''), (2.0, RESUMED, 'velocity', '')], [Mark(1.0, 2.0, 'time-out')]),
    ([(1.0, TIMEOUT, 'velocity', ''), (3.0, CLEARED, '', '')], [Mark(1.0, 3.0, 'time-out')]),
    ([(1.0, TIMEOUT, 'velocity', '')], [Mark(1.0, 10.0, 'time-out')]),
    ([(1.0, TIMEOUT, 'velocity', ''), (3.0, CLEARED, '', ''), AGAIN], [Mark(1.0, 3.0, 'time-out')]),    # no second one
    ([(3.0, CLEARED, '', ''), AGAIN], [Mark(0.5, 3.0, 'time-out')]), ([AGAIN], [Mark(0.5, 3.5, 'time-out')]),
])
def test_marks(events: list[tuple[float, RigEventKind, str, str]], expected: list[Mark]) -> None:
    assert marks_of_events([TimedRigEvent(*event, 1) for event in events], 0.5, 10.0) == expected


def test_what_was_not_taken_is_an_instant_with_its_number() -> None:
    events = [TimedRigEvent(1.0, RigEventKind.COMMAND_REFUSED, 'velocity', '', 12),
              TimedRigEvent(2.0, RigEventKind.COMMAND_LIMITED, 'velocity', '', 0)]
    found = marks_of_events(events, 0.0, 10.0)
    assert found == [Mark(1.0, 1.0, 'refused', 12), Mark(2.0, 2.0, 'limited', 1)]
    assert not any(mark.is_span for mark in found)


def test_the_faults_of_a_scene_end_with_the_run() -> None:
    faults = [Fault('a', 'force_pulse', 1.0, 2.0, 5.0), Fault('b', 'drive_freeze', 3.0, float('inf'), 0.0),
              Fault('c', 'drive_freeze', 8.0, 1.0, 0.0)]
    assert marks_of_faults(faults, 5.0) == [Mark(1.0, 3.0, 'force_pulse'), Mark(3.0, 5.0, 'drive_freeze')]
