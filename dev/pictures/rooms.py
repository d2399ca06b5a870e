# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The rooms of the package by floors, from what is kept by machine: import-linter's contracts, and docstrings."""

import ast
import re
import textwrap
from pathlib import Path
from typing import NamedTuple

from importlinter.api import read_configuration

from .svg import BLUE, GREY, MONO, PALE, RED, Sheet, Style

ROOT = Path(__file__).parents[2]
PACKAGE = 'stickslip_sim'
_SIDE, _GAP, _BETWEEN, _WIDTH = 70.0, 8.0, 18.0, 1200.0
_ABREAST = 4
_NAME = Style(16.0, font=MONO, weight='bold')
_LINE = Style(13.0)
_DOOR = Style(12.0, 'end', RED)


class Room(NamedTuple):
    """A room: its name, what it is for, and what it alone may import."""

    name: str
    purpose: str
    doors: list[str]


def floors() -> list[list[Room]]:
    """Return the rooms of each floor, from the roof down."""
    contracts = read_configuration(str(ROOT / 'pyproject.toml'))['contracts_options']
    layers, = (contract['layers'] for contract in contracts if contract.get('containers') == [PACKAGE])
    doors = [(contract['name'].removeprefix('One door to '), contract['ignore_imports'])
             for contract in contracts if contract['name'].startswith('One door to ')]
    return [[Room(name, purpose(name), [door for door, ways in doors if any(name == _room(way) for way in ways)])
             for name in re.findall(r'\w+', layer)] for layer in layers]


def _room(way: str) -> str:
    """Return the room of `stickslip_sim.ROOM.module -> library`."""
    return way.split(' -> ')[0].split('.')[1]


def purpose(room: str) -> str:
    """Return the first sentence that a room says of itself."""
    place = ROOT / PACKAGE / PACKAGE / room
    file = place / '__init__.py' if place.is_dir() else place.with_suffix('.py')
    words = ast.get_docstring(ast.parse(file.read_text(encoding='utf-8'))) or ''
    return re.split(r'\.\s', words + ' ')[0].replace('\n', ' ').replace('`', '')


def picture() -> Sheet:
    """Return the picture."""
    bands = [[floor[start:start + _ABREAST] for start in range(0, len(floor), _ABREAST)] for floor in floors()]
    heights = [[_height(row) for row in band] for band in bands]
    total = sum(map(sum, heights)) + _GAP * sum(map(len, bands)) + _BETWEEN * len(bands)
    sheet = Sheet(_WIDTH, total + 60, 'The rooms of the package by floors')
    sheet.text((_SIDE, 30), 'A room imports only from the floors below it, and not from its neighbours.', Style(16.0))
    sheet.arrow((30, 56), (30, total + 40), color=BLUE, width=3)
    y = 48.0
    for band, its_heights in zip(bands, heights):
        whole = sum(its_heights) + _GAP * (len(band) + 1)
        sheet.rect((_SIDE - _GAP, y), (_WIDTH - _SIDE, whole), fill=PALE, stroke=PALE, radius=10)
        y += _GAP
        for row, height in zip(band, its_heights):
            _row(sheet, row, y, height)
            y += height + _GAP
        y += _BETWEEN - _GAP
    return sheet


def _row(sheet: Sheet, row: list[Room], y: float, height: float) -> None:
    width = _width(row)
    for i, room in enumerate(row):
        x = _SIDE + i * (width + _GAP)
        sheet.rect((x, y), (width, height), stroke=GREY, radius=6)
        sheet.text((x + 14, y + 24), room.name, _NAME)
        if room.doors:
            sheet.text((x + width - 12, y + 23), 'alone knows ' + ', '.join(room.doors), _DOOR)
        sheet.paragraph((x + 14, y + 45), room.purpose, width - 28, _LINE)


def _height(row: list[Room]) -> float:
    return 17.0 * max(_lines(room, _width(row)) for room in row) + 36


def _width(row: list[Room]) -> float:
    return (_WIDTH - _SIDE - 2 * _GAP - _GAP * (len(row) - 1)) / len(row)


def _lines(room: Room, width: float) -> int:
    return len(textwrap.wrap(room.purpose, _LINE.letters(width - 28)))
