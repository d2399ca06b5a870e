# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip check` on runs of a controller that comes late, or never: no limit passes that did not see it."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.support.check_files import checked, commanded_bag, limits_file, refused
from tests.support.tool import Capture

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
