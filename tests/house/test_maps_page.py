# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""docs/maps.md: its commands are those that make its pictures and figures."""

import re
import shlex
from pathlib import Path

import pytest

from benchmarks.maps import CRITICAL, IMAGES, PAGE, PICTURES, UNCERTAIN, picture_of, shown
from stickslip_sim.cli.main import run
from tests.support.repository import ROOT
from tests.support.tool import Capture

pytestmark = pytest.mark.slow


@pytest.fixture(scope='module')
def page() -> str:
    return PAGE.read_text(encoding='utf-8')


@pytest.mark.parametrize('name', PICTURES)
def test_each_picture_has_its_commands(name: str, page: str) -> None:
    part = '\n'.join(map(shown, PICTURES[name]))
    assert f'<!-- {name}: begin -->\n\n{part}\n\n<!-- {name}: end -->' in page
    picture = picture_of(PICTURES[name][-1]).name
    assert f'](images/{picture})' in page
    assert (IMAGES / picture).is_file()


def faster(command: str) -> str:
    """Return a command of the page with few points, one picked motion, and a coarse critical value."""
    command = re.sub(r'--(samples|sobol) \d+', r'--\1 16', command)
    if '--sobol' not in command:
        command = re.sub(r'(--over \S+:)\d+(:log)?(?= |$)', r'\g<1>4\2', command)
    command = re.sub(r'(?:--pick \S+\s+)+(--pick)', r'\1', command)
    return f'{command} --accuracy 0.01' if ' critical ' in command else command


def test_the_commands_run_as_written_one_after_the_other(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                                         capsys: Capture) -> None:
    """In an empty folder with the examples; what they write is below runs/, and nothing is overwritten."""
    (tmp_path / 'examples').symlink_to(ROOT / 'examples')
    monkeypatch.chdir(tmp_path)
    commands = re.findall(r'^    (python3 -m stickslip_sim (?:.*\\\n)*.*)$', page, re.MULTILINE)
    commands = [command.replace('\\\n', ' ') for command in commands if '...' not in command]
    assert len(commands) == 2 * len(PICTURES) + len(CRITICAL) + 2    # one of uncertainty, one with --sobol
    for command in commands:
        assert run(shlex.split(faster(command))[3:]) == 0, f'{command}\n{capsys.readouterr().err}'
    drawn = {picture_of(command) for command in commands if '.png' in command}
    assert len(drawn) == len(PICTURES) + 1
    assert all(picture.is_file() for picture in drawn)
    assert {path.name for path in tmp_path.iterdir()} == {'examples', 'runs'}


def test_every_critical_value_has_its_command(page: str) -> None:
    assert all(shown(command) in page for command in CRITICAL)


def test_a_critical_value_is_what_the_page_says(page: str, capsys: Capture) -> None:
    """The one with a closed form: it takes no second."""
    assert run(shlex.split(CRITICAL[3])) == 0
    for line in capsys.readouterr().out.splitlines():
        assert f'    {line}'.rstrip() + '\n' in page


def test_the_uncertainty_is_what_the_page_says(page: str, tmp_path: Path, capsys: Capture) -> None:
    """All but its last line, which names the folder."""
    assert shown(UNCERTAIN) in page
    elsewhere = UNCERTAIN.replace('runs/maps', str(tmp_path)).replace('runs', str(tmp_path))
    assert run(shlex.split(elsewhere)) == 0
    assert (tmp_path / 'uncertainty.png').read_bytes().startswith(b'\x89PNG')
    for line in capsys.readouterr().out.splitlines()[:-1]:
        assert f'    {line}'.rstrip() + '\n' in page
