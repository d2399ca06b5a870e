# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The tool: it simulates, records, verifies and refuses."""

import csv
import subprocess
from collections.abc import Callable
from pathlib import Path

Tool = Callable[..., subprocess.CompletedProcess[str]]


def test_an_axis_at_rest_breaks_away_at_the_limit_of_static_friction(tool: Tool, tmp_path: Path) -> None:
    done = tool('simulate', 'paper_fig8', '--duration', '5', '--events', 'events.csv')
    assert done.returncode == 0, done.stderr
    with (tmp_path / 'events.csv').open() as file:
        events = list(csv.DictReader(file))
    assert float(events[0]['static_coefficient']) == 0.24
    assert [event['kind'] for event in events[:2]] == ['breakaway', 'coast']
    assert events[-1]['kind'] in {'stick', 'breakaway'}


def test_a_recorded_run_is_verified(tool: Tool) -> None:
    assert tool('simulate', 'paper_fig8', '--duration', '1', '--bag', 'run').returncode == 0
    assert tool('verify', 'run').stdout.startswith('identical, 1001 steps')


def test_a_scene_that_is_not_there_is_refused_in_one_line(tool: Tool) -> None:
    done = tool('simulate', 'paper_fig9', '--duration', '1')
    assert done.returncode == 2
    assert done.stderr.count('\n') == 1
    assert 'paper_fig8' in done.stderr
