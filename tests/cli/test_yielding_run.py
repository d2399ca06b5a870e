# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run whose contact yields, through all that takes a run: tables, bag, pictures, verification, comparison."""

import csv
from pathlib import Path

from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import read_run
from stickslip_sim.runs import simulate
from tests.support.tool import Capture, answered
from tests.support.verify_tool import verified

LOAD = {'normal_load.course': 'sine', 'normal_load.amplitude': 1000.0, 'normal_load.frequency': 25.0}
SECONDS = 2.0


def test_its_tables_bag_and_pictures(tmp_path: Path, capsys: Capture) -> None:
    run = simulate(load_scene('paper_fig8', LOAD), SECONDS, 0.001)
    changes = [word for name, value in LOAD.items() for word in ('--set', f'{name}={value}')]
    files = [tmp_path / name for name in ('events.csv', 'samples.csv', 'bag', 'run.png')]
    options = [word for option, file in zip(('--events', '--samples', '--bag', '--plot'), files)
               for word in (option, file)]
    code, out, _ = answered(capsys, 'simulate', 'paper_fig8', '--duration', str(SECONDS), *changes, *options)
    yields = sum(event.kind == EventKind.YIELD for event in run.events)
    assert (code, yields > 5, f'{yields} yield' in out) == (0, True, True)
    words = [[row[name] for row in csv.DictReader(file.read_text().splitlines())]
             for file, name in zip(files, ('kind', 'mode'))]
    assert (words[0].count('yield'), 'YIELDING' in words[1]) == (yields, True)
    assert verified(capsys, tmp_path / 'bag')[0] == 0
    recorded = read_run(tmp_path / 'bag')
    assert [(event.time, event.kind, event.mode) for event in recorded.events] == [
        (event.time, event.kind, event.mode) for event in run.events]
    assert set(recorded.samples['mode']) == set(Mode)
    for command, *given in (('export', '--topic', 'mode_event', '--csv', '-'), ('plot', '--out', tmp_path / 'bag.svg'),
                            ('compare', '--out', tmp_path / 'cmp')):
        assert answered(capsys, command, tmp_path / 'bag', *given)[0] == 0, command
