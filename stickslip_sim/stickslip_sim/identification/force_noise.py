# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The noise of a measured force, which the motion takes up: filters that make residuals white, and quiet rests.

A force that drives a slider by itself is simulated as it was measured, with the noise of its sensor; the mass
integrates it, once to a velocity, twice to a position.  The residuals y of a position are no readings with independent
noise then, but

    (1 − z⁻¹)² y = u + (1 − z⁻¹)² n,

u the noise of the force over the mass, n that of the encoder.  What is new in each sample, e, with one standard
deviation and nothing in common with those before, is (1 − z⁻¹)² y through the filter whose square has the spectrum of
the right side: Kalman's in its steady state, here in closed form.  The sum of squares of e is the likelihood.
Friction, which lets the velocity forget the noise within m/d, is left out: within the few samples over which force and
encoder say as much as each other it does nothing.  A stop makes the slider forget it at once, which the filter does not
know: the few samples in which it learns that count nothing.

Noise decides, too, when a slider breaks away: later by δ it has the velocity (F_s − F_k) δ/m less from then on, many
times the noise of a sample.  That is one error of the force for each break-away: motions with other errors show what
each does to the residuals, and with the covariance 1 + Σ p(z) Δ(z) Δ(z)ᵀ of these they are made white.

Source: A. C. Harvey, Forecasting, Structural Time Series Models and the Kalman Filter (1989), 2.3 and 4.3.
"""

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..axis import Friction
from ..core.arrays import Numbers
from .motions import MeasuredMotion
from .readings import LINE, Channel, InputReadings, SensorReadings, noise_of, own_noise_of, quantum_of

_NOTICEABLE = 0.1   # of the noise of a sensor: less by the noise of the force over the whole run is left out
_GAP = 1.5          # periods: after longer ones the filter starts anew
_BEFORE = 5         # samples before a stop, which in the simulation may come a little earlier
_LEFT = 0.01        # of a step that the filter has not learnt yet


class BreakAwayNoise(NamedTuple):
    """What the error of the force at a break-away does from the row `begin` on: residuals in `ways` (n, r), too large.

    They are left with the `shares` (r,) of what they are.
    """

    begin: int
    ways: Numbers
    shares: Numbers


class NoiseFilter(NamedTuple):
    """(1 − z⁻¹)ⁿ over 1 + a₁ z⁻¹ + …; what comes out has a standard `deviation`, in the unit of the channel.

    It starts anew at the rows `begins`, after gaps.  `counts` (n,) is 0 where the slider has just come to a stop, and
    from a gap, over which nobody knows the force, or a start in motion, to the next stop; else 1.  `roots` (n,) are
    those of the weights of the readings.
    """

    order: int
    denominator: tuple[float, ...]
    deviation: float
    begins: tuple[int, ...]
    counts: Numbers
    roots: Numbers
    break_aways: tuple[BreakAwayNoise, ...] = ()

    def white(self, residuals: Numbers) -> Numbers:
        """Return what is new in each of the residuals (n,), in their unit."""
        from scipy.signal import lfilter, lfiltic  # takes a while, and most runs need no filter

        numerator = (1.0, -1.0) if self.order == 1 else (1.0, -2.0, 1.0)
        found = np.empty(len(residuals))
        for first, last in zip(self.begins, (*self.begins[1:], len(residuals)), strict=True):
            part = residuals[first:last]
            before = 0.0 if first == 0 else part[0]   # at the start of the run the simulation is right; else unknown
            state = lfiltic(numerator, self.denominator, np.zeros(self.order), np.full(self.order, before))
            found[first:last], _ = lfilter(numerator, self.denominator, part, zi=state)
        found *= self.counts
        for one in self.break_aways:
            part = found[one.begin:one.begin + len(one.ways)]
            part -= one.ways @ ((1.0 - one.shares) * (one.ways.T @ part))
        return found

    def of_break_aways(self, changes: Sequence[Numbers], edges: NDArray[np.intp], scales: Numbers) -> 'NoiseFilter':
        """Return the filter that knows how residuals (n,) change by errors of the force at break-aways.

        The k-th break-away moves the rows from `edges[k]` to the next edge; `scales` (k,) are factors on its changes.
        The root of the probability of each error is in its change.
        """
        moved = np.stack([self.white(change) for change in changes], axis=1) / self.deviation
        found = []
        for begin, end, scale in zip(edges[:-1], edges[1:], scales, strict=True):
            ways, sizes, _ = np.linalg.svd(scale * moved[begin:end], full_matrices=False)
            large = sizes > _LEFT
            if large.any():
                found.append(BreakAwayNoise(int(begin), ways[:, large], (1.0 + sizes[large]**2)**-0.5))
        return self._replace(break_aways=tuple(found))

    def weighted(self, residuals: Numbers) -> Numbers:
        """Return `white` residuals (n,) times the roots of their weights."""
        return np.asarray(self.roots * self.white(residuals))


def filters_of(measurement: SensorReadings, force_noise: float, mass: float, stops: Numbers,
               moves: bool = False) -> tuple[NoiseFilter | None, ...]:
    """Return a filter for each channel, None where noise of the force (N, a standard deviation) does not show.

    The slider comes to rest, or turns, at the times `stops` (s); at the start it `moves`, nobody knows how, or rests.
    """
    step = force_noise / mass * measurement.period        # m/s, what one reading of the force is off by
    gaps = np.flatnonzero(np.diff(measurement.times) > _GAP * measurement.period) + 1
    begins = (0, *(int(row) for row in gaps))
    rows = np.searchsorted(measurement.times, stops)
    return tuple(_filter(channel, step, measurement.period, begins, rows, moves)
                 for channel in measurement.channels)


def _filter(channel: Channel, step: float, period: float, begins: tuple[int, ...], stops: NDArray[np.intp],
            moves: bool) -> NoiseFilter | None:
    orders = {'velocity': 1, 'position': 2}
    order = orders.get(channel.name, 0)
    count = float(len(channel.values))
    grown = step * count**0.5 * (period * count if order == 2 else 1.0)
    if order == 0 or grown <= _NOTICEABLE * channel.resolution:
        return None
    own = own_noise_of(channel.values, channel.quantum) if channel.quantum > 0.0 else channel.resolution
    ratio = step * (period if order == 2 else 1.0) / own
    denominator, more = _of_velocity(ratio) if order == 1 else _of_position(ratio)
    learns = math.ceil(order * math.log(_LEFT) / math.log(max(abs(denominator[-1]), _LEFT)))
    counts = np.ones(len(channel.values))
    for row in stops:
        counts[max(row - _BEFORE, 0):row + learns] = 0.0
    for row in begins if moves else begins[1:]:
        later = stops[stops >= row]
        counts[row:int(later[0]) if len(later) else len(counts)] = 0.0
    return NoiseFilter(order, denominator, more * own, begins, counts, np.sqrt(channel.weights))


def _of_velocity(ratio: float) -> tuple[tuple[float, ...], float]:
    """Return the denominator, and the deviation over that of a reading, of y whose change is that of the noise.

    The force is a line between two readings, so that u is the mean of two, and the spectrum r² (w + 4)/4 − w, w being
    z + 1/z − 2 and r the ratio of what a reading of the force and one of the velocity are off by.
    """
    return (1.0, (ratio - 2.0) / (ratio + 2.0)), 1.0 + 0.5 * ratio


def _of_position(ratio: float) -> tuple[tuple[float, ...], float]:
    """Return the same for y whose second change is that of the noise: the spectrum is r² (w + 6)²/36 + w²."""
    w = 1j * ratio / (1.0 - 1j * ratio / 6.0)
    middle = 1.0 + 0.5 * w
    root = cmath.sqrt(middle * middle - 1.0)
    inside = min(middle + root, middle - root, key=abs)   # z + 1/z − 2 = w has one root inside the circle
    square = abs(inside)**2
    return (1.0, -2.0 * inside.real, square), ((1.0 + ratio**2 / 36.0) / square)**0.5


def white_of(filters: Sequence[NoiseFilter | None], k: int, channel: Channel, residuals: Numbers) -> Numbers:
    """Return the residuals (n,) of a channel as independent ones, with the standard deviation of its noise."""
    own = filters[k]
    return residuals if own is None else np.asarray(own.white(residuals) * (channel.resolution / own.deviation))


# The errors of a force at a break-away that are tried, in standard deviations, and the roots of their probabilities.

_ERRORS = np.array([z for z in np.linspace(-3.0, 3.0, 13) if z != 0.0])
ERRORS = tuple(zip(_ERRORS.tolist(), np.sqrt(np.exp(-0.5 * _ERRORS**2) / (2.0 * (2.0 * math.pi)**0.5)).tolist()))


def with_static_times(friction: Friction, factor: float) -> Friction:
    """Return friction whose static coefficients are multiplied, but not below the kinetic one at rest."""
    static, least = friction.static, friction.kinetic.coefficients[0]
    initial = max(factor * static.initial, least)
    return replace(friction, static=replace(static, initial=initial, limit=max(factor * static.limit, initial)),
                   backward=friction.backward and with_static_times(friction.backward, factor))


# The measured force on a slider, with less of the sensor's noise in it while the slider rests.
#
# In a simulation, noise makes the slider break away early: at the first reading above static friction, before the force
# itself gets there.  At rest the force moves nothing, so smoothing it there changes only the moment of the break-away.

_LENGTHS = 5, 9, 17, 33, 65   # readings in a parabola: the longest one that follows the force is taken
_CHANCE = 4.0   # standard deviations of a mean square: residuals of a parabola up to that are noise


def with_quiet_rests(measurement: SensorReadings, motions: Sequence[MeasuredMotion]) -> SensorReadings:
    """Return the measurement with its force smoothed while the slider rests; `force_readings` stay as they are.

    Each rest is taken to last until the slider has gone a tenth of its next motion: smoothing does no harm there, and
    the `begin` of a motion may come before the break-away.
    """
    readings = measurement.force_readings
    if readings is None or not motions:
        return measurement
    times = measurement.times
    ends = [times[0], *(motion.end for motion in motions)]
    begins = [*(motion.passed[0] for motion in motions), times[-1]]
    at_rest = np.any([(times >= end) & (times <= begin) for end, begin in zip(ends, begins, strict=True)], axis=0)
    smooth, deviations = _smoothed(readings.values)
    values = np.where(at_rest, smooth, readings.values)
    return replace(measurement, force=InputReadings(times, values, LINE).profile(), force_deviations=deviations)


def _smoothed(values: Numbers) -> tuple[Numbers, Numbers]:
    """Return readings (n,) smoothed by parabolas, each as long as it follows them, so that a step stays a step.

    The second are the standard deviations (n,) that the noise has left.
    """
    from scipy.ndimage import uniform_filter1d  # both take a while, and only a measured force needs them
    from scipy.signal import savgol_filter

    variance, found = noise_of(values, quantum_of(values))**2, values
    left_of_noise = np.ones(len(values))
    for length in (length for length in _LENGTHS if length < len(values)):
        smooth = savgol_filter(values, length, 2)
        left = uniform_filter1d((values - smooth)**2, length)
        follows = left <= (1.0 + _CHANCE * (2.0 / length)**0.5) * variance
        found = np.where(follows, smooth, found)
        left_of_noise[follows] = 0.75 * (3.0 * length**2 - 7.0) / (length * (length**2 - 4.0))
    return np.asarray(found), np.sqrt(variance * left_of_noise)
