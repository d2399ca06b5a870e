# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction characteristics as in Fig. 6 of the paper: kinetic over velocity, static over rest time."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.transforms import ScaledTranslation

from ..core.arrays import Numbers
from .style import (
    BLACK,
    BLUE,
    DOUBLE_COLUMN,
    GREY,
    JOURNAL,
    MILLI,
    ORANGE,
    PURPLE,
    RED,
    letter,
    lines_by_label,
    save,
)

_BRANCHES = ((ORANGE, 'solid'), (RED, (0, (5.0, 1.5))))


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
_EACH = _Look(1.0, ', forwards', 'solid', BLACK), _Look(-1.0, ', backwards', (0, (5.0, 1.5)), 'white')
_BAR = 2.5                # points: the width of the bar of static friction
_BESIDE = _BAR / 2 / 72   # in


def plot_characteristics(sides: Sequence[Characteristics], *paths: Path | str) -> None:
    """Draw kinetic and static friction beside each other: of both directions, or forwards and backwards."""
    with rc_context(JOURNAL):
        figure = Figure(figsize=(DOUBLE_COLUMN, 2.7), layout=ConstrainedLayoutEngine(w_pad=0.06, h_pad=0.06))
        kinetic, static = figure.subplots(1, 2, sharey=True)
        looks = _EACH if len(sides) > 1 else (_BOTH,)
        for friction, look in zip(sides, looks):
            _kinetic(kinetic, friction, look)
            _static(static, friction, look)
        ends = [look.sign * MILLI * friction.decelerating.x[-1] for friction, look in zip(sides, looks)]
        kinetic.set_xlim(min(0.0, *ends), max(ends))
        kinetic.set_xlabel(f'velocity / (mm/s){", backwards below 0" if len(sides) > 1 else ""}')
        static.set_xlim(0.0, sides[0].static.x[-1])
        for panel, name in zip((kinetic, static), 'ab'):
            panel.set_ylim(bottom=0.0)
            lines = lines_by_label(panel)
            panel.legend(lines.values(), lines)
            letter(panel, name)
        save(figure, *paths)


def _kinetic(panel: Axes, friction: Characteristics, look: _Look) -> None:
    for (label, curve), (colour, style) in zip(friction.accelerating.items(), _BRANCHES):
        panel.plot(look.sign * MILLI * curve.x, curve.y, color=colour, linestyle=style, label=f'accelerating, {label}')
    label = 'decelerating' if friction.accelerating else 'kinetic'
    panel.plot(look.sign * MILLI * friction.decelerating.x, friction.decelerating.y, color=PURPLE,
               linestyle=(0, (6.0, 1.5, 1.0, 1.5)), label=label)
    beside = 0.0 if look is _BOTH else look.sign * _BESIDE
    place = panel.transData + ScaledTranslation(beside, 0.0, panel.figure.dpi_scale_trans)
    panel.plot([0.0, 0.0], [friction.static.y[0], friction.static_limit or friction.static.y[-1]], color=BLUE,
               linewidth=_BAR, solid_capstyle='butt', label='static', clip_on=False, transform=place)
    panel.set_ylabel('coefficient of friction')


def _static(panel: Axes, friction: Characteristics, look: _Look) -> None:
    panel.plot(*friction.static, color=BLUE, linestyle=look.dashes, label=f'static{look.name}')
    if friction.static_limit is not None:
        panel.axhline(friction.static_limit, color=GREY, linestyle=(0, (4.0, 2.0)), linewidth=0.8,
                      label='upon prolonged rest')
    marks: dict[str, Any] = {'linestyle': '', 'markerfacecolor': look.inside, 'markeredgecolor': BLACK,
                             'clip_on': False}
    if len(friction.break_aways.x):
        panel.plot(*friction.break_aways, marker='o', markersize=4.0, label=f'break-aways of the run{look.name}',
                   **marks)
    if friction.has_prolonged_rest and friction.static_limit is not None:
        panel.plot([1.0], [friction.static_limit], marker='>', markersize=5.0, transform=panel.get_yaxis_transform(),
                   label=f'after prolonged rest{look.name}', **marks)
    panel.set(xlabel='rest time / s')
