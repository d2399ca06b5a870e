# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The path of two axes about a circle, with its radial deviation magnified."""

import math
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from ..core.arrays import Numbers
from ..figures.circular import QUADRANTS, SENSES, CircularTest, Turn
from .style import BLACK, BLUE, GREY, RED, legend_outside, save, shortened, thinned

_MICRO = 1e6
_COLOURS = {1: BLUE, -1: RED}
_LEAST = 1e-3        # µm: a path that deviates less is drawn as a circle
_HOLLOW = 2.5        # ranges of the deviation from the centre to the innermost ring
_LONGEST = 60        # letters of the title


def plot_circle(test: CircularTest, title: str, path: Path | str) -> None:
    """Draw the radial deviations of a circular test over the angle into `path` (.png, .pdf or .svg)."""
    figure = Figure(figsize=(7.6, 8.2), dpi=130, layout=ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.1))
    panel = figure.add_subplot(projection='polar')
    assert isinstance(panel, PolarAxes)
    low = min(_MICRO * turn.smallest for turn in test.turns)
    high = max(_MICRO * turn.largest for turn in test.turns)
    span = max(high - low, _LEAST)
    panel.set_rlim(min(low, 0.0) - 0.15 * span, max(high, 0.0) + 0.15 * span)
    panel.set_rorigin(panel.get_rmin() - _HOLLOW * span)
    panel.plot(np.linspace(0.0, 2.0 * math.pi, 721), np.zeros(721), color=BLACK, linewidth=1.0, linestyle=(0, (5, 2)))
    for turn in test.turns:
        angle, deviation = _drawn(turn)
        panel.plot(angle, deviation, color=_COLOURS[turn.sense], linewidth=1.3)
    panel.set_thetagrids(np.arange(0, 360, 45), ['+x', '', '+y', '', '\u2212x', '', '\u2212y', ''])
    panel.set_rlabel_position(45.0)
    panel.yaxis.set_major_locator(MaxNLocator(6))
    panel.tick_params(axis='y', labelsize=9, labelcolor=GREY)
    panel.grid(color='#dddddd', linewidth=0.6)
    panel.set_axisbelow(True)
    heading, _, rest = title.partition('\n')
    panel.set_title(f'{shortened(heading, _LONGEST)}\n{rest}radial deviation / µm', loc='left', fontsize=11)
    lines = [Line2D([], [], color=BLACK, linewidth=1.0, linestyle=(0, (5, 2))),
             *(Line2D([], [], color=_COLOURS[turn.sense], linewidth=1.3) for turn in test.turns)]
    labels = [f'nominal, radius {1e3 * test.nominal.radius:.6g} mm', *map(_label, test.turns)]
    legend_outside(figure, 'lower center', lines, labels, frameon=False, fontsize=9)
    save(figure, path)


def _drawn(turn: Turn) -> tuple[Numbers, Numbers]:
    """Return angles (rad) and deviations (µm), of long ones the extremes."""
    angle, deviation = thinned(turn.angle, _MICRO * turn.deviation)
    return turn.sense * angle, deviation


def _label(turn: Turn) -> str:
    known = [name for name in QUADRANTS if name in turn.glitches]
    glitches = ', '.join(f'{_MICRO * turn.glitches[name]:+.2f} at {name}' for name in known)
    return f'{SENSES[turn.sense]}: G {_MICRO * turn.circular_deviation:.2f} µm; glitches {glitches} µm'
