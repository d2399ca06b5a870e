# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction characteristics as in Fig. 6 of the paper: kinetic over velocity, static over rest time."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from .style import BLACK, BLUE, DOUBLE_COLUMN, GREY, JOURNAL, MILLI, ORANGE, PURPLE, RED, Numbers, letter, save

_BRANCHES = ((ORANGE, 'solid'), (RED, (0, (5.0, 1.5))))


class Curve(NamedTuple):
    """Points of a line."""

    x: Numbers
    y: Numbers


class Characteristics(NamedTuple):
    """The friction of an axis and where a run touched it; velocities in m/s, times in s, coefficients without unit."""

    decelerating: Curve
    accelerating: Mapping[str, Curve]   # by the name of the branch
    static: Curve
    static_limit: float | None          # upon prolonged rest
    break_aways: Curve                  # rest time (finite) and coefficient of those of the run
    has_prolonged_rest: bool            # whether one followed an infinite rest


def plot_characteristics(friction: Characteristics, *paths: Path | str) -> None:
    """Draw both characteristics side by side."""
    with rc_context(JOURNAL):
        figure = Figure(figsize=(DOUBLE_COLUMN, 2.7), layout=ConstrainedLayoutEngine(w_pad=0.06, h_pad=0.06))
        kinetic, static = figure.subplots(1, 2, sharey=True)
        _kinetic(kinetic, friction)
        _static(static, friction)
        for panel, name in zip((kinetic, static), 'ab'):
            panel.set_ylim(bottom=0.0)
            panel.legend()
            letter(panel, name)
        save(figure, *paths)


def _kinetic(panel: Axes, friction: Characteristics) -> None:
    for (label, curve), (colour, style) in zip(friction.accelerating.items(), _BRANCHES):
        panel.plot(curve.x * MILLI, curve.y, color=colour, linestyle=style, label=f'accelerating, {label}')
    label = 'decelerating' if friction.accelerating else 'kinetic'
    panel.plot(friction.decelerating.x * MILLI, friction.decelerating.y, color=PURPLE,
               linestyle=(0, (6.0, 1.5, 1.0, 1.5)), label=label)
    panel.plot([0.0, 0.0], [friction.static.y[0], friction.static_limit or friction.static.y[-1]], color=BLUE,
               linewidth=2.5, solid_capstyle='butt', label='static', clip_on=False)
    panel.set(xlabel='velocity / (mm/s)', ylabel='coefficient of friction')
    panel.set_xlim(0.0, friction.decelerating.x[-1] * MILLI)


def _static(panel: Axes, friction: Characteristics) -> None:
    end = friction.static.x[-1]
    panel.plot(*friction.static, color=BLUE, label='static')
    if friction.static_limit is not None:
        panel.axhline(friction.static_limit, color=GREY, linestyle=(0, (4.0, 2.0)), linewidth=0.8,
                      label='upon prolonged rest')
    look: dict[str, Any] = {'linestyle': '', 'markerfacecolor': 'white', 'markeredgecolor': BLACK, 'clip_on': False}
    if len(friction.break_aways.x):
        panel.plot(*friction.break_aways, marker='o', markersize=4.0, label='break-aways of the run', **look)
    if friction.has_prolonged_rest and friction.static_limit is not None:
        panel.plot([end], [friction.static_limit], marker='>', markersize=5.0, label='after prolonged rest', **look)
    panel.set(xlabel='rest time / s')
    panel.set_xlim(0.0, end)
