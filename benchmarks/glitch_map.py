# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Map the quadrant glitch of two equal axes over radius, feed and compensation: `python3 -m benchmarks.glitch_map`.

10,092 circles on the axis of `ball_screw`.  Both axes are one run: y goes where x was a quarter of a turn before.  A
compensation moves the drive further by some micrometres behind each reversal, within 20 ms.
"""

import itertools
import math
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.input_profile import InputProfile, Sinusoid, constant
from stickslip_sim.core.time_grid import Instants
from stickslip_sim.core.types import Sample
from stickslip_sim.figures.circular import GLITCH_ARC, arc_glitch
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots.style import save
from stickslip_sim.simulation.simulator import Simulator

PICTURE = Path('docs/images/glitch_map.png')
RADII, FEEDS = np.geomspace(0.005, 0.15, 58), np.geomspace(0.1 / 60.0, 10.0 / 60.0, 58)   # m, m/s
COMPENSATIONS = 0.0, 0.7e-6, 1.4e-6    # m
PULSE = 0.02                           # s
SAMPLES = 120                          # on the arc behind a reversal
_POSITION = Sample._fields.index('position')


class CircleAt(NamedTuple):
    """A circle of the map."""

    radius: float         # m
    feed: float           # m/s
    compensation: float   # m


def drive_of(circle: CircleAt) -> InputProfile:
    """Return the drive velocity of x = R cos ωt - R with its compensation."""
    rate = circle.feed / circle.radius
    turn = 2.0 * math.pi / rate
    width = min(PULSE, 0.1 * turn)
    push = circle.compensation / width
    return InputProfile((0.0, width, 0.5 * turn, 0.5 * turn + width), (-push, 0.0, push, 0.0), (0.0,) * 4, turn,
                        (Sinusoid(circle.feed, 1.0 / turn, math.pi),))


def glitch(simulator: Simulator, circle: CircleAt) -> float:
    """Return the glitch at +x at the end of the first turn, m."""
    turn = 2.0 * math.pi * circle.radius / circle.feed
    simulator.reset()
    simulator.command_drive(drive_of(circle))
    arc = np.linspace(0.0, 1.1 * GLITCH_ARC / (2.0 * math.pi), SAMPLES)**1.5 / math.sqrt(
        1.1 * GLITCH_ARC / (2.0 * math.pi))      # of a turn; denser where the glitch is
    y, x = (_positions(simulator, np.asarray((begin + arc) * turn)) for begin in (0.75, 1.0))
    angle = np.arctan2(y + circle.radius, x + circle.radius)
    return arc_glitch(angle, np.hypot(x + circle.radius, y + circle.radius) - circle.radius, 0.0)


def _positions(simulator: Simulator, times: Numbers) -> Numbers:
    seconds = np.floor(times)
    rows = np.empty((len(times), len(Sample._fields)))
    simulator.take_samples(Instants(seconds, times - seconds), rows, with_events=False)
    return rows[:, _POSITION]


def glitches(circles: list[CircleAt]) -> list[float]:
    """Return the glitch of each circle, m."""
    scene = load_scene('ball_screw')
    simulator = Simulator(scene.axis, scene.initial, drive_of(circles[0]), constant(0.0))
    return [glitch(simulator, circle) for circle in circles]


def main(arguments: list[str]) -> None:
    """Compute the map, say what it cost, draw it."""
    circles = [CircleAt(*map(float, one)) for one in itertools.product(RADII, FEEDS, COMPENSATIONS)]
    workers = int(arguments[0]) if arguments else os.cpu_count() or 1
    with ProcessPoolExecutor(workers) as pool:
        list(pool.map(glitches, [circles[:1]] * workers))   # they have imported all
        begin = time.perf_counter()
        parts = [circles[first:first + 300] for first in range(0, len(circles), 300)]
        found = [value for part in pool.map(glitches, parts) for value in part]
        spent = time.perf_counter() - begin
    table = np.reshape(found, (len(RADII), len(FEEDS), len(COMPENSATIONS)))
    print(f'{len(circles)} circles in {spent:.1f} s with {workers} processes')
    for number, compensation in enumerate(COMPENSATIONS):
        values = 1e6 * table[:, :, number]
        print(f'compensation {1e6 * compensation:.1f} µm: glitch {values.min():+.2f} to {values.max():+.2f} µm, '
              f'median {np.median(values):+.2f} µm')
    draw(table)


def draw(table: Numbers) -> None:
    """Draw a panel for each compensation."""
    figure = Figure(figsize=(11.0, 4.0), dpi=130, layout='constrained')
    panels = figure.subplots(1, len(COMPENSATIONS), sharey=True)
    limit = 1e6 * float(np.abs(table).max())
    for number, (panel, compensation) in enumerate(zip(panels, COMPENSATIONS)):
        mesh = panel.pcolormesh(60.0 * FEEDS, 1e3 * RADII, 1e6 * table[:, :, number], cmap='RdBu_r', vmin=-limit,
                                vmax=limit, shading='gouraud')
        panel.set(xscale='log', yscale='log', xlabel='feed / (m/min)')
        panel.set_title(f'compensation {1e6 * compensation:.1f} µm', fontsize=10)
    panels[0].set_ylabel('radius / mm')
    figure.colorbar(mesh, ax=panels, label='quadrant glitch / µm')
    save(figure, PICTURE)


if __name__ == '__main__':
    main(sys.argv[1:])
