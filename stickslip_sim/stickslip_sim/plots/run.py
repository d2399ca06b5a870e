# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run over time: position, velocity, forces and mode."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import AutoMinorLocator

from ..core.types import Event, EventKind, Mode
from ..simulation.cycles import mode_spans
from .style import BLACK, BLUE, GREEN, GREY, MILLI, MODE_COLOURS, RED, Numbers, save, thinned

_CROWD = 50          # break-aways that are marked smaller
KILO_FROM = 1e4     # N: larger forces are shown in kN


def plot_run(samples: Mapping[str, Numbers], events: Sequence[Event], title: str, path: Path | str) -> None:
    """Draw position, velocity, forces and mode over time into `path` (.png or .svg).

    `samples` are columns named as in `types.Sample`, and `time`; the first line of `title` is the heading.
    """
    layout = ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.08)
    figure = Figure(figsize=(11.0, 8.5), dpi=150, layout=layout)
    panels = figure.subplots(4, 1, sharex=True, height_ratios=(3, 3, 3, 1.5))
    _position(panels[0], samples)
    _velocity(panels[1], samples)
    _forces(panels[2], samples, events)
    _modes(panels[3], samples, events)
    for panel in panels:
        dress(panel)
    panels[-1].grid(visible=False, axis='y')
    panels[-1].set_xlabel('time / s')
    if len(samples['time']) > 1:
        panels[-1].set_xlim(samples['time'][0], samples['time'][-1])
    figure.align_ylabels(panels[:3])
    head(panels[0], title)
    save(figure, path)


def _position(panel: Axes, samples: Mapping[str, Numbers]) -> None:
    line(panel, samples, 'drive_position', MILLI, 'drive', color=GREY, linewidth=1.0, linestyle=(0, (5, 2)))
    line(panel, samples, 'position', MILLI, 'slider', color=BLUE, linewidth=1.6)
    panel.set_ylabel('position / mm')


def _velocity(panel: Axes, samples: Mapping[str, Numbers]) -> None:
    line(panel, samples, 'velocity', MILLI, 'slider', color=BLUE, linewidth=1.4)
    line(panel, samples, 'drive_velocity', MILLI, 'drive', color=GREY, linewidth=1.0, linestyle=(0, (5, 2)))
    panel.set_ylabel('velocity / (mm/s)')


def _forces(panel: Axes, samples: Mapping[str, Numbers], events: Sequence[Event]) -> None:
    names = ['drive_force', 'friction_force', 'external_force']
    largest = max(np.abs(samples[name]).max() for name in names)
    scale, unit = (1e-3, 'kN') if largest >= KILO_FROM else (1.0, 'N')
    if np.any(samples['external_force'] != 0.0):
        line(panel, samples, 'external_force', scale, 'external', color=GREEN, linewidth=1.1)
    line(panel, samples, 'friction_force', scale, 'friction', color=RED, linewidth=2.2)
    line(panel, samples, 'drive_force', scale, 'drive', color=BLACK, linewidth=1.1)
    marks = [event for event in events if event.kind == EventKind.BREAKAWAY]
    if marks:
        panel.plot([event.time for event in marks], [event.friction_force * scale for event in marks], 'o',
                   markersize=4.5 if len(marks) < _CROWD else 2.5, markerfacecolor='white', markeredgecolor=RED,
                   label='static limit at break-away')
    panel.set_ylabel(f'force / {unit}')


def _modes(panel: Axes, samples: Mapping[str, Numbers], events: Sequence[Event]) -> None:
    """Draw one lane for each mode."""
    begin, end = float(samples['time'][0]), float(samples['time'][-1])
    spans = mode_spans(events, begin, end, Mode(int(samples['mode'][0])))
    for lane, (mode, colour) in enumerate(MODE_COLOURS.items()):
        bars = [(span.begin, span.end - span.begin) for span in spans if span.mode == mode]
        panel.broken_barh(bars, (lane - 0.4, 0.8), facecolors=colour, edgecolors=colour, linewidth=0.3, snap=False)
    panel.set_yticks(range(len(MODE_COLOURS)), [mode.name for mode in MODE_COLOURS], fontsize=8)
    panel.set_ylim(len(MODE_COLOURS) - 0.4, -0.6)
    panel.tick_params(axis='y', length=0)


def line(panel: Axes, samples: Mapping[str, Numbers], name: str, scale: float, label: str, **look: Any) -> None:
    """Draw a column over time."""
    time, values = thinned(samples['time'], samples[name])
    panel.plot(time, values * scale, label=label, **look)


def dress(panel: Axes) -> None:
    """Give a panel over time its grid, ticks and legend."""
    panel.spines[['top', 'right']].set_visible(False)
    panel.grid(axis='both', color='#dddddd', linewidth=0.6)
    panel.set_axisbelow(True)
    panel.xaxis.set_minor_locator(AutoMinorLocator())
    panel.margins(x=0.0)
    if panel.get_legend_handles_labels()[0]:
        panel.legend(loc='lower right', bbox_to_anchor=(1.0, 0.98), ncols=4, frameon=False, fontsize=9,
                     borderaxespad=0.0, handlelength=2.2)


def head(first: Axes, title: str) -> None:
    """Write a title above the first panel; its first line is the heading."""
    heading, _, rest = title.partition('\n')
    first.set_title(heading, loc='left', fontsize=14, fontweight='bold', pad=42 if rest else 22)
    first.annotate(rest, (0.0, 1.0), xytext=(0.0, 25.0), xycoords='axes fraction', textcoords='offset points',
                   fontsize=10, color=GREY, in_layout=False)
