# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Reports as Markdown, for pages that are kept in a repository."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby

from .model import NOTE, Part, Picture, Section, Sentence, Table


def markdown_lines(parts: Iterable[Part], level: int = 2) -> Iterator[str]:
    """Yield the lines of a report; `level` is that of its titles.  Neighbouring notes are one list."""
    for are_notes, group in groupby(parts, _is_note):
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


def _is_note(part: Part) -> bool:
    return isinstance(part, Sentence) and part.kind == NOTE


def _text(part: str | Sentence) -> str:
    return part.text if isinstance(part, Sentence) else part
