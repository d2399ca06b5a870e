# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of control: errors, moves, creep, effort and turns, against closed forms."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.check.limits import limits_of, load_limits, outcomes_of
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs import SimulatedRun, samples, simulate
from stickslip_sim.scene.ros_yaml import read_yaml
from tests.support.check_files import (
    DECAY,
    FREE,
    FREQUENCY,
    START_VELOCITY,
    checked,
    limits_file,
    measured,
    of_limits,
    refused,
    simulated,
)
from tests.support.tool import Capture, done

FIRST_BREAK_AWAY = 0.67979883333333   # s, of paper_fig7
RAMP = 'reference: {times: [0.5, 1.0, 1.5, 2.5], positions: [0.0, 0.02, 0.01, 0.06]}\n'


@pytest.fixture(scope='module')
def still() -> SimulatedRun:
    """A slider at 0 whose drive rests, so that the reference alone makes errors."""
    return simulate(load_scene('paper_fig7', {'drive.velocity': 0.0}), 3.0)


@pytest.fixture(scope='module')
def moves() -> SimulatedRun:
    """An axis without friction, whose drive goes 10 mm there and back, and rests."""
    return simulate(load_scene('positioning', {'axis.normal_force': 0.0}), 8.0)


def of_reference(text: str, run: SimulatedRun) -> float:
    value = of_limits(f'{RAMP}limits: {{one: {{{text}, max: 100.0}}}}', run)['one'].value
    assert value is not None
    return value


class TestErrors:
    def test_rms_of_straight_lines(self, still: SimulatedRun) -> None:
        part = of_reference('check: following_error_rms, window: {begin: 0.5, end: 1.0}', still)
        count = 500    # steps: the squares of 0 to 500 over 501 states
        assert part == pytest.approx(0.02 * math.sqrt((2.0 * count + 1.0) / (6.0 * count)), rel=1e-12)

    @pytest.mark.parametrize(('within', 'spike'), [(0.1, 0.01998), (0.25, 0.02255), (0.5, 0.03505), (5.0, 0.06)])
    def test_a_turn(self, within: float, spike: float, still: SimulatedRun) -> None:
        """At 1 s the reference turns at 20 mm, at 1.5 s at 10 mm, and rises by 50 mm in a second; seen a step later."""
        assert of_reference(f'check: reversal_spike, within: {within}', still) == pytest.approx(spike, rel=1e-12)

    def test_no_turn(self, still: SimulatedRun) -> None:
        assert of_reference('check: reversal_spike, within: 0.1, window: {end: 1.0}', still) == 0.0


class TestMoves:
    """A rest of the command is a window of its own: with the figures of one move."""

    RESTS = (1.125, 2.0, 0.01), (3.125, 4.0, 0.0), (5.125, 6.0, 0.01), (7.125, 8.0, 0.0)

    def figures(self, moves: SimulatedRun, name: str, settings: str = '') -> list[float]:
        texts = [f'{name}: {{{settings}target: {target}, max: 9.0, window: {{begin: {begin}, end: {end}}}}}'
                 for begin, end, target in self.RESTS]
        return [measured(text, moves) for text in texts]

    @pytest.mark.parametrize('band', [1e-4, 3e-6])
    def test_settling(self, band: float, moves: SimulatedRun) -> None:
        value = measured(f'move_settling_time: {{band: {band!r}, max: 9.0}}', moves)
        assert value == pytest.approx(max(self.figures(moves, 'settling_time', f'band: {band!r}, ')), rel=1e-9)
        assert (value > 0.0) == (band < 1e-4)

    def test_one_that_does_not_settle(self, moves: SimulatedRun) -> None:
        assert measured('move_settling_time: {band: 1.0e-9, max: 9.0}', moves) == math.inf

    def test_overshoot_and_steady_state_error(self, moves: SimulatedRun) -> None:
        beyond = of_limits('limits: {move_overshoot: {max: 1.0}}', moves)['move_overshoot']
        assert beyond.value == pytest.approx(max(sense * (moves.samples['position'] - target)[
            (moves.samples['time'] >= begin) & (moves.samples['time'] <= end)].max()
            for sense, (begin, end, target) in zip((1.0, -1.0) * 2, self.RESTS)), rel=1e-12)
        assert 'of 4, from t = ' in beyond.remark
        error = measured('steady_state_error: {max: 1.0}', moves)
        assert error == pytest.approx(max(self.figures(moves, 'end_position_error')), rel=1e-6)

    def test_a_dwell_that_is_too_long(self, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, 'limits: {steady_state_error: {max: 1.0, dwell: 1.0}}')
        assert 'steady_state_error.dwell = 1.0' in refused(capsys, 'positioning', '--duration', '8', '--limits', limits)


class TestCreep:
    def test_ripple_and_lowest_speed(self) -> None:
        times = np.linspace(0.0, 0.3, 300_001)
        velocities = START_VELOCITY * np.exp(-DECAY * times) * (
            np.cos(FREQUENCY * times) - DECAY / FREQUENCY * np.sin(FREQUENCY * times))
        run = simulated(FREE, 0.3)
        assert measured('velocity_ripple: {max: 1.0}', run) == pytest.approx(np.ptp(velocities), rel=1e-8)
        lowest = of_limits('limits: {lowest_speed: {min: 1.0e-9, window: {end: 0.03}}}', run)['lowest_speed']
        assert lowest.value == pytest.approx(np.abs(velocities[:30_001]).min(), rel=1e-8)

    @pytest.mark.parametrize(('minimum', 'passed'), [(0.1, True), (0.2, False)])
    def test_a_limit_from_below(self, minimum: float, passed: bool) -> None:
        run = simulate(load_scene('paper_fig7', {'axis.normal_force': 0.0, 'initial.velocity': 0.1,
                                                 'drive.velocity': 0.1}), 0.1)
        outcome = of_limits(f'limits: {{lowest_speed: {{min: {minimum}}}}}', run)['lowest_speed']
        assert outcome.passed == passed
        assert outcome.margin == pytest.approx(0.1 - minimum, abs=1e-12)

    def test_standstill_ends_where_the_speed_passes(self) -> None:
        run = simulated('paper_fig7', 1.0)
        outcome = of_limits('limits: {standstill: {speed: 1.0e-9, max: 1.0}}', run)['standstill']
        assert outcome.value == pytest.approx(FIRST_BREAK_AWAY, abs=1e-5)
        assert outcome.remark == 'until t = 0.679799 s'
        cut = measured('standstill: {speed: 1.0e-9, max: 1.0, window: {begin: 0.2, end: 0.5}}', run)
        assert cut == pytest.approx(0.3, abs=1e-12)
        assert measured('standstill: {speed: 1.0e-3, max: 1.0, window: {begin: 0.73, end: 0.8}}', run) == 0.0

    def test_a_compliant_contact_is_no_standstill(self, capsys: Capture, tmp_path: Path) -> None:
        """It creeps in stick at the drive's 2 mm/s by 0.6 of 5.6 N/µm: 0.21 mm/s."""
        limits = limits_file(tmp_path, 'limits: {longest_stick: {max: 9.0, window: {begin: 0.1, end: 0.6}}, standstill:'
                                       ' {speed: 1.0e-4, max: 0.0, window: {begin: 0.1, end: 0.6}}}')
        found = tmp_path / 'found.json'
        out = done(capsys, 'check', 'paper_fig8', '--duration', '1', '--limits', limits, '--json', found)
        assert out.splitlines()[1].startswith('note: longest_stick: in stick the slider moves on its compliant contact')
        assert json.loads(found.read_text())['run']['notes'][0].startswith('longest_stick')


class TestEffort:
    """The drive of `positioning` ramps to 10 mm/s within 0.125 s, holds it, and ramps back; twice in 4 s."""

    @pytest.mark.parametrize(('name', 'value'), [
        ('command_peak', 0.01), ('command_rate_peak', 0.08),
        ('command_rms', math.sqrt(2.0 * 0.01**2 * (0.875 + 2.0 * 0.125 / 3.0) / 4.0)),    # about, of 4001 states
        ('command_rate_rms', math.sqrt(4.0 * 0.08**2 * 0.125 / 4.001)),
    ])
    def test_a_trapezium(self, name: str, value: float, moves: SimulatedRun) -> None:
        assert measured(f'{name}: {{max: 1.0, window: {{end: 4.0}}}}', moves) == pytest.approx(value, rel=2e-4)


EVERY = limits_of(read_yaml('''
window: {begin: 0.9}
limits:
  following_error_rms: {max: 1.0}
  move_settling_time: {band: 1.0e-4, max: 9.0}
  move_overshoot: {max: 1.0}
  steady_state_error: {max: 1.0}
  velocity_ripple: {max: 1.0}
  lowest_speed: {min: 0.0}
  standstill: {speed: 1.0e-4, max: 9.0}
  reversal_spike: {within: 0.3, max: 1.0}
  command_rms: {max: 1.0}
  command_rate_peak: {max: 1.0}
  command_rate_rms: {max: 1.0}
  reversal_error: {max: 1.0, targets: [0.0], tolerance: 0.011}
'''))


@pytest.mark.parametrize('rows', [1, 177])
def test_blocks_of_any_size_give_the_same_figures(monkeypatch: pytest.MonkeyPatch, rows: int) -> None:
    run = simulate(load_scene('positioning', {'time.rate': 100.0}), 8.0)
    expected = outcomes_of(EVERY, run)
    whole = run.sample_blocks

    def parts() -> object:
        for block in whole():
            for first in range(0, len(block['time']), rows):
                yield {name: column[first:first + rows] for name, column in block.items()}

    monkeypatch.setattr(samples, 'GATHERED', rows)
    object.__setattr__(run, 'sample_blocks', parts)
    for one, other in zip(outcomes_of(EVERY, run), expected):
        assert one.value == pytest.approx(other.value, rel=1e-12), one.name


class TestReferenceFile:
    @pytest.mark.parametrize(('heading', 'units'), [
        ('t [ms];x;other', 'time_unit: ms, position_unit: mm'), ('t [ms];x [mm];other', 'position_unit: mm'),
        ('t (ms);x [mm];other', 'time_unit: ms')])
    def test_columns_and_units(self, heading: str, units: str, tmp_path: Path, still: SimulatedRun) -> None:
        (tmp_path / 'move.csv').write_text(f'{heading}\n500;0;1\n1000;20;2\n1500;10;3\n2500;60;4\n')
        path = limits_file(tmp_path, f'reference: {{file: move.csv, time: t, position: x, {units}}}\n'
                                     'limits: {following_error_rms: {max: 1.0}}')
        (outcome,) = outcomes_of(load_limits(path), still)
        assert outcome.value == of_reference('check: following_error_rms', still)

    @pytest.mark.parametrize(('text', 'words'), [
        ('{file: none.csv}', ['reference.file', 'did you mean', 'move.csv?']),
        ('{file: move.csv, position: z}', ['reference.position', 'the name of one column']),
        ('{file: move.csv, position: x, column: y}', ['reference.column', 'one of file, time, position']),
        ('{file: move.csv, position: x, position_unit: s}', ['reference.position_unit', 'one of m, mm']),
        ('{file: 3}', ['reference.file = 3']),
        ('{file: far.csv, position: x}', ['reference.position', 'x [furlong]', 'one of the units m, mm']),
        ('{file: back.csv, position: x}', ['back.csv line 3', 'a time after the one before it']),
    ])
    def test_refusals(self, text: str, words: list[str], tmp_path: Path, capsys: Capture) -> None:
        (tmp_path / 'move.csv').write_text('time,x\n0.0,0.0\n1.0,1.0\n')
        (tmp_path / 'far.csv').write_text('time,x [furlong]\n0.0,0.0\n1.0,1.0\n')
        (tmp_path / 'back.csv').write_text('time,x\n1.0,0.0\n0.5,1.0\n')
        path = limits_file(tmp_path, f'reference: {text}\nlimits: {{following_error: {{max: 1.0}}}}')
        refused(capsys, 'paper_fig7', '--duration', '1', '--limits', path, words=words)


class TestMatrix:
    def test_of_runs_and_limits(self, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, 'limits: {sticks: {max: 1}, peak_speed: {max: 0.02}}')
        code, out, _ = checked(capsys, 'paper_fig7', 'fast_feed', '--duration', '1.4', '--limits', limits)
        head, *rows = out.splitlines()[-4:-1]
        assert code == 3
        assert head.split() == ['run', 'sticks', 'peak_speed']
        assert [row.split() for row in rows] == [['paper_fig7', '1', '14.561', 'mm/s'],
                                                 ['fast_feed', '0', '175.34', 'mm/s', 'FAIL']]
