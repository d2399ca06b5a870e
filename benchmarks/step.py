# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure what a step of the rig costs, with and without new commands, against a bare advance of the simulator.

    python3 benchmarks/step.py [--scene paper_fig8] [--rounds 15]

Processor time in one process, in turns; medians, and how many bare advances they are.  0.1.0, in turns with this
version on one machine: an advance 1.9 of today's, a step 1.8, a step with a new drive velocity 2.5.
"""

import argparse
import gc
import statistics
import time
from collections.abc import Callable

from stickslip_sim.core.time_grid import Grid
from stickslip_sim.inputs import load_scene
from stickslip_sim.scene import Scene

STEPS = 5000
FIRST, RISE = 0.002, 1e-9    # of the commands: m/s and N, each step another


def costs_of(scene: Scene) -> dict[str, Callable[[], float]]:
    """Return what measures each kind of step, s."""
    rig, grid = scene.make_rig(), Grid(scene.time.rate)
    instants = [grid.instant(step) for step in range(STEPS)]
    commands = [FIRST + RISE * step for step in range(STEPS)]

    def advance() -> float:
        rig.reset()
        bare = rig.simulator.advance
        begin = time.process_time()
        for instant in instants:
            bare(instant)
        return (time.process_time() - begin) / STEPS

    def step() -> float:
        rig.reset()
        begin = time.process_time()
        for _ in instants:
            rig.make_step()
        return (time.process_time() - begin) / STEPS

    def velocity() -> float:
        rig.reset()
        begin = time.process_time()
        for command in commands:
            rig.make_step(command)
        return (time.process_time() - begin) / STEPS

    def both() -> float:
        rig.reset()
        begin = time.process_time()
        for command in commands:
            rig.make_step(command, command)
        return (time.process_time() - begin) / STEPS

    return {'bare advance': advance, 'step': step, 'step with a new drive velocity': velocity,
            'step with a new drive velocity and force': both}


def main() -> None:
    """Measure in turns and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--scene', default='paper_fig8')
    parser.add_argument('--rounds', type=int, default=15)
    options = parser.parse_args()
    measures = costs_of(load_scene(options.scene))
    for measure in measures.values():    # the first call loads
        measure()
    gc.collect()
    gc.freeze()
    rounds = [[measure() for measure in measures.values()] for _ in range(options.rounds)]
    medians = [statistics.median(costs) for costs in zip(*rounds)]
    for name, cost in zip(measures, medians):
        print(f'{name:42} {cost * 1e6:6.2f} µs {cost / medians[0]:6.2f}')


if __name__ == '__main__':
    main()
