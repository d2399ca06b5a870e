# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The ring-down of a compliant contact after each slip: identified from the motion, and in closed form.

In stick m ẍ = c (s − x) + h (v − ẋ) − c_c δ − h_c ẋ + F_e; the difference to the standstill, under constant inputs,

    ẍ − ẍ₀ = −2 ζ ω₀ (ẋ − ẋ₀) − ω₀² (x − x₀) + r (t − t₀)        ω₀² = (c + c_c)/m,  2 ζ ω₀ = (h + h_c)/m

is linear in what is sought: least squares find it from the recorded motion, without a first guess.
"""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..axis import Axis, CompliantContact
from ..core.arrays import Columns
from ..figures.slips import complete_slips, complete_sticks
from ..runs import Run
from .look import RunPart, steady_inputs, within

RING_DOWN = 'ring-down'   # the watch
_LEAST_SAMPLES = 8
_PERIODS = 4.0      # of the ring-down: what comes later is too small to add anything
_OF_FIT = 'acceleration', 'velocity', 'position', 'time'


class RingDown(NamedTuple):
    """How the contact rings."""

    frequency: float          # Hz, undamped
    damped_frequency: float   # Hz; 0 when it does not swing
    damping_ratio: float
    decay: float              # 1/s, of the envelope


class Unseen:
    """A stick that shows no ring-down."""


def closed_form(axis: Axis) -> RingDown | None:
    """Return √((c + c_c)/m)/2π and (h + h_c)/(2 √((c + c_c) m)); None without a compliant contact."""
    if not isinstance(axis.contact, CompliantContact):
        return None
    stiffness = axis.drive_stiffness + axis.contact.stiffness
    return _ring_down(stiffness / axis.mass, (axis.drive_damping + axis.contact.damping) / axis.mass)


def latest_ringing(part: RunPart) -> RingDown | Unseen | None:
    """Return the ring-down of the last complete stick of a part with constant inputs; None without such a stick."""
    form = closed_form(part.scene.axis)
    if form is None:
        return None
    for begin, end in reversed(complete_sticks(part.events)):
        until = min(end.time, begin.time + _PERIODS / form.frequency)
        if steady_inputs(part, begin.time, until):
            first, last = np.searchsorted(part.samples['time'], (begin.time, until))
            motion = {name: part.samples[name][first:last] for name in _OF_FIT}
            return (_fitted(motion) if last - first >= _LEAST_SAMPLES else None) or Unseen()
    return None


def identified(found: Sequence[RingDown | Unseen | None]) -> RingDown | None:
    """Return the latest ring-down that was looked for, None when there is none to see."""
    latest = next((ring for ring in reversed(found) if ring is not None), None)
    return latest if isinstance(latest, RingDown) else None


def _fitted(motion: Columns) -> RingDown | None:
    a, u, x, t = (motion[name] - motion[name][0] for name in _OF_FIT)
    columns = np.stack([-u, -x, t], axis=1)
    scales = np.abs(columns).max(axis=0)
    if not np.all(scales > 0.0):
        return None
    damping, stiffness, _ = np.linalg.lstsq(columns / scales, a, rcond=None)[0] / scales
    return _ring_down(float(stiffness), float(damping)) if stiffness > 0.0 else None


def _ring_down(stiffness: float, damping: float) -> RingDown:
    """Return the figures of ÿ + damping ẏ + stiffness y = 0."""
    omega = math.sqrt(stiffness)
    ratio = damping / (2.0 * omega)
    damped = omega * math.sqrt(max(1.0 - ratio * ratio, 0.0))
    return RingDown(omega / math.tau, damped / math.tau, ratio, 0.5 * damping)


# The largest acceleration in each slip.

SLIP_PEAKS = 'slip peaks'   # the watch


def slip_peaks(part: RunPart) -> dict[float, float]:
    """Return the largest |ẍ| of each complete slip of a part, m/s², by its start, s."""
    return {begin.time: float(np.abs(within(part, begin.time, end.time)['acceleration']).max())
            for begin, end in complete_slips(part.events)}


def peak_accelerations(run: Run, found: Sequence[Mapping[float, float]]) -> list[float]:
    """Return the largest |ẍ| in the slip of each cycle, m/s²."""
    peaks = {begin: peak for each in found for begin, peak in each.items()}
    return [peaks[cycle.begin] for cycle in run.cycles()]
