# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An axis of a picture for any parameter: in the unit that people use, named as in a scene file."""

from typing import NamedTuple

import numpy as np

from ..core.arrays import Numbers
from .style import MILLI

_SHOWN = {'m': (MILLI, 'mm'), 'ms': (MILLI, 'ms'), 'm/s': (MILLI, 'mm/s'), 'N/m': (1e-6, 'N/µm')}


def in_words(name: str) -> str:
    """Return the name of a parameter or a figure as it is written in a text."""
    words = name.replace('.', ' ').replace('_', ' ')
    return words.replace('break away', 'break-away').replace('stick slip', 'stick-slip')


def unit_read(unit: str, values: Numbers) -> str:
    """Return the unit that values (SI) are read in: ms for times most of which are below a second."""
    known = values[np.isfinite(values)]
    return 'ms' if unit == 's' and len(known) and float(np.median(known)) < 1.0 else unit


def labelled(words: str, unit: str) -> str:
    """Return words with the unit of their numbers, as at an axis or above a column: speed / (mm/s)."""
    return f'{words} / ({unit})' if '/' in unit or ' ' in unit else f'{words} / {unit}' if unit else words


class Scale(NamedTuple):
    """A parameter or a figure: its name, its SI unit, whether its axis is logarithmic.

    The unit `ms` means seconds that are read in ms.  `place` says where an element of a list is.
    """

    name: str
    unit: str
    log: bool = False
    place: str = ''

    def shown(self, values: Numbers | float) -> Numbers:
        """Return SI values in the unit of the picture."""
        return np.asarray(values) * _SHOWN.get(self.unit, (1.0, ''))[0]

    def edges(self, values: Numbers) -> Numbers:
        """Return where the cells about increasing values begin and end, in the unit of the picture.

        They meet half way on this scale; the outermost end at their values.
        """
        places = np.log(self.shown(values)) if self.log else self.shown(values)
        edges = np.concatenate([places[:1], 0.5 * (places[1:] + places[:-1]), places[-1:]])
        return np.asarray(np.exp(edges)) if self.log else edges

    @property
    def label(self) -> str:
        """The text at the axis."""
        unit = _SHOWN.get(self.unit, (1.0, self.unit))[1]
        words = in_words(self.name.removeprefix('axis.')) + (f' at {self.place}' if self.place else '')
        return labelled(words, unit)

    @property
    def kind(self) -> str:
        """The name of matplotlib for the scale."""
        return 'log' if self.log else 'linear'
