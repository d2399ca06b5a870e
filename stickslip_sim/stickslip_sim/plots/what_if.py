# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run and its what-if run, one over the other."""

from collections.abc import Mapping
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..core.arrays import Numbers
from .style import BLUE, MILLI, ORANGE, save
from .time_panels import dress, force_unit, head, line


def plot_beside(recorded: Mapping[str, Numbers], other: Mapping[str, Numbers], title: str, path: Path | str) -> None:
    """Draw position, velocity and friction force of both over time into `path` (.png, .pdf or .svg).

    Columns are named as in `types.Sample`, and `time`; the first line of `title` is the heading.
    """
    figure = Figure(figsize=(11.0, 8.0), dpi=150, layout=ConstrainedLayoutEngine(w_pad=0.1, h_pad=0.08))
    panels = figure.subplots(3, 1, sharex=True)
    scale, unit = force_unit(recorded['friction_force'], other['friction_force'])
    for panel, name, factor, label in zip(panels, ('position', 'velocity', 'friction_force'), (MILLI, MILLI, scale),
                                          ('position / mm', 'velocity / (mm/s)', f'friction force / {unit}')):
        line(panel, recorded, name, factor, 'recorded', color=BLUE, linewidth=2.2)
        line(panel, other, name, factor, 'what if', color=ORANGE, linewidth=1.3, linestyle=(0, (4, 1.5)))
        panel.set_ylabel(label)
        dress(panel)
    panels[-1].set_xlabel('time / s')
    figure.align_ylabels(panels)
    head(panels[0], title)
    save(figure, path)
