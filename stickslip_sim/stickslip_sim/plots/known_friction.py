# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Identified friction with its band beside what was measured: kinetic over speed, static over the time at rest."""

from collections.abc import Mapping
from pathlib import Path
from string import ascii_lowercase
from typing import NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..core.arrays import Numbers
from .style import (
    BLACK,
    BLUE,
    DOUBLE_COLUMN,
    GREY,
    JOURNAL,
    MILLI,
    ORANGE,
    SKY,
    legend_of,
    letter,
    save,
)

_HEIGHT, _ROW = 3.2, 2.6   # in, with one direction, and of one more
_ABOVE = 1.1    # of the highest curve
_MOST = 4000    # measured points that are drawn


class Band(NamedTuple):
    """A curve at `places` (m/s or s): its `values`, and half the width of its 95 % band there (NaN: not known)."""

    places: Numbers
    values: Numbers
    half: Numbers


class Scatter(NamedTuple):
    """Measured points, at `places` (m/s or s)."""

    places: Numbers
    values: Numbers


class Bins(NamedTuple):
    """Measured points by bins: where, their median, and the quartiles."""

    places: Numbers
    middles: Numbers
    low: Numbers
    high: Numbers


class KnownFriction(NamedTuple):
    """Coefficients of friction: identified with bands, those of the start, and measured.

    `accelerating` is the branch of a slip after the rest that is usual in the run; None without one.
    """

    kinetic: Band
    accelerating: Band | None
    start_kinetic: Scatter
    points: Scatter
    bins: Bins
    static: Band
    start_static: Scatter
    break_aways: Scatter


def plot_known_friction(directions: Mapping[str, KnownFriction], path: Path | str) -> None:
    """Draw kinetic friction over speed and static friction over the time at rest, a row for each direction by name."""
    with rc_context(JOURNAL):
        figure = Figure(figsize=(DOUBLE_COLUMN, _HEIGHT + _ROW * (len(directions) - 1)),
                        layout=ConstrainedLayoutEngine(w_pad=0.06, h_pad=0.05))
        panels = figure.subplots(len(directions), 2, squeeze=False, sharey=True, width_ratios=(3, 2))
        for (kinetic, static), (name, friction) in zip(panels, directions.items()):
            _kinetic(kinetic, friction)
            _static(static, friction)
            kinetic.set_title(name, fontsize=8.0, loc='left')
        panels[0, 0].set_ylim(0.0, max(map(_top, directions.values())))
        for panel, name in zip(panels.flat, ascii_lowercase):
            letter(panel, name)
        legend_of(figure, 'upper center', panels[0, 1], panels[0, 0], ncols=4)
        save(figure, path)


def _top(friction: KnownFriction) -> float:
    """Return the coefficient up to which a direction is drawn; lone readings far above are left out."""
    curves = [friction.kinetic, friction.static, *([friction.accelerating] if friction.accelerating else [])]
    highest = max(float((band.values + np.nan_to_num(band.half)).max()) for band in curves)
    starts = friction.start_kinetic.values, friction.start_static.values, friction.break_aways.values
    return _ABOVE * max(highest, *(float(values.max(initial=0.0)) for values in (*starts, friction.bins.high)))


def _kinetic(panel: Axes, friction: KnownFriction) -> None:
    step = max(1, len(friction.points.places) // _MOST)
    panel.plot(MILLI * friction.points.places[::step], friction.points.values[::step], '.', color=GREY, markersize=2.0,
               alpha=0.4, markeredgewidth=0.0)
    _curve(panel, friction.kinetic, MILLI, BLUE, 'identified, 95 % band')
    if friction.accelerating is not None:
        _curve(panel, friction.accelerating, MILLI, ORANGE, 'accelerating, after the usual rest')
    panel.plot(MILLI * friction.start_kinetic.places, friction.start_kinetic.values, color=GREY, linewidth=0.9,
               linestyle=(0, (4.0, 2.0)), label='scene to start with')
    bins = friction.bins
    if len(bins.places):
        panel.errorbar(MILLI * bins.places, bins.middles, (bins.middles - bins.low, bins.high - bins.middles), fmt='o',
                       color=BLACK, markersize=3.0, markerfacecolor='white', elinewidth=0.7, zorder=4.0,
                       label='measured: median and quartiles')
    panel.set(xlabel='speed / (mm/s)', ylabel='coefficient of friction')
    panel.set_xlim(0.0, MILLI * friction.kinetic.places[-1])


def _static(panel: Axes, friction: KnownFriction) -> None:
    _curve(panel, friction.static, 1.0, BLUE, 'identified, 95 % band')
    panel.plot(friction.start_static.places, friction.start_static.values, color=GREY, linewidth=0.9,
               linestyle=(0, (4.0, 2.0)), label='scene to start with')
    panel.plot(friction.break_aways.places, friction.break_aways.values, 'o', color=BLACK, markersize=3.0,
               markerfacecolor='white', zorder=4.0, label='measured: median and quartiles')
    panel.set(xlabel='time at rest / s')
    panel.set_title('○ break-aways that were measured' if len(friction.break_aways.places)
                    else 'no break-away force was measured', fontsize=7.0, loc='right')
    panel.set_xlim(0.0, friction.static.places[-1])


def _curve(panel: Axes, band: Band, scale: float, colour: str, label: str) -> None:
    panel.plot(scale * band.places, band.values, color=colour, linewidth=1.4, label=label, zorder=3.0)
    panel.fill_between(scale * band.places, band.values - band.half, band.values + band.half, alpha=0.35, linewidth=0.0,
                       color=SKY if colour == BLUE else colour)
