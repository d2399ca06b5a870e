# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""docs/maps.md: its commands are those that make its pictures and figures."""

import shlex
from pathlib import Path

import pytest

from benchmarks.maps import CRITICAL, PAGE, PICTURES, UNCERTAIN, shown
from stickslip_sim.cli.main import run
from tests.support.tool import Capture


@pytest.fixture(scope='module')
def page() -> str:
    return PAGE.read_text(encoding='utf-8')


@pytest.mark.parametrize('name', PICTURES)
def test_each_picture_has_its_commands(name: str, page: str) -> None:
    part = '\n'.join(map(shown, PICTURES[name]))
    assert f'<!-- {name}: begin -->\n\n{part}\n\n<!-- {name}: end -->' in page
    picture = PICTURES[name][-1].partition('--out docs/')[2].split()[0]
    assert f']({picture})' in page
    assert (PAGE.parent / picture).is_file()


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
    elsewhere = UNCERTAIN.replace('runs/maps', str(tmp_path)).replace('docs/images', str(tmp_path))
    assert run(shlex.split(elsewhere)) == 0
    assert (tmp_path / 'uncertainty.png').read_bytes().startswith(b'\x89PNG')
    for line in capsys.readouterr().out.splitlines()[:-1]:
        assert f'    {line}'.rstrip() + '\n' in page
