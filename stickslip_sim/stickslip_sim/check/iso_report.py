# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""All figures of a circular test and of a positioning test, as the certificate of a machine has them; SI in values."""

from collections.abc import Iterator, Sequence
from typing import Any

from ..figures.catalogue import label_of
from ..figures.circular import QUADRANTS, SENSES, CircularTest
from ..figures.positioning import PositionFigures, positioning_figures
from ..report.model import Part, Table
from ..report.quantity import quantity

IsoTest = CircularTest | Sequence[PositionFigures]
_OF_BOTH = 'bidirectional_circular_deviation', 'mean_radial_deviation'
_TWO_WAY = 'positioning_accuracy', 'positioning_repeatability', 'systematic_positioning_error'
_OF_A_TARGET = 'mean_forward', 'mean_backward', 'mean', 'reversal', 's_forward', 's_backward', 'repeatability'


def iso_parts(test: IsoTest) -> Iterator[Part]:
    """Yield tables of a test for people."""
    yield from _circle(test) if isinstance(test, CircularTest) else _positions(test)


def iso_values(test: IsoTest) -> dict[str, Any]:
    """Return the same by name, in m, for JSON."""
    if not isinstance(test, CircularTest):
        return {'positioning': {**positioning_figures(test)._asdict(), 'targets': [
            {'target': one.target, **{name: getattr(one, name) for name in _OF_A_TARGET}} for one in test]}}
    turns = [{'sense': SENSES[turn.sense], 'circular_deviation': turn.circular_deviation,
              'largest_radial_deviation': turn.largest, 'smallest_radial_deviation': turn.smallest,
              'quadrant_glitches': turn.glitches} for turn in test.turns]
    both = {name: getattr(test, name) for name in _OF_BOTH} if test.is_bidirectional else {}
    return {'circle': {'nominal': test.nominal, 'turns': turns, **both}}


def _circle(test: CircularTest) -> Iterator[Part]:
    x, y, radius = (quantity(value, 'm') for value in test.nominal)
    yield f'ISO 230-4: circle of radius {radius} about x = {x}, y = {y}'
    rows: list[tuple[str, list[float | None]]] = [
        ('G, circular deviation', [turn.circular_deviation for turn in test.turns]),
        ('F max, radial deviation', [turn.largest for turn in test.turns]),
        ('F min', [turn.smallest for turn in test.turns]),
        *((f'quadrant glitch at {name}', [turn.glitches.get(name) for turn in test.turns]) for name in QUADRANTS)]
    yield Table(('', *(SENSES[turn.sense] for turn in test.turns)),
                [(label, *('–' if value is None else quantity(value, 'm') for value in values))
                 for label, values in rows])
    if test.is_bidirectional:
        yield (f'G(b) {quantity(test.bidirectional_circular_deviation, "m")}, '
               f'D {quantity(test.mean_radial_deviation, "m")}')


def _positions(positions: Sequence[PositionFigures]) -> Iterator[Part]:
    figures = positioning_figures(positions)._asdict()
    yield f'ISO 230-2: {len(positions)} targets'
    yield Table(('target', *(f'{head} / µm' for head in ('mean ↑', 'mean ↓', 'mean', 'B', 's ↑', 's ↓', 'R'))),
                [(quantity(one.target, 'm'), *(_micrometres(getattr(one, name)) for name in _OF_A_TARGET))
                 for one in positions], texts=())
    yield Table(('', 'bi-directional', 'forward', 'backward'),
                [*((label_of(name), *(quantity(figures[name + way], 'm') for way in ('', '_forward', '_backward')))
                   for name in _TWO_WAY),
                 *((label_of(name), quantity(figures[name], 'm'), '', '')
                   for name in ('mean_positioning_error', 'reversal_error', 'mean_reversal_error'))])


def _micrometres(value: float) -> str:
    """Return a length to a tenth of a nanometre, without a sign before 0."""
    return f'{round(1e6 * value, 4) + 0.0:.4f}'
