# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a run would say of parameters: its Fisher information, by differences of exact runs.

The information of readings with the deviation σ is JᵀJ/σ², J the derivatives of the readings with respect to the
logarithms of the parameters.  With what is known before, the deviation `known` of each logarithm, the covariance after
the run is (JᵀJ/σ² + 1/known²)⁻¹: that of a fit near its end.

Friction does not repeat as the model does.  If each parameter scatters by a share from slip to slip, a reading scatters
by that times the root of the sum of its squared derivatives, and all readings of a slip together: so much is added to
σ², times the number of readings of a slip.  A run then says no more of a parameter than scatter/√slips, however far
it amplifies what is small.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..core.arrays import Numbers
from ..core.types import EventKind, Sample
from ..figures.distance import first_difference
from ..scene import Scene
from .moved_number import moved_number
from .trace import Trace

SHARE_MOVED = 1e-6   # of a parameter
_EVEN = 12.0  # variance of a reading that is rounded: resolution² over this


@dataclass(frozen=True)
class Sensors:
    """What is measured `rate` times a second: the position, with its resolution and noise, m, and perhaps the force.

    `noise` and `force_noise` (N; None: the force is not measured) are standard deviations, independent from reading to
    reading.
    """

    rate: float
    resolution: float
    noise: float
    force_noise: float | None

    @property
    def deviations(self) -> dict[str, float]:
        """The standard deviation of each channel, by its name among samples."""
        found = {'position': math.sqrt(self.resolution**2 / _EVEN + self.noise**2)}
        return found if self.force_noise is None else {**found, 'drive_force': self.force_noise}


@dataclass(frozen=True)
class Slopes:
    """Derivatives of each channel with respect to the logarithms of k parameters, (k, n) at the n `times`, s.

    They are 0 from `until` (s) on, where the sequence of events changes within a step.  `slips` is the number of slips
    that came to an end.
    """

    times: Numbers
    by_channel: dict[str, Numbers]
    samples: dict[str, Numbers]
    until: float
    slips: int


def run_slopes(scene: Scene, names: list[str], times: Numbers, channels: list[str]) -> Slopes:
    """Return the derivatives of a run; raises InputError and SolverError where the scene cannot be run."""
    base = Trace(scene, times)
    places = [Sample._fields.index(channel) for channel in channels]
    found = np.empty((len(names), len(times), len(channels)))
    until = math.inf
    for k, name in enumerate(names):
        moved = moved_number(scene, name, SHARE_MOVED)
        first, last = min(moved.stencil.offsets), max(moved.stencil.offsets)
        low, high = (base if offset == 0.0 else Trace(moved.scene_with(moved.at(offset)), times)
                     for offset in (first, last))
        found[k] = (high.rows[:, places] - low.rows[:, places]) / ((last - first) * moved.step / abs(moved.value))
        until = min(until, _parting(low, high))
    found[:, times >= until] = 0.0
    columns = {name: base.rows[:, i] for i, name in enumerate(Sample._fields)}
    return Slopes(times, {channel: found[:, :, c] for c, channel in enumerate(channels)}, columns, until,
                  sum(event.kind in (EventKind.STICK, EventKind.REVERSE) for event in base.events))


def covariance_after(slopes: Slopes, deviations: dict[str, float], known: float, scatter: float) -> Numbers:
    """Return the covariance (k, k) of the logarithms after a run, each `known` to that deviation before."""
    count = len(next(iter(slopes.by_channel.values())))
    together = len(slopes.times) / max(slopes.slips, 1)
    information = np.eye(count)
    for channel, deviation in deviations.items():
        slope = slopes.by_channel[channel]
        scaled = slope * (known / np.sqrt(deviation**2 + together * scatter**2 * (slope**2).sum(axis=0)))
        information += scaled @ scaled.T
    sizes, axes = np.linalg.eigh(information)
    found: Numbers = known**2 * (axes / np.maximum(sizes, 1.0)) @ axes.T
    return found


def _parting(a: Trace, b: Trace) -> float:
    """Return from when on the events of two runs differ in kind, mode or direction, s; inf where they do not."""
    first = first_difference(a.sequence, b.sequence)
    return min((trace.events[first].time for trace in (a, b) if first is not None and first < len(trace.events)),
               default=math.inf)
