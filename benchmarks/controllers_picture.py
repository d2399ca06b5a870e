# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/controllers.md: speed, error and spring force, a column for each controller."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip_sim.axis import Axis
from stickslip_sim.core.types import Mode
from stickslip_sim.figures.cycles import mode_spans

from .closed_loop import Run

# Okabe and Ito's colours, which stay apart for colour-blind eyes
_BLUE, _RED, _SKY, _GREY, _BLACK = '#0072B2', '#D55E00', '#56B4E9', '#777777', '#222222'


def draw(runs: Mapping[str, Run], axis: Axis, path: Path) -> None:
    """Draw runs of one period of the same moves on an axis into `path`."""
    figure = Figure(figsize=(11.0, 7.6), dpi=130, layout='constrained')
    grid = figure.subplots(3, len(runs), sharex=True, sharey='row', squeeze=False)
    for column, (name, run) in zip(grid.T, runs.items()):
        _speed(column[0], run)
        _error(column[1], run)
        _force(column[2], run, axis)
        column[0].set_title(name, loc='left', fontsize=12, fontweight='bold')
        column[2].set_xlabel('time / s')
        for panel in column:
            _dress(panel, run)
    for panel, label in zip(grid[:, 0], ('speed / (mm/s)', 'following error / µm', 'force / N')):
        panel.set_ylabel(label)
    for panel, corner in zip(grid[::2, -1], ('lower left', 'upper right')):
        panel.legend(loc=corner, fontsize=9, framealpha=0.9)
    figure.savefig(path)


def _times(run: Run) -> list[float]:
    return [sample.time for sample in run.samples]


def _speed(panel: Axes, run: Run) -> None:
    panel.plot(_times(run), [1e3 * sample.velocity for sample in run.samples], color=_BLUE, linewidth=0.9,
               label='slider')
    panel.plot(_times(run), [1e3 * setpoint.velocity for setpoint in run.setpoints], color=_BLACK, linewidth=1.0,
               linestyle=(0, (5, 2)), label='wanted')


def _error(panel: Axes, run: Run) -> None:
    errors = [1e6 * (setpoint.position - sample.position) for setpoint, sample in zip(run.setpoints, run.samples)]
    panel.plot(_times(run), errors, color=_RED, linewidth=1.0)


def _force(panel: Axes, run: Run, axis: Axis) -> None:
    forces = [sample.drive_force for sample in run.samples]
    panel.plot(_times(run), forces, color=_BLUE, linewidth=0.9, label='drive spring and damper')
    at_rest = axis.normal_force * axis.friction.kinetic.coefficient(0.0)
    for sign in (1.0, -1.0):
        panel.axhline(sign * at_rest, color=_GREY, linewidth=0.9, linestyle=':',
                      label='N mu_k at rest' if sign > 0.0 else None)
    panel.set_ylim(-1.25 * np.max(np.abs(forces)), 1.25 * np.max(np.abs(forces)))


def _dress(panel: Axes, run: Run) -> None:
    end = run.samples[-1].time
    spans = [span for span in mode_spans(run.events, 0.0, end, Mode.STICK) if span.mode == Mode.STICK]
    low, high = panel.get_ylim()
    panel.broken_barh([(span.begin, span.end - span.begin) for span in spans], (low, high - low), facecolors=_SKY,
                      alpha=0.22, linewidth=0.0, label='stick', zorder=0)
    panel.set_ylim(low, high)
    panel.set_xlim(0.0, end)
    panel.spines[['top', 'right']].set_visible(False)
    panel.grid(color='#dddddd', linewidth=0.6)
    panel.set_axisbelow(True)
