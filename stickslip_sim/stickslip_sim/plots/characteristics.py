# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction characteristics as in Fig. 6 of the paper: kinetic over velocity, static over rest time."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.transforms import ScaledTranslation

from ..core.arrays import Numbers
from . import style

_BRANCHES = ((style.ORANGE, 'solid'), (style.RED, (0, (5.0, 1.5))))


class Curve(NamedTuple):
    """Points of a line."""

    x: Numbers
    y: Numbers


class Characteristics(NamedTuple):
    """The friction of an axis in one direction, or in both where it is the same, and where a run touched it.

    Speeds are in m/s, times in s, coefficients without unit.
    """

    decelerating: Curve
    accelerating: Mapping[str, Curve]   # by the name of the branch
    static: Curve
    static_limit: float | None          # upon prolonged rest
    break_aways: Curve                  # rest time (finite) and coefficient of those of the run
    has_prolonged_rest: bool            # whether one followed an infinite rest


class _Look(NamedTuple):
    """How a direction is drawn: its sign, its name behind those of lines, and the look of its static friction."""

    sign: float
    name: str
    dashes: Any
    inside: str      # the colour inside its marks


_BOTH = _Look(1.0, '', 'solid', 'white')
_EACH = _Look(1.0, ', forwards', 'solid', style.BLACK), _Look(-1.0, ', backwards', (0, (5.0, 1.5)), 'white')
_BAR = 2.5                # points: the width of the bar of static friction
_BESIDE = _BAR / 2 / 72   # in


def plot_characteristics(sides: Sequence[Characteristics], *paths: Path | str) -> None:
    """Draw kinetic and static friction beside each other: of both directions, or forwards and backwards."""
    with style.journal(style.DOUBLE_COLUMN, 2.7, *paths, pads=(0.06, 0.06)) as figure:
        kinetic, static = figure.subplots(1, 2, sharey=True)
        looks = _EACH if len(sides) > 1 else (_BOTH,)
        for friction, look in zip(sides, looks):
            _kinetic(kinetic, friction, look)
            _static(static, friction, look)
        ends = [look.sign * style.MILLI * friction.decelerating.x[-1] for friction, look in zip(sides, looks)]
        kinetic.set_xlim(min(0.0, *ends), max(ends))
        kinetic.set_xlabel(f'velocity / (mm/s){", backwards below 0" if len(sides) > 1 else ""}')
        static.set_xlim(0.0, sides[0].static.x[-1])
        for panel, name in zip((kinetic, static), 'ab'):
            panel.set_ylim(bottom=0.0)
            lines = style.lines_by_label(panel)
            panel.legend(lines.values(), lines)
            style.letter(panel, name)


def _kinetic(panel: Axes, friction: Characteristics, look: _Look) -> None:
    for (label, curve), (colour, dashes) in zip(friction.accelerating.items(), _BRANCHES):
        panel.plot(look.sign * style.MILLI * curve.x, curve.y, color=colour, linestyle=dashes,
                   label=f'accelerating, {label}')
    label = 'decelerating' if friction.accelerating else 'kinetic'
    panel.plot(look.sign * style.MILLI * friction.decelerating.x, friction.decelerating.y, color=style.PURPLE,
               linestyle=(0, (6.0, 1.5, 1.0, 1.5)), label=label)
    beside = 0.0 if look is _BOTH else look.sign * _BESIDE
    place = panel.transData + ScaledTranslation(beside, 0.0, panel.figure.dpi_scale_trans)
    panel.plot([0.0, 0.0], [friction.static.y[0], friction.static_limit or friction.static.y[-1]], color=style.BLUE,
               linewidth=_BAR, solid_capstyle='butt', label='static', clip_on=False, transform=place)
    panel.set_ylabel('coefficient of friction')


def _static(panel: Axes, friction: Characteristics, look: _Look) -> None:
    panel.plot(*friction.static, color=style.BLUE, linestyle=look.dashes, label=f'static{look.name}')
    if friction.static_limit is not None:
        panel.axhline(friction.static_limit, color=style.GREY, linestyle=(0, (4.0, 2.0)), linewidth=0.8,
                      label='upon prolonged rest')
    marks: dict[str, Any] = {'linestyle': '', 'markerfacecolor': look.inside, 'markeredgecolor': style.BLACK,
                             'clip_on': False}
    if len(friction.break_aways.x):
        panel.plot(*friction.break_aways, marker='o', markersize=4.0, label=f'break-aways of the run{look.name}',
                   **marks)
    if friction.has_prolonged_rest and friction.static_limit is not None:
        panel.plot([1.0], [friction.static_limit], marker='>', markersize=5.0, transform=panel.get_yaxis_transform(),
                   label=f'after prolonged rest{look.name}', **marks)
    panel.set(xlabel='rest time / s')


# Identified friction with its band beside what was measured: kinetic over speed, static over the time at rest.

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


_MOST_STICKS = 1.96   # standard deviations: 95 %


class KnownFriction(NamedTuple):
    """Coefficients of friction: identified with bands, those of the start, and measured.

    `accelerating` is the branch of a slip after the rest that is usual in the run; None without one.  `scatter` is the
    relative standard deviation of static friction from stick to stick.
    """

    kinetic: Band
    accelerating: Band | None
    start_kinetic: Scatter
    points: Scatter
    bins: Bins
    static: Band
    start_static: Scatter
    break_aways: Scatter
    scatter: float = 0.0


def plot_known_friction(directions: Mapping[str, KnownFriction], path: Path | str) -> None:
    """Draw kinetic friction over speed and static friction over the time at rest, a row for each direction by name."""
    with style.journal(style.DOUBLE_COLUMN, _HEIGHT + _ROW * (len(directions) - 1), path, pads=(0.06, 0.05)) as figure:
        panels = figure.subplots(len(directions), 2, squeeze=False, sharey=True, width_ratios=(3, 2))
        for (kinetic, static), (name, friction) in zip(panels, directions.items()):
            _kinetic_found(kinetic, friction)
            _static_found(static, friction)
            kinetic.set_title(name, fontsize=8.0, loc='left')
        panels[0, 0].set_ylim(0.0, max(map(_top, directions.values())))
        style.letters(panels.flat)
        style.legend_of(figure, 'upper center', panels[0, 1], panels[0, 0], ncols=4)


def _top(friction: KnownFriction) -> float:
    """Return the coefficient up to which a direction is drawn; lone readings far above are left out."""
    curves = [friction.kinetic, friction.static, *([friction.accelerating] if friction.accelerating else [])]
    highest = max(float((band.values + np.nan_to_num(band.half)).max()) for band in curves)
    starts = friction.start_kinetic.values, friction.start_static.values, friction.break_aways.values
    return _ABOVE * max(highest, *(float(values.max(initial=0.0)) for values in (*starts, friction.bins.high)))


def _kinetic_found(panel: Axes, friction: KnownFriction) -> None:
    step = max(1, len(friction.points.places) // _MOST)
    panel.plot(style.MILLI * friction.points.places[::step], friction.points.values[::step], '.', color=style.GREY,
               markersize=2.0, alpha=0.4, markeredgewidth=0.0)
    _curve(panel, friction.kinetic, style.MILLI, style.BLUE, 'identified, 95 % band')
    if friction.accelerating is not None:
        _curve(panel, friction.accelerating, style.MILLI, style.ORANGE, 'accelerating, after the usual rest')
    panel.plot(style.MILLI * friction.start_kinetic.places, friction.start_kinetic.values, color=style.GREY,
               linewidth=0.9, linestyle=(0, (4.0, 2.0)), label='scene to start with')
    bins = friction.bins
    if len(bins.places):
        panel.errorbar(style.MILLI * bins.places, bins.middles, (bins.middles - bins.low, bins.high - bins.middles),
                       fmt='o', color=style.BLACK, markersize=3.0, markerfacecolor='white', elinewidth=0.7, zorder=4.0,
                       label='measured: median and quartiles')
    panel.set(xlabel='speed / (mm/s)', ylabel='coefficient of friction')
    panel.set_xlim(0.0, style.MILLI * friction.kinetic.places[-1])


def _static_found(panel: Axes, friction: KnownFriction) -> None:
    _curve(panel, friction.static, 1.0, style.BLUE, 'identified, 95 % band')
    panel.plot(friction.start_static.places, friction.start_static.values, color=style.GREY, linewidth=0.9,
               linestyle=(0, (4.0, 2.0)), label='scene to start with')
    if friction.scatter > 0.0:
        law, share = friction.static, _MOST_STICKS * friction.scatter
        panel.fill_between(law.places, (1.0 - share) * law.values, (1.0 + share) * law.values, alpha=0.15,
                           linewidth=0.0, color=style.BLACK)
        panel.text(0.98, 0.02, '95 % of the sticks: grey', transform=panel.transAxes, ha='right', fontsize=6.0)
    panel.plot(friction.break_aways.places, friction.break_aways.values, 'o', color=style.BLACK, markersize=3.0,
               markerfacecolor='white', zorder=4.0, label='measured: median and quartiles')
    panel.set(xlabel='time at rest / s')
    panel.set_title('○ break-aways that were measured' if len(friction.break_aways.places)
                    else 'no break-away force was measured', fontsize=7.0, loc='right')
    panel.set_xlim(0.0, friction.static.places[-1])


def _curve(panel: Axes, band: Band, scale: float, colour: str, label: str) -> None:
    panel.plot(scale * band.places, band.values, color=colour, linewidth=1.4, label=label, zorder=3.0)
    panel.fill_between(scale * band.places, band.values - band.half, band.values + band.half, alpha=0.35, linewidth=0.0,
                       color=style.SKY if colour == style.BLUE else colour)
