# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The motion of an axis that is known only roughly: the spread of its figures, and the parameters that decide them."""

import math
from collections.abc import Sequence
from pathlib import Path
from textwrap import fill
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import SubFigure
from matplotlib.ticker import MaxNLocator

from ..core.arrays import Numbers
from ..figures.catalogue import in_words
from .style import BLACK, BLUE, DOUBLE_COLUMN, GREY, SKY, Scale, journal, legend_of, letter

_MOST_BINS = 30   # a square root of the points, where that is less
_NARROW = 1e-6   # of its size: a figure that spreads less is drawn as one value, in a range of 1 %
_COLUMNS = 3
_ROW, _BAR = 1.25, 0.3   # in, of histograms and of a parameter
_TITLE = 14              # letters in a line above the bars of a figure
_MARGIN = 1.0            # in, about the bars
_THICK = 0.36            # of the distance of two parameters
_LINES = {'median': 'solid', '25 and 75 %': (0, (4.0, 1.5)), '5 and 95 %': (0, (1.0, 1.2))}


class Spread(NamedTuple):
    """The values of a figure, SI units, and its percentiles: 5, 25, 50, 75, 95 %; both empty where none has it."""

    scale: Scale
    values: Numbers
    percentiles: Sequence[float]


class Shares(NamedTuple):
    """Shares of the variance of a `figure`: of each parameter by itself, and with others; with standard errors."""

    figure: str
    first_order: Numbers
    error: Numbers
    total: Numbers
    total_error: Numbers


def plot_uncertainty(spreads: Sequence[Spread], heading: str, parameters: Sequence[str], shares: Sequence[Shares],
                     path: Path | str) -> None:
    """Draw a histogram of each figure under a `heading`, and below, a column for each, the shares of `parameters`."""
    rows = -(-len(spreads) // min(_COLUMNS, len(spreads)))
    heights = [_ROW * rows + 0.5, *([_BAR * len(parameters) + _MARGIN] if shares else [])]
    with journal(DOUBLE_COLUMN, sum(heights), path) as figure:
        parts = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
        _spreads(parts[0], spreads, heading)
        if shares:
            _shares(parts[1], parameters, shares)


def _spreads(part: SubFigure, spreads: Sequence[Spread], heading: str) -> None:
    columns = min(_COLUMNS, len(spreads))
    panels = part.subplots(-(-len(spreads) // columns), columns, squeeze=False)
    for panel, spread in zip(panels.flat, spreads):
        _histogram(panel, spread)
    for panel in panels[:, 0]:
        panel.set_ylabel('points / %')
    letter(panels[0, 0], 'a')
    panels[0, 0].set_title(heading, loc='left', fontsize=8.0)
    legend_of(part, 'upper right', *panels.flat, ncols=3)


def _histogram(panel: Axes, spread: Spread) -> None:
    panel.set(xlabel=spread.scale.label)
    if not len(spread.values):
        panel.set(xticks=[], yticks=[])
        panel.text(0.5, 0.5, 'none', transform=panel.transAxes, ha='center', va='center', color=GREY)
        return
    values = spread.scale.shown(spread.values)
    bins = min(math.isqrt(len(values)), _MOST_BINS)
    panel.hist(values, bins=bins, range=_range(values), weights=np.full(len(values), 100.0 / len(values)),
               color=SKY)
    low, quarter, median, three_quarters, high = spread.scale.shown(np.array(spread.percentiles)).tolist()
    for (label, style), places in zip(_LINES.items(), ((median,), (quarter, three_quarters), (low, high))):
        for k, place in enumerate(places):
            panel.axvline(place, color=BLACK, linewidth=0.9, linestyle=style, label='' if k else label)
    panel.xaxis.set_major_locator(MaxNLocator(5))
    panel.grid(visible=False, axis='x')


def _range(values: Numbers) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    size = max(abs(low), abs(high))
    return (low, high) if high - low > _NARROW * size else (low - 0.005 * size, high + 0.005 * size)


def _shares(part: SubFigure, parameters: Sequence[str], shares: Sequence[Shares]) -> None:
    panels = part.subplots(1, len(shares), squeeze=False, sharex=True, sharey=True)[0]
    places = np.arange(len(parameters))
    for panel, one in zip(panels, shares):
        for side, label, values, errors, face in ((-0.5, 'by itself', one.first_order, one.error, BLUE),
                                                  (0.5, 'with its interactions', one.total, one.total_error, 'white')):
            panel.barh(places + side * _THICK, values, _THICK, xerr=errors, facecolor=face, edgecolor=BLUE,
                       linewidth=0.7, label=label, error_kw={'elinewidth': 0.8, 'capsize': 1.5, 'ecolor': BLACK})
        panel.set_title(fill(in_words(one.figure), _TITLE), loc='left', fontsize=7.5)
        panel.set(yticks=places, yticklabels=parameters)
        panel.grid(visible=False, axis='y')
        panel.axvline(0.0, color=BLACK, linewidth=0.6)
        panel.set(xticks=[0.0, 0.5, 1.0], ylim=(len(parameters) - 0.45, -0.55))
    letter(panels[0], 'b')
    part.supxlabel('share of the variance that the parameter explains, ± standard error', fontsize=8.0)
    legend_of(part, 'upper right', panels[0], ncols=2)
