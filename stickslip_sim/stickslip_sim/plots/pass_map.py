# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A map of what becomes of many runs over two parameters: each point with the colour of its outcome."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..core.arrays import Numbers
from .style import BLACK, BLUE, GREY, JOURNAL, ORANGE, PURPLE, RED, SINGLE_COLUMN, Scale, legend_of, save

_HEIGHT = 3.3   # in
_LOOKS = ((BLUE, 'o'), (RED, 'X'), (BLACK, 's'), (PURPLE, 'D'), (ORANGE, 'v'))   # passed, and so on
_SMALL, _LARGE, _MANY = 5.0, 24.0, 400   # points² of a marker


def plot_pass_map(scales: tuple[Scale, Scale], x: Numbers, y: Numbers, outcomes: Sequence[str],
                  kinds: Sequence[str], title: str, path: Path | str) -> None:
    """Draw points (SI units) over x and y, each with its outcome; `kinds` are all outcomes in their order."""
    found = np.array(outcomes)
    with rc_context(JOURNAL):
        figure = Figure(figsize=(SINGLE_COLUMN + 1.0, _HEIGHT), layout=ConstrainedLayoutEngine(w_pad=0.05, h_pad=0.05))
        panel = figure.subplots()
        size = _LARGE if len(x) <= _MANY else _SMALL
        for kind, (colour, marker) in zip(kinds, _LOOKS):
            chosen = found == kind
            if chosen.any():
                panel.scatter(scales[0].shown(x[chosen]), scales[1].shown(y[chosen]), s=size, c=colour, marker=marker,
                              linewidths=0.0, label=f'{kind} ({int(chosen.sum())})')
        panel.set(xlabel=scales[0].label, ylabel=scales[1].label, xscale=scales[0].kind, yscale=scales[1].kind)
        panel.set_title(title, loc='left', fontsize=8.0, color=GREY)
        legend_of(figure, 'upper left', panel, ncols=2)
        save(figure, path)
