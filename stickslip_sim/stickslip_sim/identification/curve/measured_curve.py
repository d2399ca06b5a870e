# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A measured friction curve from a CSV file: a speed and a coefficient, or a friction force, in each line.

Separated by commas, semicolons or tabs; with the last two a decimal comma is read too.  Lines above the first number
are headings, lines after `#` remarks, columns after the second are not read.  Both directions of motion may be in one
file: a negative speed is the backward direction, and its friction may be signed like the speed or have no sign.
"""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.arrays import Numbers
from ...core.errors import ALLOW, InputError
from ...inputs.units import FORCES, SI_ALONE, SPEEDS, DriveUnits, in_si, named_unit, unit_of
from ...scene.load import named, read_text
from ...scene.plausible import FASTEST, ROUGHEST

SLOWEST = 2e-4        # m/s: the fastest point of a plausible curve is faster
SMOOTHEST = 1e-4      # a coefficient: the highest of a plausible curve is higher, but for hydrostatic guides
_MOST_POINTS = 20_000
_WHAT = 'friction curve'


class FrictionCurve(NamedTuple):
    """Measured points by rising speed: `speeds` >= 0 in m/s, `coefficients`, and whether each is `forward`.

    Without a normal force the coefficients are forces, N.
    """

    speeds: Numbers
    coefficients: Numbers
    forward: NDArray[np.bool_]
    unread: int = 0          # columns of the file after the second
    spread: Numbers | None = None   # the quartiles of each (2, n)

    def chosen(self, direction: str) -> 'FrictionCurve':
        """Return the points that are forward or backward, or both; raises InputError where there is none."""
        those = {'forward': self.forward, 'backward': ~self.forward}.get(direction, np.full(self.forward.shape, True))
        if not those.any():
            raise InputError('--direction', direction, 'a direction that has points', 'omit it to use all')
        return self._replace(speeds=self.speeds[those], coefficients=self.coefficients[those],
                             forward=self.forward[those],
                             spread=None if self.spread is None else self.spread[:, those])


class Units(NamedTuple):
    """How the columns are read: names of units; `force` None: the second is a coefficient; `normal_force` in N.

    A force without a normal force is fitted as a force.  `drive` has the units of turns, torque and ratings.
    """

    speed: str
    force: str | None = None
    normal_force: float | None = None
    drive: DriveUnits = SI_ALONE

    @property
    def are_forces(self) -> bool:
        """Whether what is fitted are forces."""
        return self.force is not None and self.normal_force is None


class _Point(NamedTuple):
    line: int
    speed: float
    friction: float


def units_of(speed: str, force: str | None, normal_force: float | None, drive: DriveUnits = SI_ALONE) -> Units:
    """Return the units of the columns; raises InputError."""
    speed = unit_of('--speed-unit', speed, drive.of(SPEEDS))
    if force is None:
        if normal_force is not None:
            raise InputError('--normal-force', normal_force, 'given with --force-unit, for a column of forces',
                             'add --force-unit N, or drop it for a column of coefficients')
        return Units(speed, drive=drive)
    if normal_force is not None and not 0.0 < normal_force < math.inf:
        raise InputError('--normal-force', normal_force, 'in N, finite and > 0',
                         'the coefficient is the force divided by it')
    return Units(speed, unit_of('--force-unit', force, drive.of(FORCES)), normal_force, drive)


def load_curve(path: str, units: Units, meant: tuple[str, ...] = ()) -> FrictionCurve:
    """Return the curve of a file; raises InputError, whose text names the file.

    A curve that no slideway has, because a unit was mistaken, is refused unless `speed` or `friction` is `meant`.
    """
    text = read_text(Path(path), _WHAT)
    with named(path):
        headings, points, columns = _read(text)
        if not points:
            raise InputError(_WHAT, 'no point', 'lines of two numbers, a speed and its friction', 'check the file')
        if len(points) > _MOST_POINTS:
            raise InputError(_WHAT, f'{len(points)} points', f'at most {_MOST_POINTS}', 'average points of one speed')
        _check_headings(headings, units)
        curve = _curve(points, units)
        if not curve.coefficients.any():
            raise InputError(_WHAT, '0 all over', 'friction above 0', 'nothing to fit; check the columns')
        _check_plausible(curve, units, meant)
        return curve._replace(unread=columns - 2)


def _read(text: str) -> tuple[list[list[str]], list[_Point], int]:
    """Return the headings, the points, and how many columns they have."""
    headings: list[list[str]] = []
    points: list[_Point] = []
    columns = 2
    for line, cells in _rows(text):
        if not points and _is_heading(cells):
            headings.append(cells)
        else:
            points.append(_point(line, cells))
            columns = max(columns, len(cells))
    return headings, points, columns


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the number of each line that is not empty, and its cells."""
    for number, line in enumerate(text.splitlines(), 1):
        line = line.partition('#')[0].strip()
        if line:
            mark = next((mark for mark in ';\t,' if mark in line), None)
            cells = line.split(mark)   # None: at spaces
            yield number, [_plain(cell, decimal_comma=mark != ',') for cell in cells]


def _plain(cell: str, decimal_comma: bool) -> str:
    cell = cell.strip().strip('"\'')
    return cell.replace(',', '.') if decimal_comma and cell.count(',') == 1 and '.' not in cell else cell


def _is_heading(cells: list[str]) -> bool:
    """Return whether a line is words: half a number is a slip of the pen, and no heading."""
    return all(cell and not cell.lstrip('+-.')[:1].isdigit() and _number(cell) is None for cell in cells[:2])


def _point(line: int, cells: list[str]) -> _Point:
    """Return the point of a line; raises InputError."""
    if len(cells) < 2:
        raise InputError(f'line {line}', cells[0], 'two columns, a speed and its friction',
                         'separate them by a comma, a semicolon or a tab')
    speed, friction = (_number(cell) for cell in cells[:2])
    for cell, number in zip(cells, (speed, friction)):
        if number is None or not math.isfinite(number):
            raise InputError(f'line {line}', cell, 'a finite number', 'correct it, or put # before the line')
    return _Point(line, speed or 0.0, friction or 0.0)


def _number(cell: str) -> float | None:
    try:
        return float(cell) if '_' not in cell else None
    except ValueError:
        return None


def _check_headings(headings: list[list[str]], units: Units) -> None:
    """Raise InputError when a heading names another unit than the option."""
    for option, column, given, known in (('--speed-unit', 0, units.speed, units.drive.of(SPEEDS)),
                                         ('--force-unit', 1, units.force, units.drive.of(FORCES))):
        for cells in headings:
            unit = named_unit(cells[column], known) if column < len(cells) else None
            if unit is not None and unit != given:
                raise InputError(option, given, f'{unit}, as the heading says: {cells[column]}',
                                 f'give {option} {unit}' + (' and --normal-force' if column else '')
                                 + ', or correct the heading')


def _curve(points: list[_Point], units: Units) -> FrictionCurve:
    """Return all points in SI by rising speed; raises InputError."""
    backward = [point.friction for point in points if point.speed < 0.0]
    signed = any(friction < 0.0 for friction in backward)
    for point in points:
        opposed = point.speed < 0.0 and signed
        if point.friction > 0.0 if opposed else point.friction < 0.0:
            raise InputError(f'line {point.line}', point.friction, 'friction of one sign for one direction of motion',
                             'give all of it the sign of the speed, or none; leave out starts and reversals')
    factor, of_force = units.drive.of(SPEEDS)[units.speed], units.drive.of(FORCES)[units.force or 'N']
    speeds = np.array([in_si(abs(point.speed), factor) for point in points])
    frictions = np.array([in_si(abs(point.friction), of_force) for point in points])
    order = np.argsort(speeds, kind='stable')
    forward = np.array([point.speed >= 0.0 for point in points])
    return FrictionCurve(speeds[order], frictions[order] / (units.normal_force or 1.0), forward[order])


def _check_plausible(curve: FrictionCurve, units: Units, meant: tuple[str, ...]) -> None:
    """Raise InputError on a curve that looks as if it had been read in the wrong unit: it is asked back."""
    force = f' and {units.normal_force:g} N' if units.normal_force else ''
    for name, most, unit, low, high, read in (
            ('speed', curve.speeds.max(), ' m/s', SLOWEST, FASTEST, units.speed),
            ('friction', curve.coefficients.max(), '', SMOOTHEST, ROUGHEST,
             f'{units.force}{force}' if units.force else 'a coefficient')):
        if not low <= most <= high and name not in meant and not (name == 'friction' and units.are_forces):
            raise InputError(f'the highest {name}', f'{most:g}{unit}',
                             f'plausible for a slideway, from {low:g} to {high:g}{unit}', f'it was read as {read}: '
                             f'correct the unit, or if it is intended, add {ALLOW} {name}')
