# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measured runs for the tests of the identification: scenes through sensors with noise, and the truth."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip
from stickslip_sim.identification.identified import FOUND, Identification
from stickslip_sim.recording import write_measured

MICROMETRE = 1e-6


def between(low: float, high: float) -> dict[str, object]:
    """Return a range, as in a file of free parameters."""
    return {'distribution': 'uniform', 'low': low, 'high': high}


RIGID = stickslip.load_scene('paper_fig7', {'drive.course': 'steps', 'drive.times': (0.0, 2.0, 4.0),
                                            'drive.velocities': (0.003, 0.005, 0.002)})
COMPLIANT = stickslip.load_scene('paper_fig8', {'drive.velocity': 0.003})
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
    write_measured(folder, times[keep], {name: factors.get(name, 1.0) * values[keep]
                                         for name, values in columns.items()}, {})
    return stickslip.read_run(folder)


def truth(scene: stickslip.Scene, name: str) -> float:
    plain, _, index = name.rstrip(']').partition('[')
    value = scene.values[plain]
    if isinstance(value, tuple):
        value = value[int(index)]
    assert isinstance(value, float)
    return value


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
