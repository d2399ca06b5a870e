# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The drive: within its limits by closed forms, and the way of a velocity to it, with what a fault loses or delays."""

import math
import random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stickslip_sim.axis import InitialState
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.core.types import Instant
from stickslip_sim.simulation import Fault, Rig, RigEventKind, StepResult
from stickslip_sim.simulation.drive import CommandChannel, Drive, DriveLimits
from stickslip_sim.simulation.faults import Faults
from stickslip_sim.simulation.simulator import Simulator
from tests.support.rigs import AXIS, bits, force, inject, make, rig_events_of, run, velocity

WAVY = InputProfile((0.0,), (0.002,), (0.0,), sinusoids=(Sinusoid(1e-3, 3.0, 0.4), Sinusoid(5e-4, 11.0, 0.0)))


def limited(velocity: float = math.inf, acceleration: float = math.inf, **settings: Any) -> Rig:
    return make(limits=DriveLimits(velocity, acceleration), **settings)


def drive_velocities(results: list[StepResult]) -> list[float]:
    return [result.sample.drive_velocity for result in results]


class TestRamp:
    @given(st.lists(st.tuples(st.integers(1, 80), st.floats(-0.2, 0.2)), min_size=1, max_size=8),
           st.floats(0.01, 10.0))
    def test_retargeted_in_mid_ramp_never_faster_than_allowed(self, targets: list[tuple[int, float]],
                                                              acceleration: float) -> None:
        rig, speeds, positions = limited(acceleration=acceleration, drive=0.0), [0.0], [0.0]
        run(rig, 1)
        for steps, target in targets:
            for step in range(steps):
                sample = rig.make_step(None if step else target).sample
                expected = approach(speeds[-1], target, acceleration, 1e-3)
                assert sample.drive_velocity == pytest.approx(expected[0], rel=1e-9, abs=1e-15)
                assert sample.drive_position - positions[-1] == pytest.approx(expected[1], rel=1e-9, abs=1e-15)
                speeds.append(sample.drive_velocity)
                positions.append(sample.drive_position)

    @pytest.mark.parametrize('second', [1e5, 1e7])
    def test_at_late_times(self, second: float) -> None:
        now = Instant(second, 0.123)
        simulator = Simulator(AXIS, InitialState(), constant(0.0), constant(0.0))
        simulator.advance(now)
        drive = Drive(constant(0.0), DriveLimits(acceleration=0.5), 1e-3)
        drive.follow(0.1, now)
        simulator.command_drive(drive.profile)
        for k in range(1, 400):
            later = Instant(second, 0.123 + k * 1e-3)
            simulator.advance(later)
            sample, time = simulator.sample(), k * 1e-3
            ulp = math.ulp(second)     # of the instants that a profile is made of
            assert sample.drive_velocity == pytest.approx(min(0.5 * time, 0.1), abs=0.5 * 4 * ulp)
            ramp = min(time, 0.2)
            assert sample.drive_position == pytest.approx(0.25 * ramp**2 + 0.1 * (time - ramp), abs=0.1 * 8 * ulp)
        assert simulator.sample().drive_velocity == 0.1

    def test_too_short_for_the_clock_is_a_jump(self) -> None:
        drive = Drive(constant(0.0), DriveLimits(acceleration=1e9), 1e-3)
        drive.follow(1e-9, Instant(1e9, 0.5))
        assert drive.profile == 1e-9


def approach(speed: float, target: float, acceleration: float, time: float) -> tuple[float, float]:
    """Return the velocity after a time, and the way until then."""
    ramp = min(abs(target - speed) / acceleration, time)
    reached = speed + math.copysign(acceleration, target - speed) * ramp if ramp == time else target
    return reached, (speed + reached) / 2 * ramp + target * (time - ramp)


class TestLimits:
    def test_are_counted_and_the_first_of_a_row_is_reported(self) -> None:
        rig = limited(0.01)
        script = {10: [velocity(0.5)], 11: [velocity(0.6)], 12: [velocity(0.005)], 13: [velocity(-0.5)]}
        results = run(rig, 20, script)
        assert drive_velocities(results)[9:14] == [0.002, 0.01, 0.01, 0.005, -0.01]
        assert (rig.counts.limited, rig.counts.heard) == (3, 4)
        assert rig_events_of(results) == [(10, RigEventKind.COMMAND_LIMITED), (13, RigEventKind.COMMAND_LIMITED)]
        assert [event.value for result in results for event in result.rig_events] == [0.5, -0.5]

    @pytest.mark.parametrize(('acceleration', 'follows'), [(0.2, True), (0.05, False)])
    def test_are_counted_where_the_drive_has_not_what_was_commanded(self, acceleration: float, follows: bool) -> None:
        """A setpoint that needs up to 0.1 m/s²: each command is another, none a jump that the drive cannot make."""
        rig = limited(acceleration=acceleration, drive=0.0)
        commands = {step: 1e-4 * min(step, 100) for step in range(1, 301)}
        speeds = drive_velocities(run(rig, 301, {step: [velocity(value)] for step, value in commands.items()}))
        missed = sum(abs(speeds[step] - value) > 1e-12 for step, value in commands.items())
        assert (rig.counts.limited, missed == 0) == (missed, follows)

    def test_what_comes_while_the_drive_is_frozen_is_no_matter_of_its_limits(self) -> None:
        rig = limited(0.02, 1.0)
        run(rig, 120, {50: [inject('drive_freeze')], 60: [velocity(0.01)], 70: [velocity(0.03)]})
        assert rig.counts.limited == 1       # beyond what it may ever have

    def test_leave_the_profile_of_the_scene_alone(self) -> None:
        assert bits(run(limited(1e-4, 1e-4, drive=WAVY), 100)) == bits(run(make(drive=WAVY), 100))

    def test_a_sine_of_the_scene_is_left_from_where_it_is(self) -> None:
        results = run(limited(acceleration=0.1, drive=WAVY), 200, {101: [velocity(0.01)]})
        at_first = WAVY.value_at(0.1)
        assert drive_velocities(results)[100] == pytest.approx(at_first, rel=1e-12)
        assert drive_velocities(results)[101] == pytest.approx(at_first + 1e-4, rel=1e-12)


class TestFreeze:
    def test_stands_still_at_once_and_goes_on_to_the_latest_command(self) -> None:
        results = run(make(), 200, {50: [velocity(0.01)], 100: [inject('drive_freeze')], 120: [velocity(0.02)]})
        speeds = drive_velocities(results)
        assert [speeds[step] for step in (99, 100, 149, 150)] == [0.01, 0.0, 0.0, 0.02]
        assert len({results[step].sample.drive_position for step in range(99, 150)}) == 1

    def test_goes_on_within_the_limits(self) -> None:
        rig = limited(acceleration=0.1, drive=0.004)
        speeds = drive_velocities(run(rig, 300, {50: [velocity(0.005)], 100: [inject('drive_freeze')]}))
        assert (speeds[99], speeds[100], speeds[149]) == (0.005, 0.0, 0.0)
        assert speeds[150:200] == pytest.approx([k * 1e-4 for k in range(1, 51)], rel=1e-12)

    def test_the_profile_of_the_scene_goes_on_when_nothing_was_commanded(self) -> None:
        results = run(make(drive=WAVY), 300, {100: [inject('drive_freeze')]})
        for result in results[:99] + results[150:]:
            assert result.sample.drive_velocity == pytest.approx(WAVY.value_at(result.sample.time), rel=1e-12)
        assert set(drive_velocities(results)[100:149]) == {0.0}

    def test_cleared_as_a_command_comes(self) -> None:
        script = {100: [inject('drive_freeze', duration=math.inf)],
                  120: [lambda rig: rig.clear_faults(), velocity(0.03)]}
        assert drive_velocities(run(make(), 140, script))[119:121] == [0.0, 0.03]


class TestTimeOut:
    """What follows a time-out; when there is one: test_watchdog."""

    def test_hold(self) -> None:
        rig = make()
        results = run(rig, 200, {50: [velocity(0.01)], 100: [lambda rig: rig.time_out(0.5)], 150: [velocity(0.02)]})
        assert set(drive_velocities(results)[100:150]) == {0.01}
        assert rig_events_of(results) == [(100, RigEventKind.COMMAND_TIMEOUT), (150, RigEventKind.COMMAND_RESUMED)]
        assert (rig.counts.timed_out, rig.is_silent, rig.has_failed) == (1, False, False)

    @pytest.mark.parametrize(('limit', 'rate'), [(math.inf, 0.2), (0.1, 0.1)])
    def test_ramp_to_zero(self, limit: float, rate: float) -> None:
        rig = limited(acceleration=limit, drive=0.01, on_timeout='ramp_to_zero', timeout_deceleration=0.2)
        speeds = drive_velocities(run(rig, 300, {101: [lambda rig: rig.time_out(0.5)]}))
        assert speeds[101:] == pytest.approx([max(0.01 - rate * k * 1e-3, 0.0) for k in range(1, 200)], abs=1e-15)
        assert rig.is_silent

    @pytest.mark.parametrize('command', [0.0, 0.03])
    def test_the_next_command_ends_the_ramp(self, command: float) -> None:
        rig = make(on_timeout='ramp_to_zero', timeout_deceleration=0.01)
        speeds = drive_velocities(run(rig, 150, {100: [lambda rig: rig.time_out(0.5)], 120: [velocity(command)]}))
        assert 0.0 < speeds[119] < 0.002
        assert speeds[120:] == [command] * 30

    def test_fault_takes_no_command_until_it_is_cleared(self) -> None:
        rig = make(on_timeout='fault', timeout_deceleration=1.0)
        results = run(rig, 200, {100: [lambda rig: rig.time_out(0.5)], 120: [velocity(0.01)], 130: [velocity(0.01)],
                                  150: [lambda rig: rig.clear_faults()], 160: [velocity(0.03)]})
        speeds = drive_velocities(results)
        assert set(speeds[103:160]) == {0.0}
        assert speeds[160] == 0.03
        assert (rig.counts.refused, rig.counts.heard, rig.has_failed) == (2, 1, False)
        assert [kind for _, kind in rig_events_of(results)] == [
            RigEventKind.COMMAND_TIMEOUT, RigEventKind.FAULT_CLEARED, RigEventKind.COMMAND_RESUMED]

    def test_fault_is_forgotten_by_reset(self) -> None:
        rig = make(on_timeout='fault')
        run(rig, 20, {10: [lambda rig: rig.time_out(0.5)]})
        failed = rig.has_failed
        rig.reset()
        assert (failed, rig.has_failed) == (True, False)
        assert drive_velocities(run(rig, 20, {10: [velocity(0.01)]}))[10] == 0.01

    def test_while_the_drive_is_frozen(self) -> None:
        rig = make(on_timeout='ramp_to_zero', faults=(Fault('f', 'drive_freeze', 0.05, 0.05, 0.0),))
        speeds = drive_velocities(run(rig, 200, {20: [velocity(0.01)], 70: [lambda rig: rig.time_out(0.5)]}))
        assert set(speeds[51:]) == {0.0}


GRID = Grid(1000.0)


class TestLoss:
    @pytest.mark.parametrize('shares', [[0.3], [0.9], [0.5, 0.5]])
    def test_share(self, shares: list[float]) -> None:
        count, kept = 4000, math.prod(1.0 - share for share in shares)
        rig = make(seed=11, faults=tuple(Fault('', 'command_loss', 0.0, math.inf, share) for share in shares))
        results = run(rig, count + 1, {step: [velocity(0.01)] for step in range(1, count + 1)})
        assert rig.counts.lost + rig.counts.heard == count
        assert rig.counts.heard / count == pytest.approx(kept, abs=4 * math.sqrt(kept * (1 - kept) / count))
        assert [kind for _, kind in rig_events_of(results)].count(RigEventKind.COMMAND_LOST) == rig.counts.lost

    def test_of_all(self) -> None:
        results = run(make(), 60, {10: [inject('command_loss', duration=0.02, value=1.0)],
                                    15: [velocity(0.05)],
                                    40: [velocity(0.07)]})
        assert [results[step].sample.drive_velocity for step in (15, 39, 40)] == [0.002, 0.002, 0.07]

    def test_forces_are_not_lost(self) -> None:
        results = run(make(), 30, {10: [inject('command_loss', value=1.0), force(9.0)]})
        assert results[10].sample.external_force == 9.0


class TestDelay:
    @pytest.mark.parametrize(('rate', 'delay', 'late'), [
        (1000.0, 0.005, 5), (1000.0, 0.0051, 6), (1000.0, 1e-9, 1), (333.3, 0.03, 10), (3.0, 1.0, 3), (500.0, 0.3, 150),
    ])
    def test_is_exact_in_steps(self, rate: float, delay: float, late: int) -> None:
        rig = make(rate=rate, faults=(Fault('d', 'command_delay', 0.0, math.inf, delay),))
        results = run(rig, 12 + late, {10: [velocity(0.01)]})
        speeds = [result.sample.drive_velocity for result in results]
        assert speeds[10 + late - 1:10 + late + 1] == [0.002, 0.01]
        assert rig.counts.heard == 1

    def test_those_that_overlap_add_up_in_steps(self) -> None:
        rig = make(faults=tuple(Fault('', 'command_delay', 0.0, math.inf, delay) for delay in (0.1, 0.2)))
        speeds = [result.sample.drive_velocity
                  for result in run(rig, 320, {10: [velocity(0.01)]})]
        assert speeds.index(0.01) == 310

    @given(st.lists(st.tuples(st.integers(0, 20), st.integers(0, 60)), max_size=12), st.integers(0, 2**32))
    def test_a_command_never_undoes_a_later_one(self, sends: list[tuple[int, int]], seed: int) -> None:
        channel, stream = CommandChannel(0), random.Random(seed)
        under_way: list[tuple[int, int]] = []      # arrival, number
        step = newest = 0
        for number, (pause, delay) in enumerate(sends, 1):
            for _ in range(pause + 1):
                step += 1
                taken = channel.take(step)
                due = [sent for arrival, sent in under_way if arrival == step and sent > newest]
                assert taken == (max(due) if due else None)
                newest = max([newest, *due])
            parts = [delay // 3, delay - delay // 3] if stream.random() < 0.5 else [delay]
            faults = Faults(GRID, [Fault(str(i), 'command_delay', 0.0, 1.0, part / 1000) for i, part in enumerate(parts)
                                   if part])
            faults.enter(1)
            assert channel.put(number, step + 1, faults.effect)
            under_way.append((step + 1 + delay, number))
