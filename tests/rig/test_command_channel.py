# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The way of a drive velocity to the drive: what a fault loses or delays, and in which order the rest arrives."""

import math
import random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stickslip_sim.core.time_grid import Grid
from stickslip_sim.rig import Fault, RigEventKind
from stickslip_sim.rig.command_channel import CommandChannel
from tests.support.rigs import Script, force, inject, make, rig_events_of, run, velocity

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

    def test_all_commands_come_in_their_order(self) -> None:
        script: Script = {step: [velocity(step * 1e-4)] for step in range(10, 40)}
        speeds = [result.sample.drive_velocity
                  for result in run(make(faults=(Fault('d', 'command_delay', 0.0, math.inf, 0.02),)), 70, script)]
        assert speeds[30:60] == [step * 1e-4 for step in range(10, 40)]

    def test_what_comes_undelayed_overtakes(self) -> None:
        script: Script = {10: [inject('command_delay', 0.0, 0.005, 0.02), velocity(0.03)],
                          20: [velocity(0.01)]}
        speeds = [result.sample.drive_velocity for result in run(make(), 60, script)]
        assert set(speeds[20:]) == {0.01}

    @given(st.lists(st.tuples(st.integers(0, 20), st.integers(0, 60)), max_size=12), st.integers(0, 2**32))
    def test_a_command_never_undoes_a_later_one(self, sends: list[tuple[int, int]], seed: int) -> None:
        channel, stream = CommandChannel(GRID, 0), random.Random(seed)
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
            faults = {str(i): Fault(str(i), 'command_delay', 0.0, 1.0, part / 1000) for i, part in enumerate(parts)}
            assert channel.put(number, step + 1, faults)
            under_way.append((step + 1 + delay, number))
