# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Encoders: what they round, shift, delay and disturb, against the formula in their words."""

import math
import statistics
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stickslip_sim.core.errors import InputError
from stickslip_sim.inputs import load_scene
from stickslip_sim.simulation import Measured, StepResult
from stickslip_sim.simulation.encoder import Encoder, EncoderSettings
from tests.support.rigs import RATE, Script, inject, make, run

MICRON = 1e-6


def motion(position: float) -> tuple[float, float, float, float]:
    """Return what encoders look at: the slider at rest, the drive at twice its position."""
    return position, 0.0, 2 * position, 3.0


def measured(steps: int = 900, script: Script | None = None, delay_steps: int = 0, seed: int = 0, **encoder: Any
             ) -> tuple[list[StepResult], list[Measured]]:
    """Return a run of the paper's axis, and its measurements, none of which may be missing."""
    results = run(make(seed=seed, measures=True, encoder=EncoderSettings(**encoder),
                        encoder_delay_steps=delay_steps), steps, script)
    readings = [result.measured for result in results if result.measured]
    assert len(readings) == len(results)
    return results, readings


class TestPosition:
    @given(st.floats(-10.0, 10.0), st.sampled_from([1e-3, MICRON, 7.3e-9, 0.25]), st.floats(-1.0, 1.0))
    def test_is_the_nearest_count(self, position: float, resolution: float, offset: float) -> None:
        reading = Encoder(EncoderSettings(resolution, offset), RATE, 0, 0).measure(*motion(position))
        assert reading is not None
        for value, true in ((reading.slider_position, position), (reading.drive_position, 2 * position)):
            count = value / resolution
            assert count == pytest.approx(round(count), abs=1e-6)
            assert abs(value - (true + offset)) <= resolution / 2 * (1 + 1e-6) + 1e-15

    @pytest.mark.parametrize(('position', 'count'), [(0.49, 0), (0.5, 1), (1.49, 1), (-0.5, 0), (-0.51, -1), (2.5, 3)])
    def test_halves_go_up_so_that_no_count_is_wider(self, position: float, count: int) -> None:
        reading = Encoder(EncoderSettings(0.25), RATE, 0, 0).measure(*motion(0.25 * position))
        assert reading is not None
        assert reading.slider_position == 0.25 * count

    def test_delay_in_steps(self) -> None:
        results, readings = measured(delay_steps=7, delay=0.007)
        for n, reading in enumerate(readings):
            then = results[max(n - 7, 0)].sample
            assert (reading.slider_position, reading.drive_position) == (then.position, then.drive_position)


class TestVelocity:
    @pytest.mark.parametrize('k', [1, 4, 50])
    def test_is_the_difference_quotient(self, k: int) -> None:
        _, readings = measured(resolution=MICRON, velocity_steps=k)
        for n, reading in enumerate(readings):
            before = readings[max(n - k, 0)]
            assert reading.slider_velocity == (reading.slider_position - before.slider_position) * (RATE / k)
            assert reading.drive_velocity == (reading.drive_position - before.drive_position) * (RATE / k)

    def test_is_the_true_one_of_an_ideal_encoder(self) -> None:
        results, readings = measured(velocity_steps=5)
        for result, reading in zip(results, readings):
            truth = result.sample
            assert reading == (truth.position, truth.velocity, truth.drive_position, truth.drive_velocity)


class TestNoise:
    COUNT = 20_000

    def readings(self, seed: int, **settings: Any) -> list[Measured]:
        encoder = Encoder(EncoderSettings(noise=MICRON, **settings), RATE, 0, seed)
        found = [encoder.measure(*motion(0.1)) for _ in range(self.COUNT)]
        return [reading for reading in found if reading]

    def test_is_normal(self) -> None:
        errors = [(reading.slider_position - 0.1) / MICRON for reading in self.readings(1)]
        assert statistics.fmean(errors) == pytest.approx(0.0, abs=4 / math.sqrt(self.COUNT))
        assert statistics.stdev(errors) == pytest.approx(1.0, abs=4 / math.sqrt(2 * self.COUNT))
        for sigmas, share in ((1.0, 0.6827), (2.0, 0.9545), (3.0, 0.9973)):
            within = sum(abs(error) < sigmas for error in errors) / self.COUNT
            assert within == pytest.approx(share, abs=4 * math.sqrt(share * (1 - share) / self.COUNT))

    def test_of_the_two_encoders_has_nothing_in_common(self) -> None:
        pairs = [(reading.slider_position, reading.drive_position) for reading in self.readings(1)]
        assert statistics.correlation(*zip(*pairs)) == pytest.approx(0.0, abs=4 / math.sqrt(self.COUNT))

    def test_is_that_of_the_seed(self) -> None:
        assert self.readings(2**62 + 5) == self.readings(2**62 + 5)
        assert self.readings(2**62 + 5)[:9] != self.readings(5)[:9]      # all of the seed counts

    def test_is_rounded_with_the_position(self) -> None:
        positions = {reading.slider_position for reading in self.readings(3, resolution=MICRON)}
        assert positions <= {MICRON * math.floor(0.1 / MICRON + k + 0.5) for k in range(-6, 7)}
        assert len(positions) > 4


class TestFaults:
    @pytest.mark.parametrize('settings', [{}, {'resolution': MICRON}])
    def test_freeze(self, settings: dict[str, Any]) -> None:
        results, readings = measured(900, {800: [inject('encoder_freeze', duration=0.05)]}, **settings)
        assert {reading.slider_position for reading in readings[799:850]} == {readings[799].slider_position}
        assert {reading.slider_velocity for reading in readings[801:850]} == {0.0}
        assert readings[850].slider_position == pytest.approx(results[850].sample.position, abs=MICRON / 2)
        assert readings[849].drive_position == pytest.approx(results[849].sample.drive_position, abs=MICRON / 2)

    @pytest.mark.parametrize('settings', [{}, {'resolution': MICRON}])
    def test_step(self, settings: dict[str, Any]) -> None:
        script = {300: [inject('encoder_step', value=1e-3)], 320: [inject('encoder_step', value=5e-4)]}
        results, readings = measured(400, script, **settings)
        for (step, shift) in ((299, 0.0), (300, 1e-3), (319, 1e-3), (320, 1.5e-3), (350, 5e-4), (370, 0.0)):
            assert readings[step].slider_position - results[step].sample.position == pytest.approx(shift, abs=MICRON)

    def test_step_is_a_jump_of_the_velocity_where_it_is_computed(self) -> None:
        _, readings = measured(400, {300: [inject('encoder_step', value=1e-3)]}, resolution=MICRON)
        assert readings[300].slider_velocity == pytest.approx(1.0, abs=2e-3)     # 1 mm in a step

    def test_dropouts_that_overlap_leave_out_more(self) -> None:
        count = 4000
        results = run(make(measures=True), count + 1,
                       {1: [inject('encoder_dropout', value=0.5, duration=math.inf)] * 2})
        missing = sum(result.measured is None for result in results)
        assert missing / count == pytest.approx(0.75, abs=4 * math.sqrt(0.19 / count))

    def test_dropout_of_all(self) -> None:
        results = run(make(measures=True), 100, {10: [inject('encoder_dropout', value=1.0, duration=0.02)]})
        assert [result.step for result in results if result.measured is None] == [*range(10, 30)]

    def test_after_a_dropout_readings_are_as_if_none_had_been(self) -> None:
        encoder = EncoderSettings(MICRON, noise=MICRON, velocity_steps=3)
        script = {10: [inject('encoder_dropout', value=0.5, duration=0.02)]}
        with_it, without = (run(make(measures=True, encoder=encoder), 100, orders) for orders in (script, None))
        assert [result.measured for result in with_it[30:]] == [result.measured for result in without[30:]]


class TestScene:
    @pytest.mark.parametrize(('name', 'value', 'reason'), [
        ('delay', 0.0015, 'whole steps of 0.001 s'), ('delay', 1e-9, 'whole steps'), ('delay', -0.001, '>= 0'),
        ('resolution', 1e-16, '0, or at least 1e-15 m'), ('resolution', -1e-6, '>= 0'), ('noise', -1.0, '>= 0'),
        ('noise', math.inf, '<= 1'), ('resolution', math.nan, '>= 0'), ('velocity_steps', 0, '>= 1'),
    ])
    def test_refused(self, name: str, value: float, reason: str) -> None:
        with pytest.raises(InputError, match=rf'encoder\.{name} = .*{reason}'):
            load_scene('paper_fig8', {f'encoder.{name}': value})

    @pytest.mark.parametrize(('rate', 'delay', 'steps'), [(1000.0, 0.003, 3), (333.3, 10.0 / 3333, 1), (3.0, 1.0, 3),
                                                          (20000.0, 0.00005, 1), (500.0, 0.3, 150)])
    def test_delay_is_whole_steps(self, rate: float, delay: float, steps: int) -> None:
        given = {'time.rate': rate, 'encoder.delay': delay, 'joint_interface.enabled': True}
        assert load_scene('paper_fig8', given).rig.encoder_delay_steps == steps

    def test_the_finest_resolution_at_the_farthest_place(self) -> None:
        scene = load_scene('paper_fig8', {'encoder.resolution': 1e-15, 'initial.position': 1e12,
                                          'joint_interface.enabled': True})
        reading = scene.make_rig().make_step().measured
        assert reading is not None
        assert reading.slider_position == pytest.approx(1e12)
