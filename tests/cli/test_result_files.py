# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where results go: all verbs make the same folders for their files, and refuse the same paths."""

from pathlib import Path

import pytest

from tests.support.repository import ROOT
from tests.support.tool import Capture, answered, refused

SCENE = 'paper_fig7', '--duration', '0.5'
CURVE = 'friction', ROOT / 'examples' / 'friction_curve.csv', '--speed-unit', 'mm/s'
WITH = 'uncertainty', 'paper_fig7', '--with', ROOT / 'examples' / 'friction.yaml', '--out', 'spread'
LIMITS = '--limits', ROOT / 'examples' / 'limits.yaml'
COMMANDS = [
    (('plot', *SCENE, '--out'), 'a.png'),
    (('simulate', *SCENE, '--plot'), 'a.png'),
    (('simulate', *SCENE, '--events'), 'a.csv'),
    (('simulate', *SCENE, '--samples'), 'a.csv'),
    (('simulate', *SCENE, '--receipt'), 'a.json'),
    (('check', 'positioning', '--duration', '2', *LIMITS, '--junit'), 'a.xml'),
    ((*CURVE, '--out'), 'a.yaml'),
    ((*CURVE, '--plot'), 'a.png'),
    ((*WITH, '--plot'), 'a.png'),
    (('advise', *SCENE, '--tolerance', '1e-3', '--scene-out'), 'a.yaml'),
    (('extremes', '--only', 'X01', '--out'), 'a.json'),
]


@pytest.mark.parametrize(('command', 'name'), COMMANDS, ids=lambda given: ' '.join(map(str, given))[-24:])
def test_a_path_below_two_folders_that_are_missing_is_refused(
        command: tuple[str, ...], name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.chdir(tmp_path)
    line = refused(capsys, *command, Path('new', 'er', name))
    assert f"must be in a folder, or in a new one within one; {tmp_path / 'new'} is none; make it, or look" in line
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(('command', 'name'), COMMANDS[:8], ids=lambda given: ' '.join(map(str, given))[-24:])
def test_one_new_folder_is_made(
        command: tuple[str, ...], name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    monkeypatch.chdir(tmp_path)
    assert answered(capsys, *command, Path('new', name))[0] in (0, 3)    # 3: beyond the limits
    assert (tmp_path / 'new' / name).is_file()


def test_a_new_folder_is_made_with_those_around_it(tmp_path: Path, capsys: Capture) -> None:
    folder = tmp_path / 'new' / 'er' / 'run'
    assert answered(capsys, 'simulate', *SCENE, '--bag', folder)[0] == 0
    assert (folder / 'metadata.yaml').is_file()
