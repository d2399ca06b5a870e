# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures that limits are set for: against closed forms and the events of the exact engine."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from stickslip_sim.check.limits import limits_of, outcomes_of
from stickslip_sim.core.types import EventKind
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import RunFacts, read_run, write_bag
from stickslip_sim.recording.reader import Bag
from stickslip_sim.runs import samples, simulate
from stickslip_sim.scene import scene_from_values
from stickslip_sim.scene.ros_yaml import read_yaml
from tests.support.check_files import (
    DECAY,
    FREE,
    FREQUENCY,
    START_VELOCITY,
    free_position,
    measured,
    of_limits,
    simulated,
)

PEAK_TIME = math.atan2(FREQUENCY, DECAY) / FREQUENCY   # of the first swing; between two samples

# paper_fig7 in 40-digit arithmetic
FIRST_BREAK_AWAY, FIRST_ARREST, SECOND_BREAK_AWAY = 0.67979883333333, 0.83862368925988008, 1.3313467055455221
ARREST_POSITION = 1.3615322557025e-3
PEAK_SPEED = 1.45614975366e-2


class TestClosedForms:
    """The free axis swings out from 0 at 0.1 m/s."""

    def test_following_error_is_the_largest_of_the_samples(self) -> None:
        positions = [abs(free_position(k / 1000)) for k in range(501)]
        assert measured('following_error: {max: 1.0}', simulated(FREE, 0.5)) == pytest.approx(max(positions), rel=1e-12)

    def test_following_error_of_a_reference(self) -> None:
        text = 'reference: {times: [0.1, 0.2], positions: [0.0, 1.0e-2]}\nlimits: {following_error: {max: 1.0}}'
        errors = [abs(0.01 * min(max(k / 100 - 1.0, 0.0), 1.0) - free_position(k / 1000)) for k in range(501)]
        assert of_limits(text, simulated(FREE, 0.5))['following_error'].value == pytest.approx(max(errors), rel=1e-12)

    def test_end_position_error(self) -> None:
        value = measured('end_position_error: {target: 0.001, max: 1.0, window: {end: 0.25}}', simulated(FREE, 0.5))
        assert value == pytest.approx(abs(free_position(0.25) - 0.001), rel=1e-12)

    @pytest.mark.parametrize('sign', [1.0, -1.0])
    def test_overshoot_between_the_samples(self, sign: float) -> None:
        scene = scene_from_values({'initial.velocity': sign * START_VELOCITY})
        value = measured(f'overshoot: {{target: {sign * 1e-3}, max: 1.0}}', simulated(scene, 0.5))
        assert value == pytest.approx(free_position(PEAK_TIME) - 1e-3, rel=1e-12)

    def test_overshoot_of_a_target_that_is_not_passed(self) -> None:
        assert measured('overshoot: {target: 0.01, max: 0.0}', simulated(FREE, 0.5)) == 0.0

    @pytest.mark.parametrize('band', [1e-3, 3e-4, 1e-5])
    def test_settling_time(self, band: float) -> None:
        value = measured(f'settling_time: {{target: 0.0, band: {band!r}, max: 9.0}}', simulated(FREE, 3.0))
        swing = math.pi / FREQUENCY
        extremes = [PEAK_TIME + k * swing for k in range(80)]
        last = max(time for time in extremes if abs(free_position(time)) > band)
        crossing = brentq(lambda time: abs(free_position(time)) - band, last, last + 0.6 * swing, xtol=1e-14)
        assert value == pytest.approx(crossing, abs=1e-9)

    def test_settling_counts_from_the_start_of_the_window(self) -> None:
        whole = measured('settling_time: {target: 0.0, band: 1.0e-4, max: 9.0}', simulated(FREE, 3.0))
        part = measured('settling_time: {target: 0.0, band: 1.0e-4, max: 9.0, window: {begin: 0.2}}',
                        simulated(FREE, 3.0))
        assert part == pytest.approx(whole - 0.2, abs=1e-12)

    def test_settling_that_never_comes_or_is_always_there(self) -> None:
        found = simulated(FREE, 0.1)
        outcome = of_limits('limits: {settling_time: {target: 0.0, band: 1.0e-6, max: 1.0e+6}}', found)['settling_time']
        assert (outcome.value, outcome.passed) == (math.inf, False)
        assert measured('settling_time: {target: 0.0, band: 1.0, max: 0.0}', found) == 0.0

    def test_peak_speed(self) -> None:
        assert measured('peak_speed: {max: 1.0}', simulated(FREE, 0.5)) == START_VELOCITY

    def test_an_axis_without_friction_never_sticks(self) -> None:
        found = simulated(FREE, 0.5)
        assert measured('sticks: {max: 0}', found) == 0
        assert measured('longest_stick: {max: 0.0}', found) == 0.0


class TestStickSlip:
    """paper_fig7: rigid contact, 2 mm/s, from prolonged rest."""

    def test_following_error_grows_with_the_feed_in_stick(self) -> None:
        value = measured('following_error: {max: 1.0, window: {end: 0.5}}', simulated('paper_fig7', 1.0))
        assert value == pytest.approx(0.002 * 0.5, rel=1e-12)

    def test_a_contact_that_yielded_and_holds_again_is_no_new_stick(self) -> None:
        load = {'normal_load.course': 'sine', 'normal_load.amplitude': 343.0, 'normal_load.frequency': 25.0}
        found = simulate(load_scene('paper_fig8', load), 4.0, 0.001)
        held = [before.kind for before, event in pairwise(found.events) if event.kind == EventKind.STICK]
        assert 0 < held.count(EventKind.YIELD) < len(held)
        assert measured('sticks: {max: 99}', found) == len(held) - held.count(EventKind.YIELD)

    def test_sticks_within_the_window(self) -> None:
        found = simulated('paper_fig7', 1.4)
        assert measured('sticks: {max: 9}', found) == 1
        assert measured(f'sticks: {{max: 9, window: {{end: {FIRST_ARREST - 1e-9!r}}}}}', found) == 0
        assert measured(f'sticks: {{max: 9, window: {{begin: {FIRST_ARREST - 1e-9!r}}}}}', found) == 1

    def test_longest_stick_and_the_rest_at_the_start(self) -> None:
        found = simulated('paper_fig7', 1.5)
        assert measured('longest_stick: {max: 1.0}', found) == pytest.approx(FIRST_BREAK_AWAY, abs=1e-12)
        after = measured('longest_stick: {max: 1.0, window: {begin: 0.5}}', found)
        assert after == pytest.approx(SECOND_BREAK_AWAY - FIRST_ARREST, abs=1e-12)
        cut = measured('longest_stick: {max: 1.0, window: {begin: 0.9, end: 1.3}}', found)
        assert cut == pytest.approx(0.4, abs=1e-12)

    def test_peak_speed_is_that_of_the_event(self) -> None:
        assert measured('peak_speed: {max: 1.0}', simulated('paper_fig7', 1.0)) == pytest.approx(PEAK_SPEED, rel=1e-10)

    def test_overshoot_and_end_position_of_a_jump(self) -> None:
        found = simulated('paper_fig7', 1.0)
        beyond = measured('overshoot: {target: 0.001, max: 1.0}', found)
        assert beyond == pytest.approx(ARREST_POSITION - 1e-3, abs=1e-15)
        end = measured('end_position_error: {target: 0.0, max: 1.0}', found)
        assert end == pytest.approx(ARREST_POSITION, abs=1e-15)

    def test_limit_cycle_amplitude(self) -> None:
        found = simulated('paper_fig7', 20.0)
        value = measured('limit_cycle_amplitude: {cycles: 3, max: 1.0}', found)
        fine = simulate(load_scene('paper_fig7'), 20.0, 1e-4).samples
        last = fine['time'] > 18.0
        expected = np.ptp((fine['drive_position'] - fine['position'])[last])
        assert value == pytest.approx(expected, abs=1e-7)   # what a peak moves in half a step
        assert value <= expected

    def test_no_limit_cycle_without_cycles(self) -> None:
        outcome = of_limits('limits: {limit_cycle_amplitude: {max: 0.0}}', simulated('fast_feed', 1.0))
        assert outcome['limit_cycle_amplitude'].value == 0.0
        assert 'no complete cycle' in outcome['limit_cycle_amplitude'].remark


def test_a_limit_may_be_met_exactly_and_not_exceeded() -> None:
    found = simulated(FREE, 0.5)
    for maximum, passed in ((START_VELOCITY, True), (math.nextafter(START_VELOCITY, 0.0), False)):
        outcome = of_limits(f'limits: {{peak_speed: {{max: {maximum!r}}}}}', found)['peak_speed']
        assert (outcome.passed, outcome.margin == 0.0) == (passed, passed)


def test_windows_and_targets_of_the_file_hold_for_limits_without_their_own() -> None:
    found = simulated('positioning', 3.0)
    outcomes = of_limits('window: {begin: 1.0, end: 2.0}\ntarget: 0.01\nlimits:\n'
                      '  end_position_error: {max: 1.0}\n'
                      '  later: {check: end_position_error, max: 1.0, window: {end: 3.0}, target: 0.0}\n', found)
    assert outcomes['end_position_error'].value == of_limits(
        'limits: {x: {check: end_position_error, target: 0.01, max: 1.0, window: {end: 2.0}}}', found)['x'].value
    assert outcomes['later'].span == (1.0, 3.0)
    assert outcomes['later'].value == measured('end_position_error: {target: 0.0, max: 1.0}', found)


# A check looks at a run block by block: the size of the blocks changes nothing, and no column is held whole.

LIMITS = limits_of(read_yaml('''
limits:
  following_error: {max: 1.0}
  error of a reference part: {check: following_error, max: 1.0, window: {begin: 0.7001, end: 0.7003}}
  end_position_error: {target: 1.0e-3, max: 1.0}
  overshoot: {target: 2.0e-3, max: 1.0}
  settling_time: {target: 2.0e-3, band: 8.0e-4, max: 9.0}
  settling at an event: {check: settling_time, target: 1.0e-3, band: 9.0e-4, max: 9.0, window: {begin: 0.6}}
  sticks: {max: 9}
  longest_stick: {max: 9.0, window: {begin: 0.9, end: 1.7}}
  limit_cycle_amplitude: {max: 1.0}
  peak_speed: {max: 1.0, window: {begin: 0.65}}
'''))


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    scene = load_scene('paper_fig7', {'time.rate': 5000.0})
    done = simulate(scene, 2.5, scene.time.step)
    folder = tmp_path_factory.mktemp('blocks') / 'run'
    write_bag(folder, RunFacts.of(scene), done.sample_rows(), done.events, {})
    return folder


@pytest.mark.parametrize('rows', [1, 777])
def test_blocks_of_any_size_give_the_same_figures(bag: Path, monkeypatch: pytest.MonkeyPatch, rows: int) -> None:
    expected = outcomes_of(LIMITS, read_run(bag))
    assert expected[-2].value
    monkeypatch.setattr(samples, 'GATHERED', rows)
    assert outcomes_of(LIMITS, read_run(bag)) == expected


def test_no_column_of_a_recorded_run_is_held_whole(bag: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(Bag, 'columns_of')
    assert outcomes_of(LIMITS, read_run(bag))
