# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""docs/python.md: its blocks run, one after the other, and give what the page says."""

import re
from pathlib import Path

import pytest

from tests.support.repository import ROOT
from tests.support.tool import Capture

BLOCK = re.compile(r'^```python\n(.*?)^```$', re.MULTILINE | re.DOTALL)


def test_the_blocks_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture) -> None:
    pytest.importorskip('pandas')
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    printed = []
    for block in BLOCK.findall((ROOT / 'docs' / 'python.md').read_text(encoding='utf-8')):
        exec(block, names)
        printed.append(capsys.readouterr().out)
    assert len(printed) == 13
    assert printed[1].splitlines()[0] == 'stick-slip'
    assert printed[1].splitlines()[1].startswith('BREAKAWAY 0.7625675504')
    assert 'axis.mass = -1.0 is refused' in printed[-1]
    assert {path.name for path in tmp_path.iterdir()} == {'run.png', 'runs'}
    for picture in ('run.png', 'runs/four.png'):
        assert (tmp_path / picture).read_bytes().startswith(b'\x89PNG')
