# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A LuGre axis identified as if it were ours: the misfit must be reported, and the scene found must still be of use.

Each slip of the model from the measured arrest before it is read off by the rule of the measured ones, as `identify`
prints it.  The scene found, left to itself, has slips of its own: off both motions they are read by the same rule
(`figures/slips.py`), the stick before each and the largest friction force in it.
"""

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from stickslip_sim.core.arrays import Columns, Numbers
from stickslip_sim.figures.slips import slips_of
from stickslip_sim.identification.identified import SlipFit
from stickslip_sim.identification.identify import identify
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene, scene_from_values

from .measuring import Measurement, shown

DURATION, RATE = 10.0, 1000.0   # s, 1/s
FEED_TIMES = (0.0, 3.0, 5.0, 6.5, 8.0)                    # s
FEEDS = (0.001, 0.002, 0.004, 0.03, -0.0015)              # m/s
NORMAL_FORCE = 100.0 * 9.80665                            # N
FREE: Mapping[str, tuple[float, float]] = {               # from, to
    'axis.drive_stiffness': (1e5, 4e5), 'axis.drive_damping': (200.0, 3000.0),
    'contact.stiffness': (2e6, 1e8), 'contact.damping': (1e3, 1e5),
    'friction.static.initial': (0.15, 0.5), 'friction.static.limit': (0.15, 0.6),
    'friction.static.time_constant': (0.02, 2.0),
    'friction.kinetic.initial': (0.1, 0.5), 'friction.kinetic.limit': (0.08, 0.3),
    'friction.kinetic.stribeck_velocity': (0.001, 0.03),
}
_SLIP_SPEED = 1e-3   # m/s, and five times that at the peak


class Slip(NamedTuple):
    """A slip: when it begins, the stick before it (s), and the largest friction force in that (N)."""

    time: float
    stick_time: float
    force: float


class Pair(NamedTuple):
    """A slip of the LuGre axis and that of the scene found which is nearest in time."""

    true: Slip
    found: Slip


class ForeignOutcome(NamedTuple):
    """Whether the model is said to fit, what the tests say, the slips of both, and s of processor time.

    `pairs` are those of the scene left to itself, `slips` those from measured arrests.
    """

    fits: bool
    statements: tuple[str, ...]
    slips: tuple[SlipFit, ...]
    true_slips: int
    found_slips: int
    pairs: tuple[Pair, ...]
    seconds: float

    def differences(self, of: str) -> list[float]:
        """Return by how much a figure of the slips differs, as shares, in order of size."""
        return sorted(abs(getattr(pair.found, of) / getattr(pair.true, of) - 1.0) for pair in self.pairs)

    def differences_of_slips(self, of: str) -> list[float]:
        """Return by how much a figure of the slips from measured arrests differs, as shares, in order of size."""
        return sorted(abs(getattr(slip, f'fitted_{of}') / getattr(slip, of) - 1.0) for slip in self.slips)


def start_scene() -> Scene:
    """Return what a user would begin with: our laws, with numbers that are about right."""
    return scene_from_values({
        'scene': 'lugre', 'axis.mass': 100.0, 'axis.drive_stiffness': 1.6e5, 'axis.drive_damping': 1000.0,
        'axis.normal_force': NORMAL_FORCE, 'contact.model': 'compliant', 'contact.stiffness': 1e7,
        'contact.damping': 1e4, 'friction.static.law': 'exponential', 'friction.static.initial': 0.22,
        'friction.static.limit': 0.3, 'friction.static.time_constant': 0.2, 'friction.kinetic.law': 'stribeck',
        'friction.kinetic.initial': 0.2, 'friction.kinetic.limit': 0.13, 'friction.kinetic.stribeck_velocity': 0.005,
        'friction.kinetic.viscous': 0.2, 'drive.course': 'steps', 'drive.times': FEED_TIMES,
        'drive.velocities': FEEDS})


def free_file() -> dict[str, object]:
    """Return the file of free parameters, as YAML gives it."""
    return {'seed': 0, 'parameters': {name: {'distribution': 'uniform', 'low': low, 'high': high}
                                      for name, (low, high) in FREE.items()}}


def lugre_samples() -> Columns:
    """Return the true motion."""
    return LuGreAxis().samples(FEED_TIMES, FEEDS, DURATION, RATE)


def lugre_measurement(samples: Columns, seed: int = 0) -> Measurement:
    """Return what the sensors show of it."""
    return shown(samples, np.random.default_rng(seed))


def identify_lugre() -> ForeignOutcome:
    """Return what came of it."""
    true = lugre_samples()
    with TemporaryDirectory() as parent:
        run = lugre_measurement(true).as_run(Path(parent, 'run'))
        begin = time.process_time()
        found = identify(run, start_scene(), free_file())
        seconds = time.process_time() - begin
    slips, own = slips_in(true), slips_in(simulate(found.scene, DURATION, 1.0 / RATE).samples)
    return ForeignOutcome(found.fits, tuple(misfit.statement for misfit in found.misfits), found.slips, len(slips),
                          len(own), pairs_of(slips, own), seconds)


def slips_in(samples: Columns) -> list[Slip]:
    """Return the slips of a motion that begin in stick."""
    found: list[Slip] = []
    rested = 0
    for first, end, _, _ in slips_of(samples['velocity'], _SLIP_SPEED):
        if first > rested:
            force = np.abs(samples['friction_force'][rested:first + 1]).max()
            begin, since = samples['time'][[first, rested]].tolist()
            found.append(Slip(begin, begin - since, float(force)))
        rested = end
    return found


def pairs_of(true: list[Slip], found: list[Slip]) -> tuple[Pair, ...]:
    """Return each true slip with the one found that is nearest in time, none without any."""
    if not found:
        return ()
    return tuple(Pair(slip, min(found, key=lambda other: abs(other.time - slip.time))) for slip in true)


# An axis that is not ours: LuGre friction, whose bristles bend before the slider slides, integrated by SciPy.
#
#     m x'' = c (s - x) + h (v - x') - F      F = sigma_0 z + sigma_1 z' + sigma_2 x'
#     z' = x' - sigma_0 |x'| z / g(x')        g = F_c + (F_s - F_c) exp(-(x'/v_s)^2)
#
# Its friction has no rest time: the break-away force depends on how fast the force rises.  Canudas de Wit, Olsson,
# Astrom and Lischinsky, A new model for control of systems with friction, IEEE Trans. Automatic Control 40 (1995).

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
