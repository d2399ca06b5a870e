# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Misspelt verbs, scenes and paths: each is asked back in its own kind, and no message ends in a bare colon."""

from pathlib import Path

import pytest

from tests.support.repository import ROOT
from tests.support.tool import Capture, refused

LIMITS = str(ROOT / 'examples' / 'limits.yaml')


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to be in, with the file of a scene and the folder of a run."""
    (tmp_path / 'my_run').mkdir()
    (tmp_path / 'my_axis.yaml').touch()
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize(('arguments', 'said'), [
    (['simulat', 'paper_fig8'], 'did you mean simulate?'),
    (['paper_fig8'], 'it is a scene; give a verb first, as in stickslip simulate paper_fig8 --duration 10'),
    (['my_run'], 'it is a path; give a verb first, as in stickslip plot my_run'),
    (['frob'], 'the verbs are advise, bench, '),
    (['simulate', 'paper_fig9', '--duration', '1'], 'did you mean paper_fig8?'),
    (['compare', 'paper_fig9', '--out', 'x'], 'no such run or scene; did you mean paper_fig8?'),
    (['simulate', 'my_axis', '--duration', '1'], 'did you mean my_axis.yaml?'),
    (['simulate', './my_axs.yaml', '--duration', '1'], 'did you mean my_axis.yaml?'),
    (['plot', 'my_axs.yaml', '--duration', '1'], 'no such file; did you mean my_axis.yaml?'),
    (['check', 'my_runn', '--limits', LIMITS], 'no such run or scene; did you mean my_run?'),
    (['plot', './my_runn'], 'no such run; did you mean ./my_run?'),
    (['verify', 'my_runn'], 'no such run; did you mean my_run?'),
    (['export', 'my_runn', '--csv', '-'], 'no such run; did you mean my_run?'),
    (['map', 'my_runn', '--out', 'x.png'], 'did you mean my_run?'),
    (['verify', 'paper_fig8'], 'this is a scene: record it with stickslip simulate paper_fig8'),
    (['check', 'my_run', '--limits', 'unlike.yaml'], 'No such file or directory; check path and permissions'),
])
def test_it_is_asked_back_in_its_kind(arguments: list[str], said: str, capsys: Capture) -> None:
    assert said in refused(capsys, *arguments)


@pytest.mark.parametrize('verb', [['plot'], ['verify'], ['compare', '--out', 'x'], ['check', '--limits', LIMITS],
                                  ['export', '--csv', '-']])
def test_a_glob_that_matches_nothing_is_no_run(verb: list[str], capsys: Capture) -> None:
    assert 'no such run: nothing matches it' in refused(capsys, *verb, 'runs/*')


@pytest.mark.parametrize('content', [b'', b'\x89MCAP0\r\n', b'hello'])
def test_a_message_does_not_end_in_a_bare_colon(content: bytes, place: Path, capsys: Capture) -> None:
    (place / 'bad.mcap').write_bytes(content)
    line = refused(capsys, 'verify', 'bad.mcap').strip()
    assert 'is not an MCAP file' in line
    assert not line.endswith(':')
