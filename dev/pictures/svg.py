# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A sheet that collects shapes and is written as SVG: plain elements, text as text, a white ground for dark pages."""

import math
import re
import textwrap
from html import escape
from typing import NamedTuple

# Okabe and Ito's colours, which stay apart for colour-blind eyes
INK, GREY, PALE = '#222222', '#666666', '#eef2f5'
BLUE, RED, GREEN = '#0072B2', '#D55E00', '#007a5a'
SANS = "Helvetica, Arial, 'DejaVu Sans', sans-serif"
MONO = "Menlo, Consolas, 'DejaVu Sans Mono', monospace"
_WIDTH = {SANS: 0.56, MONO: 0.61}   # of a letter, in ems, at most on average
_HEAD = 11.0                        # length of an arrow's head
_SUBSCRIPT = re.compile(r'_(?:\{([^}]*)\}|(\w))')
_LETTERS = re.compile('((?:[^\\W\\d]\u0307?)+)|([\\W\\d]+)')   # a letter and the dot over it stay together

Point = tuple[float, float]


class Style(NamedTuple):
    """How text looks."""

    size: float = 15.0
    anchor: str = 'start'   # or middle, end
    color: str = INK
    font: str = SANS
    weight: str = 'normal'

    def letters(self, width: float) -> int:
        """Return how many letters of an ordinary text surely fit into a width."""
        return int(width / (self.size * _WIDTH[self.font]))


class Sheet:
    """A picture under way; `str` of it is the SVG."""

    def __init__(self, width: float, height: float, title: str) -> None:
        self._frame = f'{width:g} {height:g}'
        self._title = title
        self._elements = [f'<rect width="{width:g}" height="{height:g}" fill="#ffffff"/>']

    def rect(self, corner: Point, size: Point, *, fill: str = '#ffffff', stroke: str = INK,
             radius: float = 0.0) -> None:
        """Draw a rectangle from its upper left corner."""
        place = f'x="{corner[0]:g}" y="{corner[1]:g}" width="{size[0]:g}" height="{size[1]:g}"'
        self._add(f'<rect {place} rx="{radius:g}" fill="{fill}" stroke="{stroke}" stroke-width="1.5"/>')

    def circle(self, centre: Point, radius: float) -> None:
        """Draw a circle."""
        self._add(f'<circle cx="{centre[0]:g}" cy="{centre[1]:g}" r="{radius:g}" fill="#ffffff" stroke="{INK}"'
                  ' stroke-width="1.5"/>')

    def line(self, *points: Point, color: str = INK, width: float = 1.5, dashes: str = '') -> None:
        """Draw a line through points; `dashes` as in SVG."""
        dashed = f' stroke-dasharray="{dashes}"' if dashes else ''
        self._add(f'<polyline points="{_text(points)}" fill="none" stroke="{color}" stroke-width="{width:g}"{dashed}'
                  ' stroke-linejoin="round"/>')

    def arrow(self, *points: Point, color: str = INK, width: float = 2.0, both: bool = False) -> None:
        """Draw a line with a head at its last point, or at both ends."""
        shaft = [*points[:-1], _towards(points[-1], points[-2], _HEAD - 2.0)]
        if both:
            shaft[0] = _towards(points[0], points[1], _HEAD - 2.0)
            self._head(points[1], points[0], color)
        self.line(*shaft, color=color, width=width)
        self._head(points[-2], points[-1], color)

    def text(self, at: Point, words: str, style: Style = Style()) -> None:  # noqa: B008 - a tuple
        """Write one line from (or about, or up to) a point of its base line; between dollars stand formulas."""
        attributes = f'font-family="{escape(style.font)}" font-size="{style.size:g}" fill="{style.color}"'
        if style.anchor != 'start':
            attributes += f' text-anchor="{style.anchor}"'
        if style.weight != 'normal':
            attributes += f' font-weight="{style.weight}"'
        parts = [_formula(part, style.size) if i % 2 else escape(part) for i, part in enumerate(words.split('$'))]
        self._add(f'<text x="{at[0]:g}" y="{at[1]:g}" {attributes} xml:space="preserve">{"".join(parts)}</text>')

    def paragraph(self, at: Point, words: str, width: float, style: Style = Style()) -> float:  # noqa: B008 - a tuple
        """Write lines that fit into a width, from the base line of the first on; return that of the next."""
        x, y = at
        for line in textwrap.wrap(words, style.letters(width)):
            self.text((x, y), line, style)
            y += 1.3 * style.size
        return y

    def _head(self, start: Point, tip: Point, color: str) -> None:
        back = _towards(tip, start, _HEAD)
        across = ((tip[1] - back[1]) * 0.4, (back[0] - tip[0]) * 0.4)
        corners = (tip, (back[0] + across[0], back[1] + across[1]), (back[0] - across[0], back[1] - across[1]))
        self._add(f'<polygon points="{_text(corners)}" fill="{color}"/>')

    def _add(self, element: str) -> None:
        self._elements.append(element)

    def __str__(self) -> str:
        """Return the file."""
        return '\n'.join([
            '<!-- Copyright 2026 The stickslip authors; SPDX-License-Identifier: Apache-2.0 -->',
            '<!-- Made by `make pictures` from dev/pictures/, not by hand. -->',
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self._frame}" role="img">',
            f'<title>{escape(self._title)}</title>', *self._elements, '</svg>', ''])


def _text(points: tuple[Point, ...] | list[Point]) -> str:
    return ' '.join(f'{round(x, 1):g},{round(y, 1):g}' for x, y in points)


def _towards(start: Point, end: Point, distance: float) -> Point:
    """Return the point at a distance from the start on the way to the end."""
    share = distance / math.dist(start, end)
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])


def _formula(words: str, size: float) -> str:
    """Return a formula as spans: letters slanted, what stands behind _ or in _{} smaller and lower."""
    spans, low = '', False
    for i, part in enumerate(_SUBSCRIPT.split(words)):
        if not part:
            continue
        is_low = i % 3 > 0
        shift = f' dy="{size * 0.28 * (is_low - low):g}"' if is_low != low else ''
        small = f' font-size="{size * 0.72:g}"' if is_low else ''
        for letters, others in _LETTERS.findall(part):
            slant = ' font-style="italic"' if letters and not is_low else ''
            spans += f'<tspan{shift}{small}{slant}>{escape(letters or others)}</tspan>'
            shift = ''
        low = is_low
    return spans + (f'<tspan dy="{-size * 0.28:g}">\u200b</tspan>' if low else '')
