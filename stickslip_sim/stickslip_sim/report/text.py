# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Reports for a terminal: sentences line by line, tables in aligned columns, sections indented below their titles."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, zip_longest

from .model import NOTE, Part, Picture, Section, Sentence, Table

_GAP = '  '


def text_lines(parts: Iterable[Part]) -> Iterator[str]:
    """Yield the lines of a report."""
    for part in parts:
        if isinstance(part, str):
            yield part
        elif isinstance(part, Sentence):
            yield f'note: {part.text}' if part.kind == NOTE else part.text
        elif isinstance(part, Table):
            yield from filter(None, [part.caption])
            yield from aligned([*filter(None, [part.heads]), *part.rows], part.texts, part.least)
        elif isinstance(part, Section):
            yield part.title
            yield from (f'{_GAP}{line}' for line in text_lines(part.parts))


def aligned(rows: Sequence[Sequence[str | Sentence]], texts: Sequence[int] = (0,), least: Sequence[int] = ()
            ) -> Iterator[str]:
    """Yield rows as lines: the columns `texts` to the left, others to the right, each as wide as `least` or wider."""
    cells = [[cell.text if isinstance(cell, Sentence) else cell for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip_longest(*cells, fillvalue='')]
    widths = [max(pair) for pair in zip_longest(widths, least[:len(widths)], fillvalue=0)]
    for row in cells:
        yield _GAP.join(cell.ljust(width) if place in texts else cell.rjust(width)
                        for place, (cell, width) in enumerate(zip(row, widths))).rstrip()


# Reports as Markdown, for pages that are kept in a repository.

def markdown_lines(parts: Iterable[Part], level: int = 2) -> Iterator[str]:
    """Yield the lines of a report; `level` is that of its titles.  Neighbouring notes are one list."""
    for are_notes, group in groupby(parts, lambda part: isinstance(part, Sentence) and part.kind == NOTE):
        for part in group:
            if isinstance(part, Section):
                yield from (f'{"#" * level} {part.title}', '')
                yield from markdown_lines(part.parts, level + 1)
            elif isinstance(part, Table):
                yield from ([part.caption, ''] if part.caption else [])
                yield from (*markdown_table(part.heads, part.rows), '')
            elif isinstance(part, Picture):
                yield from (f'![{part.caption}]({part.path})', '')
            else:
                yield from ([f'* {_text(part)}'] if are_notes else [_text(part), ''])
        if are_notes:
            yield ''


def markdown_table(heads: Sequence[str], rows: Iterable[Sequence[str | Sentence]]) -> list[str]:
    """Return the lines of a table; a bar within a cell is escaped."""
    cells = [[_text(cell).replace('|', '\\|') for cell in row] for row in (heads, *rows)]
    head, *others = (f'| {" | ".join(row)} |' for row in cells)
    return [head, '|---' * len(heads) + '|', *others]


def _text(part: str | Sentence) -> str:
    return part.text if isinstance(part, Sentence) else part
