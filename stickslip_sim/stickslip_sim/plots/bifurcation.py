# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A bifurcation diagram: the last cycles and steady sliding over a parameter, for a journal's double column."""

from pathlib import Path
from typing import Any

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..core.arrays import Numbers
from .scale import Scale
from .style import BLACK, BLUE, DOUBLE_COLUMN, GREEN, JOURNAL, MILLI, ORANGE, legend_of, letter, save

_DOT: dict[str, Any] = {'linestyle': '', 'marker': 'o', 'markersize': 1.6, 'markeredgewidth': 0.0}


def plot_bifurcation(over: Scale, cycles: Numbers, sliding: Numbers, path: Path | str) -> None:
    """Draw drive force and jump of each cycle, and steady sliding, over a parameter; SI units.

    Rows of `cycles`: value, drive force at break-away and at arrest, jump; of `sliding`: value, drive force, 1 where
    it is stable.
    """
    with rc_context(JOURNAL):
        figure = Figure(figsize=(DOUBLE_COLUMN, 2.9), layout=ConstrainedLayoutEngine(w_pad=0.06, h_pad=0.06))
        force, jump = figure.subplots(1, 2, sharex=True)
        _forces(force, over, cycles, sliding)
        jump.plot(over.shown(cycles[:, 0]), cycles[:, 3] * MILLI, color=GREEN, **_DOT)
        jump.set(ylabel='jump from cycle to cycle / mm')
        for panel, name in zip((force, jump), 'ab'):
            panel.set(xlabel=over.label, xscale=over.kind)
            panel.set_ylim(bottom=min(0.0, panel.get_ylim()[0]))
            letter(panel, name)
        legend_of(figure, 'upper left', force, ncols=4, markerscale=2.5)
        save(figure, path)


def _forces(panel: Axes, over: Scale, cycles: Numbers, sliding: Numbers) -> None:
    values = over.shown(cycles[:, 0])
    panel.plot(values, cycles[:, 1], color=ORANGE, label='at break-away', **_DOT)
    panel.plot(values, cycles[:, 2], color=BLUE, label='at arrest', **_DOT)
    for stable, style, label in ((True, 'solid', 'stable'), (False, (0, (3.0, 2.0)), 'unstable')):
        shown = sliding.copy()
        shown[shown[:, 2] != float(stable), 1] = float('nan')
        panel.plot(over.shown(shown[:, 0]), shown[:, 1], color=BLACK, linestyle=style, linewidth=1.2,
                   label=f'steady sliding, {label}')
    panel.set(ylabel='drive force / N')
