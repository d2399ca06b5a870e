# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An axis that is not ours: LuGre friction, whose bristles bend before the slider slides, integrated by SciPy.

    m x'' = c (s - x) + h (v - x') - F      F = sigma_0 z + sigma_1 z' + sigma_2 x'
    z' = x' - sigma_0 |x'| z / g(x')        g = F_c + (F_s - F_c) exp(-(x'/v_s)^2)

Its friction has no rest time: the break-away force depends on how fast the force rises.  Canudas de Wit, Olsson, Astrom
and Lischinsky, A new model for control of systems with friction, IEEE Trans. Automatic Control 40 (1995).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

from stickslip_sim.core.arrays import Columns, Numbers

_TOLERANCE = 1e-9                         # relative
_SMALLEST = (1e-13, 1e-11, 1e-13)         # m, m/s, m


@dataclass(frozen=True)
class LuGreAxis:
    """A slider with LuGre friction on the drive spring and damper of docs/model.md; SI units."""

    mass: float = 100.0
    drive_stiffness: float = 2.0e5
    drive_damping: float = 800.0
    coulomb_force: float = 150.0
    static_force: float = 270.0
    stribeck_velocity: float = 0.003
    bristle_stiffness: float = 2.0e7       # sigma_0
    bristle_damping: float = 1.0e4         # sigma_1
    viscous: float = 200.0                 # sigma_2

    def samples(self, feed_times: Sequence[float], feeds: Sequence[float], duration: float, rate: float) -> Columns:
        """Return samples of a run from rest under feeds in steps, `rate` a second, by the names of a run's samples."""
        times = np.arange(round(duration * rate) + 1) / rate
        state, drive_start = np.zeros(3), 0.0
        parts: list[Numbers] = []
        for (begin, end), feed in zip(pairwise((*feed_times, duration)), feeds, strict=True):
            inside = times[(times >= begin) & ((times < end) | (end == duration))]
            found = solve_ivp(self._rates, (begin, end), state, 'LSODA', np.union1d(inside, end), rtol=_TOLERANCE,
                              atol=_SMALLEST, args=(begin, drive_start, feed))
            drive = drive_start + feed * (inside - begin)
            parts.append(np.vstack((found.y[:, :len(inside)], drive, np.full(len(inside), feed))))
            state, drive_start = found.y[:, -1], drive_start + feed * (end - begin)
        return self._columns(times, np.hstack(parts))

    def _rates(self, time: float, state: Numbers, begin: float, drive_start: float, feed: float) -> list[float]:
        position, velocity, bend = state.tolist()
        drive = drive_start + feed * (time - begin)
        bending = self._bending(velocity, bend)
        force = self.drive_stiffness * (drive - position) + self.drive_damping * (feed - velocity)
        friction = self.bristle_stiffness * bend + self.bristle_damping * bending + self.viscous * velocity
        return [velocity, (force - friction) / self.mass, bending]

    def _bending(self, velocity: float, bend: float) -> float:
        """Return z', m/s."""
        slipping = self.coulomb_force + (self.static_force - self.coulomb_force) * math.exp(
            -(velocity / self.stribeck_velocity)**2)
        return velocity - self.bristle_stiffness * abs(velocity) * bend / slipping

    def _columns(self, times: Numbers, rows: Numbers) -> Columns:
        position, velocity, bend, drive, feed = rows
        bending = np.array([self._bending(*pair) for pair in zip(velocity.tolist(), bend.tolist())])
        return {'time': times, 'position': position, 'velocity': velocity, 'drive_position': drive,
                'drive_force': self.drive_stiffness * (drive - position) + self.drive_damping * (feed - velocity),
                'friction_force': self.bristle_stiffness * bend + self.bristle_damping * bending
                + self.viscous * velocity}
