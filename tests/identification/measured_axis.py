# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measured runs for the tests of the identification: a scene through sensors that count and make noise."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

import stickslip_sim as stickslip
from stickslip_sim.recording import write_measured

MICROMETRE = 1e-6


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


def between(low: float, high: float) -> dict[str, object]:
    """Return a range, as in a file of free parameters."""
    return {'distribution': 'uniform', 'low': low, 'high': high}
