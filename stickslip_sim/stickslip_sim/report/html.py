# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Reports as one HTML page each that needs no network: the page, its tables, and pictures inside."""

import base64
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path
from typing import Any

from .model import Part, Picture, Section, Sentence, Table
from .values import json_text

_STYLE = '''
body { font: 15px/1.45 system-ui, sans-serif; color: #222; max-width: 62em; margin: 2em auto; padding: 0 1em }
h1, h2, h3 { line-height: 1.2 } h2 { border-bottom: 1px solid #ccc; margin-top: 2.5em }
table { border-collapse: collapse; margin: 1em 0; font-size: 0.9em } caption { text-align: left; font-weight: 600 }
th, td { padding: 0.25em 0.7em; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap }
figure { margin: 1.5em 0 } figcaption { font-size: 0.9em } img { max-width: 100%; height: auto }
.holds { color: #00664b; font-weight: 600 } .fails { color: #b0003a; font-weight: 600 } .note { color: #b0003a }
.other { color: #666 } .wide { overflow-x: auto }
@media print {   /* what is wider than the paper would be cut off */
body { font-size: 10px; max-width: none; margin: 0 } .wide { overflow: visible }
td.number, th.number { white-space: normal } th, td { padding: 0.15em 0.4em; overflow-wrap: anywhere }
}
'''


def write_page(folder: Path, title: str, parts: Iterable[Part], values: Any) -> None:
    """Write a report into a folder as `report.html`, and the values behind it as `report.json`; raises OSError."""
    (folder / 'report.json').write_text(json_text(values), encoding='utf-8')
    (folder / 'report.html').write_text(html_page(title, [f'<h1>{escape(title)}</h1>', *map(html_of, parts)]),
                                        encoding='utf-8')


def html_page(title: str, body: Sequence[str]) -> str:
    """Return a page of parts that are HTML."""
    return (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
            f'<style>{_STYLE}</style></head>\n<body>\n' + '\n'.join(body) + '\n</body></html>\n')


def figure(path: Path, caption: str) -> str:
    """Return the picture of an SVG file, taken into the page, with its caption."""
    data = base64.b64encode(path.read_bytes()).decode()
    return (f'<figure><img alt="{escape(path.stem)}" src="data:image/svg+xml;base64,{data}">'
            f'<figcaption>{escape(caption)}</figcaption></figure>')


def html_table(caption: str, heads: Sequence[str], rows: Iterable[Sequence[str | Sentence]],
               texts: Sequence[int] = (0,)) -> str:
    """Return a table; all but its columns `texts` are numbers."""
    def line(tag: str, cells: Sequence[str | Sentence]) -> str:
        return '<tr>' + ''.join(_cell(tag, cell, '' if place in texts else 'number')
                                for place, cell in enumerate(cells)) + '</tr>'

    return (f'<div class="wide"><table><caption>{escape(caption)}</caption>{line("th", heads) if heads else ""}'
            + ''.join(line('td', row) for row in rows) + '</table></div>')


def folded(summary: str, content: str) -> str:
    """Return HTML that is shown when its summary is clicked."""
    return f'<details><summary>{escape(summary)}</summary>{content}</details>'


class Shown:
    """A result as notebooks show it: `_shown` has its parts, the first of them a line that says what it is."""

    def _shown(self) -> Iterable[Part]:
        raise NotImplementedError

    def __repr__(self) -> str:
        """Return that line."""
        return f'<{next(iter(self._shown()))}>'

    def _repr_html_(self) -> str:
        return parts_as_html(self._shown())


def parts_as_html(parts: Iterable[Part]) -> str:
    """Return parts as HTML, without a page around them."""
    return '\n'.join(map(html_of, parts))


def html_of(part: Part) -> str:
    """Return a part of a report as HTML."""
    if isinstance(part, Section):
        return '\n'.join([f'<h2>{escape(part.title)}</h2>', *map(html_of, part.parts)])
    if isinstance(part, Table):
        return html_table(part.caption, part.heads, part.rows, part.texts)
    return figure(part.path, part.caption) if isinstance(part, Picture) else _cell('p', part)


def _cell(tag: str, text: str | Sentence, kind: str = '') -> str:
    if isinstance(text, Sentence):
        kind, text = text.kind or kind, text.text
    return f'<{tag} class="{kind}">{escape(text)}</{tag}>' if kind else f'<{tag}>{escape(text)}</{tag}>'
