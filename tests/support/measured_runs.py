# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measured runs for the tests of the identification: scenes through sensors with noise, and the truth."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.core.arrays import Numbers
from stickslip_sim.identification import stages
from stickslip_sim.identification.identified import FOUND, Estimate, Identification
from stickslip_sim.recording import read_run, write_measured
from stickslip_sim.recording.measured_run import MeasuredRun
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene, scene_from_values

MICROMETRE = 1e-6


def as_run(folder: Path, times: Numbers, columns: Mapping[str, Numbers]) -> MeasuredRun:
    """Return columns over times (s), SI, as the run that an import makes of them, in a new folder."""
    write_measured(folder, times, columns, {'file': f'{folder.name}.csv'})
    run = read_run(folder)
    assert isinstance(run, MeasuredRun)
    return run


@contextmanager
def few_starts(count: int = 1) -> Iterator[None]:
    """Where no start fits, a few of them, and of few trial points, say as much as ten of 256."""
    with pytest.MonkeyPatch.context() as patch:
        for name, value in {'N_STARTS': count, 'N_WHOLE': 1, 'N_TRIALS': 32}.items():
            patch.setattr(stages, name, value)
        yield


def between(low: float, high: float) -> dict[str, object]:
    """Return a range, as in a file of free parameters."""
    return {'distribution': 'uniform', 'low': low, 'high': high}


RIGID = stickslip.load_scene('paper_fig7', {'drive.course': 'steps', 'drive.times': (0.0, 2.0, 4.0),
                                            'drive.velocities': (0.003, 0.005, 0.002)})
COMPLIANT = stickslip.load_scene('paper_fig8', {'drive.velocity': 0.003})
MOTOR = stickslip.load_scene('paper_fig7', {   # its force drives the slider without a spring
    'axis.drive_stiffness': 0.0, 'axis.drive_damping': 0.0, 'axis.mass': 95.0, 'axis.normal_force': 100.0,
    'friction.static.law': 'constant', 'friction.static.initial': 0.2, 'friction.acceleration_dependence': False,
    'friction.kinetic.velocities': (0.0,), 'friction.kinetic.coefficients': (0.2,), 'friction.kinetic.end_slope': 2.0,
    'drive.velocity': 0.0, 'force.course': 'sine', 'force.amplitude': 60.0, 'force.frequency': 1.0})
OF_FRICTION = {'friction.static.limit': between(0.1, 0.5), 'friction.static.time_constant': between(0.05, 0.6),
               'friction.kinetic.coefficients[1]': between(0.01, 0.11)}
OF_DRIVE = {'axis.mass': between(150.0, 900.0), 'axis.drive_stiffness': between(2.5e5, 1.5e6),
            'axis.drive_damping': between(1000.0, 9000.0)}
OFF = {'friction.static.limit': 0.3, 'friction.static.time_constant': 0.13,
       'friction.kinetic.coefficients': (0.12, 0.065)}
DRIVE_OFF = {'axis.mass': 450.0, 'axis.drive_stiffness': 4.4e5, 'axis.drive_damping': 5400.0}


def measure(folder: Path, scene: stickslip.Scene, duration: float, *, force: bool = True, rate: float = 1e3,
            begin: float = 0.0, gap: tuple[float, float] = (0.0, 0.0), change: Mapping[str, float] | None = None
            ) -> stickslip.Run:
    """Return a measured run: positions in micrometres, forces with 1 % noise, nothing in a gap (s).

    `change` are factors on columns, as of a wrong unit.
    """
    samples = stickslip.simulate(scene, duration, 1.0 / rate).samples
    random = np.random.default_rng(1)
    columns = {'position': np.round(samples['position'] / MICROMETRE) * MICROMETRE}
    if force:
        drive_force = samples['drive_force']
        columns['drive_force'] = drive_force + random.normal(0.0, 0.01 * np.abs(drive_force).max(), len(drive_force))
    times = samples['time']
    keep = (times >= begin) & ~((times > gap[0]) & (times < gap[1]))
    factors = change or {}
    return as_run(folder, times[keep], {name: factors.get(name, 1.0) * values[keep]
                                        for name, values in columns.items()})


def truth(scene: stickslip.Scene, name: str) -> float:
    plain, _, index = name.rstrip(']').partition('[')
    value = scene.values[plain]
    if isinstance(value, tuple):
        value = value[int(index)]
    assert isinstance(value, float)
    return value


def estimate_of(found: Identification, name: str) -> Estimate:
    return next(one for one in found.estimates if one.name == name)


def check(found: Identification, scene: stickslip.Scene, within: float) -> None:
    """Assert that all was found, near the truth, and within a little more than its interval."""
    assert found.fits, found.misfits
    for estimate in found.estimates:
        right = truth(scene, estimate.name)
        low, high = estimate.best_interval
        assert estimate.kind == FOUND, estimate
        assert abs(estimate.value / right - 1.0) < within, estimate
        assert low - (high - low) <= right <= high + (high - low), estimate
        assert truth(found.scene, estimate.name) == pytest.approx(estimate.value, rel=1e-12)


# An axis as it is measured: an encoder of 1 µm and a force with noise, as a file for `stickslip import`, as a run.

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
        return as_run(folder, self.times, self.columns)


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
