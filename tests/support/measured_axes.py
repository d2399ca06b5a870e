# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An axis as it is measured: an encoder of 1 µm and a force with noise, as a file for `stickslip import`, as a run."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.recording import read_run, write_measured
from stickslip_sim.recording.measured_run import MeasuredRun
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene, scene_from_values

RATE, DURATION = 500.0, 4.0    # Hz, s
ENCODER, FORCE_NOISE = 1e-6, 1.0   # m, N
VALUES: Mapping[str, object] = {
    'scene': 'measured_axis', 'axis.mass': 100.0, 'axis.drive_stiffness': 2.0e5, 'axis.drive_damping': 800.0,
    'axis.normal_force': 981.0, 'friction.static.initial': 0.2, 'friction.kinetic.velocities': (0.0, 0.02),
    'friction.kinetic.coefficients': (0.12, 0.08), 'drive.velocity': 0.002,
}
START: Mapping[str, object] = {**VALUES, 'axis.drive_stiffness': 1.6e5, 'friction.static.initial': 0.23,
                               'friction.kinetic.coefficients': (0.14, 0.08)}
FREE = {'axis.drive_stiffness': (1e5, 4e5), 'friction.static.initial': (0.15, 0.3),
        'friction.kinetic.coefficients[0]': (0.08, 0.15)}


class Readings(NamedTuple):
    """Columns over times (s), SI, by the names of `stickslip import`."""

    times: Numbers
    columns: dict[str, Numbers]

    def as_run(self, folder: Path) -> MeasuredRun:
        """Return them as a run in a new folder."""
        write_measured(folder, self.times, self.columns, {'file': f'{folder.name}.csv'})
        run = read_run(folder)
        assert isinstance(run, MeasuredRun)
        return run


def readings(values: Mapping[str, object] = VALUES, duration: float = DURATION, rate: float = RATE, seed: int = 0
             ) -> Readings:
    """Return what sensors show of the motion of a scene."""
    samples = simulate(scene_from_values(values), duration, 1.0 / rate).samples
    noise = FORCE_NOISE * np.random.default_rng(seed).standard_normal(len(samples['time']))
    return Readings(samples['time'], {'position': ENCODER * np.round(samples['position'] / ENCODER),
                                      'drive_force': samples['drive_force'] + noise})


def start_scene() -> Scene:
    """Return what a user would begin with."""
    return scene_from_values(START)


def free_file(path: Path, free: Mapping[str, tuple[float, float]] = FREE) -> Path:
    """Write the file of what is sought; return its path."""
    lines = [f'  {name}: {{distribution: uniform, low: {low!r}, high: {high!r}}}' for name, (low, high) in free.items()]
    path.write_text('\n'.join(['parameters:', *lines, '']), encoding='utf-8')
    return path
