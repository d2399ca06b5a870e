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

Noise, and how a controller holds its force from reading to reading, decide when a slider breaks away: later by δ it
has the velocity (F_s − F_k) δ/m less from then on, many times the noise of a sample.  So each motion is simulated from
its own break-away on, at the time that the readings of its position say, and what another time does to the residuals
is taken out of them.  Static friction is the force that it took.

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
from .motions import MeasuredMotion, StillRest, still_rests
from .readings import (
    LINE,
    SMALLEST_FORCE,
    Channel,
    InputReadings,
    SensorReadings,
    noise_of,
    noise_of_thirds,
    own_noise_of,
    quantum_of,
    weights_of,
)

_NOTICEABLE = 0.1   # of the noise of a sensor: less by the noise of the force over the whole run is left out
_GAP = 1.5          # periods: after longer ones the filter starts anew
_BEFORE = 5         # samples before a stop, which in the simulation may come a little earlier
_LEFT = 0.01        # of a step that the filter has not learnt yet
_NONE = np.zeros(0, dtype=np.intp)   # rows
_LEAST = 1e-9       # of the noise of a sensor: less of the force is none


class BreakAwayNoise(NamedTuple):
    """What is unknown of a break-away, and does to residuals from the row `begin` on: unit vectors `ways` (n, r).

    They are left with the `shares` (r,) of what they are: 0 in weighted residuals, more in those that are white.
    """

    begin: int
    ways: Numbers
    shares: Numbers

    def taken_from(self, residuals: Numbers) -> None:
        """Take it out of residuals (n,)."""
        part = residuals[self.begin:self.begin + len(self.ways)]
        part -= self.ways @ ((1.0 - self.shares) * (self.ways.T @ part))


class NoiseFilter(NamedTuple):
    """(1 − z⁻¹)ⁿ over 1 + a₁ z⁻¹ + …; what comes out has a standard `deviation`, in the unit of the channel.

    It starts anew at the rows `begins`, after gaps and before break-aways; at those `known` the simulation is right.
    `counts` (n,) is 0 where the slider rests or has just come to a stop, and from a gap, over which nobody knows the
    force, or a start in motion, to the next stop; else 1.  `roots` (n,) are those of the weights of the readings.
    """

    order: int
    denominator: tuple[float, ...]
    deviation: float
    begins: tuple[int, ...]
    known: frozenset[int]
    counts: Numbers
    roots: Numbers
    break_aways: tuple[BreakAwayNoise, ...] = ()
    corners: tuple[BreakAwayNoise, ...] = ()

    def white(self, residuals: Numbers) -> Numbers:
        """Return what is new in each of the residuals (n,), in their unit."""
        from scipy.signal import lfilter  # takes a while, and most runs need no filter

        numerator = (1.0, -1.0) if self.order == 1 else (1.0, -2.0, 1.0)
        found, steady = np.empty(len(residuals)), np.array((-1.0, 1.0)[:self.order])
        for first, last in zip(self.begins, (*self.begins[1:], len(residuals)), strict=True):
            part = residuals[first:last]
            before = 0.0 if first in self.known else part[0]   # that it was all along, and nothing came out
            found[first:last], _ = lfilter(numerator, self.denominator, part, zi=before * steady)
        found *= self.counts
        for one in (*self.corners, *self.break_aways):
            if one.shares.any():
                one.taken_from(found)
        return found

    def of_corners(self, rows: NDArray[np.intp], learns: int) -> 'NoiseFilter':
        """Return the filter that does not know what a corner of the force at rows did: a push at the reading after."""
        from scipy.signal import lfilter

        answer, found = lfilter((1.0,), self.denominator, np.append(1.0, np.zeros(learns))), []
        for near in np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1):
            begin = int(near[0]) + 1
            ways: Numbers = np.zeros((len(near) + learns, len(near)))
            for k in range(len(near)):
                ways[k:k + learns + 1, k] = answer
            ways = ways[:len(self.counts) - begin] * self.counts[begin:begin + len(ways), None]
            turned, sizes, _ = np.linalg.svd(ways, full_matrices=False)
            known = turned[:, sizes > _LEFT]
            found.append(BreakAwayNoise(begin, known, np.full(known.shape[1], _LEAST)))
        return self._replace(corners=tuple(found))

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

    def from_row(self, rows: slice) -> 'NoiseFilter':
        """Return the filter of some rows, at the first of which the simulation is right; without its break-aways."""
        corners = tuple(one._replace(begin=one.begin - rows.start) for one in self.corners
                        if rows.start <= one.begin <= rows.stop - len(one.ways))
        begins = (0, *(row - rows.start for row in self.begins if rows.start < row < rows.stop))
        return self._replace(begins=begins, known=frozenset({0}), counts=self.counts[rows], roots=self.roots[rows],
                             break_aways=(), corners=corners)

    def weighted(self, residuals: Numbers) -> Numbers:
        """Return `white` residuals (n,) times the roots of their weights, without what break-aways leave unknown."""
        found = np.asarray(self.roots * self.white(residuals))
        for one in self.break_aways:
            if not one.shares.any():
                one.taken_from(found)
        return found


def unknown(begin: int, way: Numbers) -> BreakAwayNoise:
    """Return what is unknown of a break-away of which nothing is left: a vector (n,) of any length."""
    return BreakAwayNoise(begin, way[:, None] / max(float(np.linalg.norm(way)), 1e-300), np.zeros(1))


def corners_of(values: Numbers, noise: float) -> NDArray[np.intp]:
    """Return the rows of readings (n,) beside a corner of the force: there a line through them is off by more.

    How much the corner is worth depends on where it is between two readings.
    """
    turns = np.diff(values, 2)
    if len(turns) < 3:
        return _NONE
    limit = max(_CORNER * noise, _USUAL * float(np.median(np.abs(turns))))
    return np.flatnonzero((np.abs(turns) > limit) & ~_are_even(turns)) + 1


def filters_of(measurement: SensorReadings, force_noise: float, mass: float, stops: Numbers,
               moves: bool = False, parts: Sequence[slice] = (), corners: NDArray[np.intp] = _NONE
               ) -> tuple[NoiseFilter | None, ...]:
    """Return a filter for each channel, None where noise of the force (N, a standard deviation) does not show.

    The slider comes to rest, or turns, at the times `stops` (s); at the start it `moves`, nobody knows how, or rests.
    Only `parts` of the run count, if there are any, each of which begins with a rest, or with the run.
    """
    step = force_noise / mass * measurement.period        # m/s, what one reading of the force is off by
    gaps = np.flatnonzero(np.diff(measurement.times) > _GAP * measurement.period) + 1
    unknown = [*([0] if moves else []), *gaps.tolist()]
    rows = np.searchsorted(measurement.times, stops)
    return tuple(_filter(channel, step, measurement.period, unknown, rows, parts, corners)
                 for channel in measurement.channels)


def _filter(channel: Channel, step: float, period: float, unknown: Sequence[int], stops: NDArray[np.intp],
            parts: Sequence[slice], corners: NDArray[np.intp]) -> NoiseFilter | None:
    orders = {'velocity': 1, 'position': 2}
    order, count = orders.get(channel.name, 0), len(channel.values)
    grown = step * count**0.5 * (period * count if order == 2 else 1.0)
    if order == 0 or (grown <= _NOTICEABLE * channel.resolution and not parts):
        return None
    own = own_noise_of(channel.values, channel.quantum) if channel.quantum > 0.0 else channel.resolution
    ratio = max(step * (period if order == 2 else 1.0) / own, _LEAST)
    denominator, more = _of_velocity(ratio) if order == 1 else _of_position(ratio)
    learns = math.ceil(order * math.log(_LEFT) / math.log(max(abs(denominator[-1]), _LEFT)))
    counts = np.zeros(count)
    whole = [slice(0, count)]
    for part in parts or whole:
        counts[part] = 1.0
        inside = stops[(stops > part.start) & (stops < part.stop + _BEFORE)]
        for row in inside:
            counts[max(row - _BEFORE, part.start):min(row + learns, part.stop)] = 0.0
        for row in (row for row in unknown if part.start <= row < part.stop):
            later = inside[inside >= row]
            counts[row:int(later[0]) if len(later) else part.stop] = 0.0
    known = frozenset(part.start for part in parts or whole)
    found = NoiseFilter(order, denominator, more * own, tuple(sorted({0, *unknown, *known})), known, counts,
                        np.sqrt(channel.weights))
    return found.of_corners(corners, learns) if len(corners) and order == 2 else found


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
_EVEN = 0.3     # of a second difference: so far those beside it may be from one of a force that turns evenly
_CORNER, _USUAL = 12.0, 20.0   # of the noise, and of the median second difference: a larger one is a corner
_FEWEST = 100   # readings at rest, of which the noise is taken


def with_quiet_rests(measurement: SensorReadings, motions: Sequence[MeasuredMotion], yields: bool = False
                     ) -> SensorReadings:
    """Return the measurement with its force smoothed while the slider rests; `force_readings` stay as they are.

    The noise is that at rest, if there is enough of it: what a controller makes of the steps of its encoder drives the
    slider, and is no noise.  A contact that `yields` moves at rest, too.
    """
    readings = measurement.force_readings
    if readings is None or not motions:
        return measurement
    times, values, quantum = measurement.times, readings.values.copy(), quantum_of(readings.values)
    found: Sequence[StillRest | None] = [None] * len(motions) if yields else still_rests(measurement, motions)[0]
    since = np.searchsorted(times, [times[0], *(motion.end for motion in motions)]).tolist()
    begins = np.searchsorted(times, [motion.passed[0] if yields else motion.begin for motion in motions]).tolist()
    until = [begin if rest is None else rest.last + 1 for begin, rest in zip(begins, found, strict=True)]
    rests = [slice(*ends) for ends in zip(since, (*until, len(times)), strict=True)]
    thirds = [np.diff(values[rest], 3) for rest in rests]
    noise, weights = noise_of(values, quantum, SMALLEST_FORCE), weights_of(values, quantum)
    if sum(map(len, thirds)) >= _FEWEST:
        least = SMALLEST_FORCE * float(np.ptp(values))
        noise = min(max(noise_of_thirds(np.concatenate(thirds), quantum), least), noise)
    values = _bent(values, quantum)
    deviations = np.full(len(times), noise)
    for rest in rests:
        values[rest], deviations[rest] = _smoothed(values[rest], noise, weights[rest])
    return replace(measurement, force=InputReadings(times, values, LINE).profile(), force_noise=noise,
                   force_deviations=deviations)


def _bent(values: Numbers, quantum: float) -> Numbers:
    """Return readings (n,) through which lines do what the force does where it turns evenly at them (Numerov's rule).

    A line through two readings is off by a twelfth of the second difference, always to the same side.  A turn that may
    be noise stays.
    """
    turns, least = np.diff(values, 2), _CORNER * noise_of_thirds(np.diff(values, 3), quantum)
    found = values.copy()
    found[1:-1] -= np.where(_are_even(turns) & (np.abs(turns) > least), turns, 0.0) / 12.0
    return found


def _are_even(turns: Numbers) -> NDArray[np.bool_]:
    """Return where second differences (n,) are as those beside them."""
    apart = np.abs(np.diff(turns))
    return np.pad(np.maximum(apart[:-1], apart[1:]) < _EVEN * np.abs(turns[1:-1]), 1)


def _smoothed(values: Numbers, noise: float, weights: Numbers) -> tuple[Numbers, Numbers]:
    """Return readings (n,) smoothed by parabolas, each as long as it follows them, so that a step stays a step.

    The second are the standard deviations (n,) that the noise has left, more of it at both ends; readings of one count
    say no more than one.
    """
    from scipy.ndimage import uniform_filter1d  # both take a while, and only a measured force needs them
    from scipy.signal import savgol_filter

    found, left_of_noise = values, np.ones(len(values))
    for length in (length for length in _LENGTHS if length <= len(values)):
        smooth, half = savgol_filter(values, length, 2), length // 2
        left = uniform_filter1d((values - smooth)**2, length)
        follows = left <= (1.0 + _CHANCE * (2.0 / length)**0.5) * noise**2
        found = np.where(follows, smooth, found)
        powers = np.vander(np.linspace(-1.0, 1.0, length), 3)
        shares = np.diag(powers @ np.linalg.inv(powers.T @ powers) @ powers.T)
        share = np.concatenate([shares[:half], np.full(len(values) - 2 * half, shares[half]), shares[half + 1:]])
        left_of_noise[follows] = np.minimum(share / uniform_filter1d(weights, length), 1.0)[follows]
    return np.asarray(found), noise * np.sqrt(left_of_noise)
