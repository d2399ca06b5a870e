# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures that limits are set for: against closed forms and the events of the exact engine."""

import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from scipy.optimize import brentq

from stickslip_sim.bags import topics
from stickslip_sim.check.limits import limits_of, outcomes_of
from stickslip_sim.core.types import EventKind, Sample
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import BagWriter, RunFacts, read_run, write_bag
from stickslip_sim.recording.reader import Bag
from stickslip_sim.runs import samples, simulate
from stickslip_sim.scene import scene_from_values
from stickslip_sim.scene.ros_yaml import read_yaml
from tests.support.check_files import (
    DECAY,
    DURATION,
    FREE,
    FREQUENCY,
    LIMITS,
    START_VELOCITY,
    checked,
    commanded_bag,
    free_position,
    limits_file,
    measured,
    node_bag,
    of_limits,
    refused,
    simulated,
)
from tests.support.tool import Capture

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

MANY_LIMITS = limits_of(read_yaml('''
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
    expected = outcomes_of(MANY_LIMITS, read_run(bag))
    assert expected[-2].value
    monkeypatch.setattr(samples, 'GATHERED', rows)
    assert outcomes_of(MANY_LIMITS, read_run(bag)) == expected


def test_no_column_of_a_recorded_run_is_held_whole(bag: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(Bag, 'columns_of')
    assert outcomes_of(MANY_LIMITS, read_run(bag))


# `stickslip check` on limits and runs that say nothing: one clear line.

class TestRefusals:
    @pytest.mark.parametrize('row', yaml.safe_load(Path(__file__).with_name('refused.yaml').read_text('utf-8')))
    def test_limits(self, row: list[str], tmp_path: Path, capsys: Capture) -> None:
        text, *words = row
        path = limits_file(tmp_path, text.replace('LIMITS', LIMITS))
        refused(capsys, 'paper_fig7', '--duration', DURATION, '--limits', path, '--junit', tmp_path / 'c.xml',
                words=words)
        assert [file.name for file in tmp_path.iterdir()] == ['limits.yaml']

    def test_limits_that_are_no_text(self, tmp_path: Path, capsys: Capture) -> None:
        (tmp_path / 'b.yaml').write_bytes(b'\xff\xfe\x00')
        arguments = ['paper_fig7', '--duration', DURATION, '--limits']
        assert 'is it a limits file?' in refused(capsys, *arguments, tmp_path / 'b.yaml')
        assert 'Is a directory' in refused(capsys, *arguments, tmp_path)
        assert 'No such file' in refused(capsys, *arguments, tmp_path / 'none.yaml')

    @pytest.mark.parametrize('option', [['--duration', '1'], ['--set', 'axis.mass=1.0']])
    def test_of_options_for_scenes(self, option: list[str], fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
        refused(capsys, fig8_bag, *option, '--limits', limits_file(tmp_path, LIMITS),
                words=('--duration and --set', 'recorded'))

    def test_a_bag_without_states(self, tmp_path: Path, capsys: Capture) -> None:
        BagWriter(tmp_path / 'empty', topics.recorded_topics(), {}, {}).close()
        limits = limits_file(tmp_path, LIMITS)
        assert 'no state of the axis' in refused(capsys, tmp_path / 'empty', '--limits', limits)

    def test_a_bag_of_two_runs(self, tmp_path: Path, capsys: Capture) -> None:
        scene = load_scene('paper_fig7')
        rows: list[Sample] = [*simulate(scene, 0.01, scene.time.step).sample_rows()]
        write_bag(tmp_path / 'two', RunFacts.of(scene), rows + rows, [], {})
        assert 'time goes back' in refused(capsys, tmp_path / 'two', '--limits', limits_file(tmp_path, LIMITS))

    @pytest.mark.parametrize('timing', [None, {'steps': 3}, {'valid': None, 'verdict': 'not in real time'}, 'good'])
    def test_a_bag_without_a_verdict(self, timing: object, tmp_path: Path, capsys: Capture) -> None:
        folder = node_bag(tmp_path / 'run', timing)
        line = refused(capsys, folder, '--limits', limits_file(tmp_path, 'limits: {timing: valid}'))
        assert 'only a run that the node recorded in real time' in line


# `stickslip check` on runs of a controller that comes late, or never: no limit passes that did not see it.

LATE = 1501                       # step that takes up the first command, at 1.5 s
VERDICT = 'real-time valid: no, worst 12.00 ms at t = 0.2 s'
FROM_COMMAND = 'window: {begin: first_command, end: 0.5}\n'


@pytest.fixture(scope='module')
def late(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return commanded_bag(tmp_path_factory.mktemp('runs') / 'late', {LATE: 0.01, 2101: 0.0}, 2500)


@pytest.fixture(scope='module')
def never(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return commanded_bag(tmp_path_factory.mktemp('runs') / 'never', {}, 500)


def found(capsys: Capture, folder: Path, limits: Path, text: str) -> dict[str, Any]:
    """Return what is measured by the name of the limit, with the first command as `first`."""
    _, out, _ = checked(capsys, folder, '--limits', limits_file(limits, text), '--json', '-')
    everything = json.loads(out)
    return {'first': everything['run']['first_command'], **{entry['name']: entry for entry in everything['limits']}}


class TestLate:
    def test_limits_whose_window_ends_before_fail_and_say_so(self, late: Path, tmp_path: Path, capsys: Capture) -> None:
        text = 'window: {end: 1.0}\nlimits: {sticks: {max: 9}, all: {check: peak_speed, max: 1.0, window: {end: 2.0}}}'
        code, out, err = checked(capsys, late, '--limits', limits_file(tmp_path, text))
        assert code == 3
        assert 'first command at t = 1.5 s' in out.splitlines()[0]
        assert 'FAIL  no drive velocity came until t = 1 s: no controller was checked' in out
        assert out.splitlines()[-1] == 'FAILED: 1 of 2: sticks'
        assert 'no drive velocity came within the window of sticks' in err
        assert 'first_command' in err

    def test_a_window_from_the_first_command_on(self, late: Path, tmp_path: Path, capsys: Capture) -> None:
        """Its times count from there: the figures are those of the same run without the wait."""
        prompt = commanded_bag(tmp_path / 'prompt', {1: 0.01, 601: 0.0}, 900)
        text = ('target: 5.0e-3\nlimits:\n  settling_time: {band: 1.0e-3, max: 1.0}\n  following_error: {max: 1.0}\n'
                '  later: {check: following_error, max: 1.0, window: {begin: 0.3}}\n'
                '  sticks: {max: 9}\n')
        expected = found(capsys, prompt, tmp_path, 'window: {end: 0.5}\n' + text)
        counted = found(capsys, late, tmp_path, FROM_COMMAND + text)
        assert (expected.pop('first'), counted.pop('first')) == (0.0, 1.5)
        assert counted['settling_time']['window'] == {'begin': 1.5, 'end': 2.0}
        assert counted['later']['window'] == {'begin': 1.8, 'end': 2.0}
        for name, entry in expected.items():
            assert counted[name]['measured'] == pytest.approx(entry['measured'], rel=1e-9), name

    def test_the_reference_counts_from_there_too(self, late: Path, tmp_path: Path, capsys: Capture) -> None:
        """The drive itself is such a reference: 10 mm/s from the first command on."""
        limits = 'limits: {following_error: {max: 1.0}}'
        reference = 'reference: {times: [0.0, 0.6], positions: [0.0, 6.0e-3]}\n'
        of_drive = found(capsys, late, tmp_path, FROM_COMMAND + limits)['following_error']['measured']
        counted = found(capsys, late, tmp_path, FROM_COMMAND + reference + limits)['following_error']['measured']
        assert counted == pytest.approx(of_drive, rel=1e-9)

    def test_a_run_that_ends_too_soon_after_it(self, late: Path, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, 'window: {begin: first_command, end: 2.0}\nlimits: {sticks: {max: 9}}')
        line = refused(capsys, late, '--limits', limits)
        assert 'sticks.window.end = 2.0 is refused: must be at most 1, the time in s that the run goes on after' in line


class TestNever:
    @pytest.mark.parametrize('window', ['', 'window: {begin: first_command}\n', 'window: {begin: 0.1, end: 0.2}\n'])
    def test_nothing_passes(self, window: str, never: Path, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, window + 'limits: {sticks: {max: 9}, peak_speed: {max: 1.0}}')
        code, out, err = checked(capsys, never, '--limits', limits)
        assert (code, out.splitlines()[-1]) == (3, 'FAILED: 2 of 2: sticks, peak_speed')
        assert 'no command' in out.splitlines()[0]
        assert 'no drive velocity came within the window of sticks, peak_speed' in err

    def test_unless_no_command_is_needed(self, never: Path, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, 'commands: optional\nlimits: {sticks: {max: 9}}')
        code, out, _ = checked(capsys, never, '--limits', limits)
        assert (code, out.splitlines()[-1]) == (0, 'PASSED: 1 of 1')

    def test_a_run_of_the_tool_needs_none(self, tmp_path: Path, capsys: Capture) -> None:
        assert checked(capsys, 'paper_fig7', '--duration', '0.1', '--limits',
                       limits_file(tmp_path, 'limits: {sticks: {max: 9}}'))[0] == 0


class TestVerdict:
    def test_that_of_the_node_is_reported_without_being_asked_for(self, tmp_path: Path, capsys: Capture) -> None:
        folder = commanded_bag(tmp_path / 'run', {1: 0.01}, 100, {'valid': False, 'verdict': VERDICT})
        limits = limits_file(tmp_path, 'limits: {sticks: {max: 9}}')
        code, out, _ = checked(capsys, folder, '--limits', limits)
        assert (code, out.splitlines()[1]) == (0, VERDICT)
        assert out.splitlines()[-1] == 'PASSED: 1 of 1, but the run is not valid in real time'
        _, out, _ = checked(capsys, folder, '--limits', limits, '--json', '-')
        assert json.loads(out)['run']['timing'] == {'valid': False, 'verdict': VERDICT}

    def test_that_of_lock_step_too(self, tmp_path: Path, capsys: Capture) -> None:
        verdict = 'not in real time (time.mode lockstep)'
        folder = commanded_bag(tmp_path / 'run', {1: 0.01}, 100, {'valid': None, 'verdict': verdict})
        code, out, _ = checked(capsys, folder, '--limits', limits_file(tmp_path, 'limits: {sticks: {max: 9}}'))
        assert (code, out.splitlines()[1], out.splitlines()[-1]) == (0, verdict, 'PASSED: 1 of 1')
