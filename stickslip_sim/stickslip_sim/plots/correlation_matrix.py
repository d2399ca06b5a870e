# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How the errors of numbers that were found together go together: a matrix of correlations."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..core.arrays import Numbers
from .style import GREY, JOURNAL, save

_CELL, _MARGIN, _NAMES = 0.42, 0.5, 2.4   # in
_DARK = 0.6                               # of a colour: white numbers above it


def plot_correlations(names: Sequence[str], matrix: Numbers, path: Path | str) -> None:
    """Draw correlations (k, k) by colour, with their numbers; what is NaN is not determined."""
    count = len(names)
    with rc_context({**JOURNAL, 'axes.grid': False, 'axes.spines.left': False, 'axes.spines.bottom': False}):
        figure = Figure(figsize=(_NAMES + _MARGIN + _CELL * count, _NAMES / 2 + _CELL * count),
                        layout=ConstrainedLayoutEngine(w_pad=0.05, h_pad=0.05))
        panel = figure.subplots()
        panel.imshow(matrix, cmap='RdBu_r', vmin=-1.0, vmax=1.0, aspect='equal')
        for i in range(count):
            for j in range(count):
                value = matrix[i, j]
                text = f'{value:.2f}' if np.isfinite(value) else '–'
                colour = 'white' if abs(value) > _DARK else GREY if not np.isfinite(value) else 'black'
                panel.text(j, i, text, ha='center', va='center', fontsize=6.5, color=colour)
        panel.set_yticks(range(count), names)
        panel.set_xticks(range(count), names, rotation=45, ha='right', rotation_mode='anchor')
        panel.tick_params(length=0.0)
        save(figure, path)
