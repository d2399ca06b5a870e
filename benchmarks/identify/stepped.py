# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Plain least squares on a stepped simulation: the same scene, the same laws, semi-implicit Euler at 0.1 ms.

What one would write in an afternoon: simulate the whole run, subtract, and let `scipy.optimize.least_squares` go from
the start within the ranges, with all its defaults, so that its differences take steps of 1.5e-8.
"""

import time
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.core.errors import StickslipError
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene
from stickslip_sim.scene.load import changed
from stickslip_sim.study.points import scene_at

from .axes import RANGE, SyntheticAxis, value_of
from .measuring import Measurement

STEP = 1e-4         # s
_REFUSED = 10.0     # times the residuals of the start: where the values make no scene


class RivalFit(NamedTuple):
    """What a rival found: values by the names of parameters, how many simulations it took, and s of processor time."""

    values: dict[str, float]
    runs: int
    seconds: float


class SteppedResiduals:
    """Residuals of the whole run, in standard deviations of the sensors, over shares of the start."""

    def __init__(self, axis: SyntheticAxis, measured: Measurement, step: float = STEP) -> None:
        self.runs = 0
        self._names = axis.free
        self._base: Scene = changed(axis.start, {'solver.name': 'fixed_step', 'solver.step': step})
        self._start = np.array([value_of(axis.start, name) for name in axis.free])
        self._measured = measured
        self._worst = _REFUSED * np.abs(self(np.ones(len(axis.free))))

    def values(self, shares: Numbers) -> dict[str, float]:
        """Return the parameters."""
        return dict(zip(self._names, (self._start * shares).tolist(), strict=True))

    def __call__(self, shares: Numbers) -> Numbers:
        """Return the residuals (2 n,) of shares (k,) of the start."""
        self.runs += 1
        times, columns = self._measured.times, self._measured.columns
        try:
            scene = scene_at(self._base.values, self._names, self._start * shares)
            samples = simulate(scene, float(times[-1]), float(times[1] - times[0])).samples
        except StickslipError:
            return self._worst
        return np.concatenate([(columns[name] - samples[name]) / noise
                               for name, noise in self._measured.noise.items()])


def fit_stepped(axis: SyntheticAxis, measured: Measurement) -> RivalFit:
    """Return what scipy's least squares finds with its default steps."""
    begin = time.process_time()
    residuals = SteppedResiduals(axis, measured)
    found = least_squares(residuals, np.ones(len(axis.free)), bounds=RANGE)
    return RivalFit(residuals.values(found.x), residuals.runs, time.process_time() - begin)
