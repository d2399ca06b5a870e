# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A LuGre axis identified as if it were ours: the misfit must be reported, and the scene found must still be of use.

Each slip of the model from the measured arrest before it is read off by the rule of the measured ones, as `identify`
prints it.  The scene found, left to itself, has slips of its own: off both motions they are read by the same rule
(`figures/slips.py`), the stick before each and the largest friction force in it.
"""

import time
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from stickslip_sim.core.arrays import Columns
from stickslip_sim.figures.slips import slips_of
from stickslip_sim.identification.identified import SlipFit
from stickslip_sim.identification.identify import identify
from stickslip_sim.runs import simulate
from stickslip_sim.scene import Scene, scene_from_values

from .lugre import LuGreAxis
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
