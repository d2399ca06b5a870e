# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Identified friction with its band beside what was measured: kinetic over speed, static over the time at rest."""

from pathlib import Path
from typing import NamedTuple

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

_HEIGHT = 3.2   # in
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


def plot_known_friction(friction: KnownFriction, path: Path | str) -> None:
    """Draw kinetic friction over speed and static friction over the time at rest."""
    with rc_context(JOURNAL):
        figure = Figure(figsize=(DOUBLE_COLUMN, _HEIGHT), layout=ConstrainedLayoutEngine(w_pad=0.06, h_pad=0.05))
        kinetic, static = figure.subplots(1, 2, sharey=True, width_ratios=(3, 2))
        _kinetic(kinetic, friction)
        _static(static, friction)
        top = max(float(axes.get_ylim()[1]) for axes in (kinetic, static))
        kinetic.set_ylim(0.0, top)
        for panel, name in zip((kinetic, static), 'ab'):
            letter(panel, name)
        legend_of(figure, 'upper center', static, kinetic, ncols=4)
        save(figure, path)


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
    if len(friction.points.values):
        panel.set_ylim(0.0, 1.3 * max(float(friction.static.values.max()), float(friction.kinetic.values.max())))


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
