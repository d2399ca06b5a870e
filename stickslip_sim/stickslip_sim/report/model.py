# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a report consists of; `text`, `markdown` and `html` render it, and `values` has the numbers behind it."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

NOTE = 'note'     # what to beware of
OTHER = 'other'   # small print


class Sentence(NamedTuple):
    """A line of text, or a cell of a table; `kind` is NOTE, OTHER or another class of the page's style."""

    text: str
    kind: str = ''


class Table(NamedTuple):
    """Rows below `heads` (none where empty): the columns `texts` stand to the left, all others are numbers.

    On a terminal columns are at least as wide as `least` says.
    """

    heads: Sequence[str]
    rows: Sequence[Sequence[str | Sentence]]
    caption: str = ''
    texts: Sequence[int] = (0,)
    least: Sequence[int] = ()


class Picture(NamedTuple):
    """An SVG file with its caption; a terminal shows none."""

    path: Path
    caption: str


class Section(NamedTuple):
    """Parts below a title."""

    title: str
    parts: 'Iterable[Part]'


Part = str | Sentence | Table | Picture | Section


def facts(rows: Sequence[tuple[str, str]], width: int) -> Table:
    """Return a table of labels and of what is said of each; labels take `width` columns of a terminal."""
    return Table((), rows, texts=(0, 1), least=(width,))
