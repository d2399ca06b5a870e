# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The controllers without ROS: their moves, their loop with the exact engine, and what stick-slip is left."""

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest

from benchmarks.controllers import AXIS, PAGE, RATE, SLOW_FEED, by_model, close_loop, controllers, figures, most_delay
from stickslip_sim.axis import CompliantContact
from stickslip_sim.controllers import (
    AT_REST,
    BranchCompensation,
    Cascade,
    Controller,
    Following,
    Memory,
    MoveProgress,
    Moves,
    Setpoint,
    Slide,
)
from stickslip_sim.core.types import Mode
from stickslip_sim.inputs import load_scene
from stickslip_sim.simulation import Measured
from tests.support.linear_loop import loop_matrix

NO_FRICTION = {'axis.normal_force': 0.0}
STILL = Measured(0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Step(Moves):
    """A setpoint that is 0.1 mm from the start on."""

    def at(self, time: float) -> Setpoint:
        return Setpoint(1e-4, 0.0)


class TestMoves:
    def test_at_full_feed_are_those_of_the_scene(self) -> None:
        moves, profile = Moves(travel=0.01, feed=0.01), load_scene('positioning').drive
        assert moves.period == profile.period
        for time in (0.009 * k for k in range(1001)):
            assert moves.at(time).velocity == pytest.approx(profile.value_at(time), abs=1e-14)

    @pytest.mark.parametrize('moves', [Moves(), Moves(0.01, 0.01), Moves(1e-4, 0.05), Moves(0.1, 0.2, 2.0, 0.0)])
    def test_position_is_the_integral_of_the_velocity(self, moves: Moves) -> None:
        points = [moves.at(time) for time in np.linspace(0.0, moves.period, 20_001)]
        step = moves.period / 20_000
        for before, after in pairwise(points):
            assert after.position - before.position == pytest.approx(
                0.5 * step * (before.velocity + after.velocity), abs=moves.acceleration * step * step)
        assert max(point.position for point in points) == moves.travel
        assert max(abs(point.velocity) for point in points) == pytest.approx(moves.peak, rel=1e-3)

    def test_a_short_move_does_not_reach_its_feed(self) -> None:
        moves = Moves(travel=0.0002, feed=0.05, acceleration=0.08, dwell=0.0)
        assert moves.peak == pytest.approx(0.004)
        assert moves.duration == pytest.approx(2.0 * 0.004 / 0.08)

    def test_they_go_on_for_ever(self) -> None:
        moves = Moves()
        assert moves.at(1000.0 * moves.period + 1.0) == pytest.approx(moves.at(1.0), abs=1e-12)
        assert moves.at(0.5 * moves.period) == pytest.approx(Setpoint(moves.travel, 0.0))


class TestLinearLoop:
    """Without friction the loop is linear, and its steps have a closed form that knows nothing of the engine."""

    @pytest.mark.parametrize('delay', [0, 1, 3])
    @pytest.mark.parametrize('gains', [Cascade(), Cascade(20.0, 2.0, 0.05), Cascade(5.0, 16.0, math.inf)])
    def test_step_response(self, gains: Cascade, delay: int) -> None:
        run = close_loop(Controller(gains), Step(), 0.5, delay, NO_FRICTION)
        matrix = loop_matrix(AXIS, gains, delay)
        first = loop_matrix(AXIS, replace(gains, integral_time=math.inf), delay)   # no time went by before it
        state = np.zeros(len(matrix))
        state[[0, 2]] = -1e-4     # seen from the setpoint
        for step, sample in enumerate(run.samples):
            assert sample.position == pytest.approx(state[0] + 1e-4, abs=1e-15)
            assert sample.velocity == pytest.approx(state[1], abs=1e-13)
            state[:] = (matrix if step else first) @ state

    def test_the_default_gains_stand_four_steps_of_delay(self) -> None:
        assert most_delay(Cascade()) == 4
        errors = [abs(close_loop(Controller(Cascade()), Step(), 4.0, delay, NO_FRICTION).samples[-1].position - 1e-4)
                  for delay in (4, 5)]
        assert errors[0] < 1e-9
        assert errors[1] > 1e-4

    def test_the_velocity_gain_is_stiffness_and_damping(self) -> None:
        """With the position loop and the integral part off, the axis is one with 1 + K_p springs and dampers."""
        poles = np.log(np.linalg.eigvals(loop_matrix(AXIS, Cascade(0.0, 3.0, math.inf))[:3, :3]).astype(complex)) * RATE
        fastest = poles[np.argmax(np.abs(poles))]
        assert abs(fastest) == pytest.approx(math.sqrt(4.0 * AXIS.drive_stiffness / AXIS.mass), rel=0.02)
        assert -fastest.real == pytest.approx(0.5 * 4.0 * AXIS.drive_damping / AXIS.mass, rel=0.05)


class TestLimit:
    CONTROLLER = Controller(Cascade(), max_velocity=0.01)

    def test_nothing_winds_up_while_the_drive_is_at_its_limit(self) -> None:
        memory = AT_REST
        for _ in range(1000):
            memory, command = self.CONTROLLER.step(memory, Setpoint(1.0, 0.0), STILL, 1e-3)
            assert command == (0.01, True)
        assert memory.integral == 0.0

    def test_what_was_summed_up_may_go_back(self) -> None:
        wound_up = Memory(0.5, Slide())
        memory, command = self.CONTROLLER.step(wound_up, Setpoint(-1e-3, 0.0), STILL, 1e-3)
        assert command == (0.01, True)
        assert memory.integral < 0.5

    def test_a_large_step_overshoots_no_more_than_a_small_one(self) -> None:
        small, large = (close_loop(Controller(Cascade(), max_velocity=limit), Step(), 2.0, changes=NO_FRICTION)
                        for limit in (1.0, 5e-4))
        assert max(map(abs, large.commands)) == 5e-4
        peaks = [max(sample.position for sample in run.samples) for run in (small, large)]
        assert peaks[1] <= peaks[0]
        assert large.samples[-1].position == pytest.approx(1e-4, abs=1e-8)


class TestCompensation:
    MODEL = BranchCompensation(AXIS, share=0.9, rate=35.0, threshold=1e-4)
    FRICTION = 0.12 * AXIS.normal_force

    def moving(self, force: float, velocity: float = 1e-9) -> Measured:
        """Return a slider that slips under a force of the spring."""
        return Measured(0.0, velocity, force / AXIS.drive_stiffness, velocity)

    @pytest.mark.parametrize(('force', 'wanted', 'missing'), [
        (1.5, 1.0, 0.4),       # in the gap from 1 to 2, faster: up to 1.9
        (1.95, 1.0, 0.0),      # it is there
        (1.5, -1.0, -0.4),     # slower: down to 1.1
        (1.05, -1.0, 0.0),
        (-1.0, 1.0, 2.9),      # a reversal: the spring is still loaded the other way
    ])
    def test_crosses_a_share_of_the_gap(self, force: float, wanted: float, missing: float) -> None:
        slide = Slide(1, 2.0 * self.FRICTION)
        extra = self.MODEL.drive_velocity(slide, wanted, self.moving(force * self.FRICTION))
        assert extra == pytest.approx(35.0 * missing * self.FRICTION / AXIS.drive_stiffness, rel=1e-6, abs=1e-12)
        mirrored = Slide(-1, 2.0 * self.FRICTION)
        assert self.MODEL.drive_velocity(mirrored, -wanted, self.moving(-force * self.FRICTION, -1e-9)) == -extra

    def test_a_small_error_is_answered_softly(self) -> None:
        slide, there = Slide(1, 2.0 * self.FRICTION), self.moving(1.5 * self.FRICTION)
        full, tenth = (self.MODEL.drive_velocity(slide, there.slider_velocity + error, there) for error in (1e-4, 1e-5))
        assert tenth == pytest.approx(0.1 * full)

    def test_a_reversal_begins_a_new_slide(self) -> None:
        slide = Slide().going_on(1e-3, 800.0).going_on(1e-3, 500.0).going_on(0.0, 400.0)
        assert slide == (1, 800.0)
        assert slide.going_on(-1e-3, 300.0) == (-1, 0.0)

    def test_rests_with_the_setpoint(self) -> None:
        memory = Memory(0.0, Slide(1, 2.0 * self.FRICTION))
        there = self.moving(1.5 * self.FRICTION)
        both = [Controller(Cascade(), compensation).step(memory, Setpoint(1e-6, 0.0), there, 1e-3)[1].velocity
                for compensation in (None, self.MODEL)]
        assert both[0] == both[1]

    def test_two_encoders_measure_the_force_of_the_spring(self) -> None:
        run = close_loop(controllers()['compensated'], SLOW_FEED, 1.0)
        for sample in run.samples:
            measured = Measured(sample.position, sample.velocity, sample.drive_position, sample.drive_velocity)
            assert self.MODEL.drive_force(measured) == pytest.approx(sample.drive_force, abs=1e-6)


class TestFollowing:
    FOLLOWING = Following(Controller(Cascade()), Moves(), max_gap=0.5)

    def after(self, *times: float) -> list[bool]:
        """Return which of the measurements at these times begin the moves."""
        progress: MoveProgress | None = None
        is_new = []
        for time in times:
            answer = self.FOLLOWING.answer(progress, round(time * 1e9), STILL)
            progress = answer.progress
            is_new.append(answer.is_new)
        return is_new

    def test_begins_where_the_slider_is_and_when_it_is_heard(self) -> None:
        there = Measured(0.5, 0.0, 0.5, 0.0)
        answer = self.FOLLOWING.answer(None, 77_000_000_000, there)
        assert (answer.setpoint, answer.command.velocity) == (Setpoint(0.5, 0.0), 0.0)
        later = self.FOLLOWING.answer(answer.progress, 77_400_000_000, there)
        assert later.setpoint.position == 0.5 + Moves().at(0.4).position

    def test_a_gap_or_time_that_goes_back_begins_anew(self) -> None:
        assert self.after(10.0, 10.001, 10.5, 10.5) == [True, False, False, False]
        assert self.after(10.0, 10.6, 10.7) == [True, True, False]
        assert self.after(10.0, 10.1, 0.0, 0.001) == [True, False, True, False]


@pytest.mark.parametrize(('moves', 'delay'), [(SLOW_FEED, 0), (SLOW_FEED, 1), (Moves(0.001, 0.0002), 0)])
def test_a_slow_feed_sticks_without_compensation_only(moves: Moves, delay: int) -> None:
    plain, compensated = (figures(close_loop(controller, moves, moves.period, delay))
                          for controller in controllers().values())
    assert plain.sticks >= 10
    assert plain.slowest < 0.0
    assert compensated.sticks == 0
    assert compensated.slowest > 0.3 * moves.feed
    assert compensated.largest_error < 0.5 * plain.largest_error


def test_positioning_ends_where_it_should_with_both() -> None:
    moves = Moves(travel=0.01, feed=0.01)
    for controller in controllers().values():
        its = figures(close_loop(controller, moves, moves.period))
        assert its.end_error < 1e-6
        assert its.overshoot < 5e-5


def test_the_page_has_what_is_measured_today() -> None:
    assert '\n'.join(by_model()) in PAGE.read_text(encoding='utf-8')


class TestPicture:
    """What docs/pictures.md says of docs/images/controllers.png."""

    @pytest.mark.parametrize(('threshold', 'chatters'), [(1e-4, True), (3e-4, False)])
    def test_chatter_in_stick(self, threshold: float, chatters: bool) -> None:
        compensation = BranchCompensation(AXIS, threshold=threshold)
        samples = close_loop(Controller(Cascade(), compensation), SLOW_FEED, 5.3).samples[4900:]
        assert {sample.mode for sample in samples} == {Mode.STICK}
        changes = np.abs(np.diff([sample.drive_velocity for sample in samples]))
        assert (np.count_nonzero(changes > 3e-3) > 50) == chatters

    def test_motion_in_stick(self) -> None:
        samples = close_loop(controllers()['compensated'], SLOW_FEED, 5.37).samples[4870:]
        assert {sample.mode for sample in samples} == {Mode.STICK}
        moved = samples[0].position - samples[-1].position
        assert isinstance(AXIS.contact, CompliantContact)
        change = samples[0].drive_force - samples[-1].drive_force
        assert moved == pytest.approx(change / AXIS.contact.stiffness, rel=0.02)
        assert moved == pytest.approx(0.23e-3, rel=0.02)
