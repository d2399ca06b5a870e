# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One report, rendered for a terminal, for Markdown and for a page; and results as JSON values."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.report.html import write_page
from stickslip_sim.report.model import NOTE, OTHER, Part, Picture, Section, Sentence, Table, facts
from stickslip_sim.report.text import markdown_lines, text_lines
from stickslip_sim.report.values import json_text, plain

TABLE = Table(('law', 'rms', ''), [('a|b', '0.1 N', Sentence('good', 'holds')), ('c', '12.5 N', '')], 'Fits', (0, 2))


def parts(folder: Path) -> list[Part]:
    (folder / 'drawn.svg').write_text('<svg/>')
    return ['so it is <that>', Sentence('beware', NOTE), Sentence('v1', OTHER),
            Section('Fits & more', [TABLE, Picture(folder / 'drawn.svg', 'laws')])]


def test_terminal(tmp_path: Path) -> None:
    assert list(text_lines(parts(tmp_path))) == [
        'so it is <that>', 'note: beware', 'v1', 'Fits & more',
        '  Fits', '  law     rms', '  a|b   0.1 N  good', '  c    12.5 N']


def test_columns_are_as_wide_as_asked_for() -> None:
    assert list(text_lines([facts([('events', 'none'), ('a longer label', 'x')], 10)])) == [
        'events          none', 'a longer label  x']
    assert list(text_lines([Table((), [('a', '1')], least=(3, 4, 9))])) == ['a       1']


def test_markdown(tmp_path: Path) -> None:
    assert list(markdown_lines(parts(tmp_path))) == [
        'so it is <that>', '', '* beware', '', 'v1', '', '## Fits & more', '', 'Fits', '',
        '| law | rms |  |', '|---|---|---|', '| a\\|b | 0.1 N | good |', '| c | 12.5 N |  |', '',
        f'![laws]({tmp_path}/drawn.svg)', '']


def test_neighbouring_notes_are_one_list_in_markdown() -> None:
    notes = [Sentence('beware', NOTE), Sentence('of this', NOTE)]
    assert list(markdown_lines([*notes, 'so it is', *notes])) == [
        '* beware', '* of this', '', 'so it is', '', '* beware', '* of this', '']


def test_page_and_the_values_behind_it(tmp_path: Path) -> None:
    write_page(tmp_path, 'Laws <1>', parts(tmp_path), {'rms': (0.1, math.inf)})
    page = (tmp_path / 'report.html').read_text()
    for found in ('<title>Laws &lt;1&gt;</title>', '<h1>Laws &lt;1&gt;</h1>', '<p>so it is &lt;that&gt;</p>',
                  '<p class="note">beware</p>', '<h2>Fits &amp; more</h2>', '<caption>Fits</caption>',
                  '<tr><th>law</th><th class="number">rms</th><th></th></tr>',
                  '<tr><td>a|b</td><td class="number">0.1 N</td><td class="holds">good</td></tr>',
                  'src="data:image/svg+xml;base64,', '<figcaption>laws</figcaption>'):
        assert found in page, found
    assert json.loads((tmp_path / 'report.json').read_text()) == {'rms': [0.1, 'inf']}


def test_plain_values() -> None:
    class Pair(NamedTuple):
        low: float
        mode: Mode

    @dataclass(frozen=True)
    class Found:
        pair: Pair
        counts: dict[EventKind, int]

    found = Found(Pair(-math.inf, Mode.STICK), {EventKind.BREAKAWAY: 2})
    assert plain(found) == {'pair': {'low': '-inf', 'mode': 'STICK'}, 'counts': {'breakaway': 2}}
    assert plain([np.array([1.0, math.inf]), (1, math.nan)]) == [[1.0, 'inf'], (1, 'nan')]
    assert json_text({'a': [1]}, indent=2) == '{\n  "a": [\n    1\n  ]\n}\n'


@pytest.mark.parametrize('rows', [[], [('a',)]])
def test_a_table_may_be_empty_or_have_one_column(rows: list[tuple[str]]) -> None:
    assert list(text_lines([Table(('head',), rows)])) == ['head', *(row[0] for row in rows)]
