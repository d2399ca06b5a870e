# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What sensors show of a motion: an encoder of some resolution, and a force with noise."""

import csv
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.random import Generator

from stickslip_sim.core.arrays import Columns, Numbers
from stickslip_sim.identification.readings import drives_directly
from stickslip_sim.recording import read_run, write_measured
from stickslip_sim.recording.measured_run import MeasuredRun
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene


class Sensors(NamedTuple):
    """How an axis is measured: samples a second, resolution of the encoder (m, 0: it does not count), and noise.

    `force_noise` is a standard deviation, as a share of the root mean square of the force, `noise` that of the position
    (m).  Not every axis `has_force`, a sensor of it.
    """

    rate: float = 1000.0
    resolution: float = 1e-6
    force_noise: float = 0.01
    noise: float = 0.0
    has_force: bool = True


USUAL = Sensors()
OTHERS = {'without noise': Sensors(resolution=0.0, force_noise=0.0),
          '1 µm of noise': Sensors(resolution=0.0, noise=1e-6)}


class Measurement(NamedTuple):
    """Columns over `times` (s, rising), in SI, by the names of `stickslip import`; `noise` is what is on each.

    `noise`: the standard deviation of the error of each column, in its unit.
    """

    times: Numbers
    columns: dict[str, Numbers]
    noise: dict[str, float]

    def as_run(self, folder: Path) -> MeasuredRun:
        """Return it as the run that an import makes of it, in a new folder."""
        write_measured(folder, self.times, self.columns, {'file': folder.name})
        run = read_run(folder)
        assert isinstance(run, MeasuredRun)
        return run

    def write_csv(self, path: Path) -> None:
        """Write it as a file for `stickslip import`."""
        with path.open('w', encoding='utf-8', newline='') as file:
            rows = csv.writer(file)
            rows.writerow(['time', *self.columns])
            rows.writerows(zip(*(column.tolist() for column in (self.times, *self.columns.values()))))


def measure(scene: Scene, duration: float, rng: Generator, sensors: Sensors = USUAL) -> Measurement:
    """Return what sensors show of a scene's motion; without a spring the drive is a motor, whose force is shown."""
    samples = simulate(scene, duration, 1.0 / sensors.rate).samples
    if drives_directly(scene):
        samples = {**samples, 'drive_force': samples['external_force']}
    return shown(samples, rng, sensors)


def shown(samples: Columns, rng: Generator, sensors: Sensors = USUAL) -> Measurement:
    """Return what sensors show of the slider's position and the drive's force, of true samples at their rate."""
    force = samples['drive_force']
    noise = sensors.force_noise * float(np.sqrt(np.mean(force**2)))
    shown_force = force + noise * rng.standard_normal(len(force))
    position = samples['position'] + (sensors.noise * rng.standard_normal(len(force)) if sensors.noise else 0.0)
    if sensors.resolution:
        position = np.round(position / sensors.resolution) * sensors.resolution
    of_position = float(np.hypot(sensors.resolution / 12.0**0.5, sensors.noise))
    columns, errors = {'position': position}, {'position': of_position}
    if sensors.has_force:
        columns['drive_force'], errors['drive_force'] = shown_force, noise
    return Measurement(samples['time'], columns, errors)
