# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The residuals of an identification: of single slips, of stretches between measured arrests, and of the whole run."""

from collections.abc import Container, Sequence
from copy import copy
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.time_grid import Instants
from ..core.types import EventKind
from ..scene.build import Dynamics
from .axis_model import OUTPUT_PLACES, AxisModel
from .direct import DirectMotion, direct_drive, direct_motion, force_noise_of, sliding_motion
from .force_noise import ERRORS, NoiseFilter, filters_of, white_of, with_static_times
from .free_parameters import FreeParameter, Region, region_of, values_at
from .least_squares import STEP, Residuals
from .motions import MeasuredMotion, ends_in_rest, has_break_away, stops_of, track_of
from .readings import Channel, SensorReadings, instants_of
from .run_start import start_force
from .slip_features import (
    N_FIGURES,
    N_TELLING,
    MeasuredSlip,
    measured_slips,
    simulated_slip,
    slip_distance,
    telling_distance,
)

Rows = NDArray[np.intp]

_SHARP = 2.5   # of the speed of the drive: a slider that sways about it reaches 2 without any slip
_ROUGH = 0.02  # of a slip: so well the motion after a measured arrest is known
_MOVES = 5.0   # standard deviations: a speed that is one
_STATIC, _NOISY_STEP = 'friction.static.', 0.02
_STRETCH = 'initial.stretch'
_STEP = 0.02   # of the logarithm of a mass: how far noise of the force moves it is taken in such steps
_LOOSE = 2.0   # ranges: the standard deviation of a weak prior, which holds what the data do not determine


class MeasuredStretch(NamedTuple):
    """Samples from a measured arrest on (None: from the start of the run), s: their `rows`, and when after it."""

    before: MeasuredMotion | None
    begin: float
    rows: Rows
    at: Instants


class Stretches(NamedTuple):
    """Stretches one after the other: all their `rows`, and of each channel the measured values times `factors`.

    A factor is one over the standard deviation, so that a difference becomes a residual; behind the filter of the
    channel, if it has one.
    """

    parts: tuple[MeasuredStretch, ...]
    rows: Rows
    targets: tuple[Numbers, ...]
    factors: tuple[Numbers, ...]
    filters: tuple[NoiseFilter | None, ...]


class FitProblem:
    """What is sought, from which data; a point is an array (k,) of what the fit works on, one for each parameter."""

    def __init__(self, model: AxisModel, parameters: Sequence[FreeParameter], measurement: SensorReadings,
                 motions: Sequence[MeasuredMotion]) -> None:
        self.model, self.parameters, self.measurement = model, tuple(parameters), measurement
        self.motions = tuple(motions)
        drive = model.drive_of(np.array([one.start for one in parameters]))
        self.track = track_of(measurement, drive)
        self._rests, self._stops = ends_in_rest(motions, self.track, drive), stops_of(self.track)
        self._starts_in_motion = abs(float(self.track.velocity[1])) > _MOVES * self.track.velocity_noise
        rests = {id(motion) for motion in self._rests}
        self.slips = measured_slips(motions, measurement, self.track)
        self.clear_slips = [slip for slip in self.slips if slip.before is None or id(slip.before) in rests]
        self.sharp_slips = [slip for slip in self.clear_slips if _SHARP <= slip.overtakes < np.inf]
        self.start = np.array([one.inner(one.start) for one in parameters])
        self.region = self._region(has_break_away(motions, self.track, drive))
        self._start_force = start_force(measurement)
        self._is_stretch = np.array([self._start_force is not None and one.prior is None and one.name == _STRETCH
                                     for one in parameters])
        self.widths = np.array([one.width for one in parameters])
        self._mass, self._force_noise = model.scene.axis.mass, force_noise_of(measurement)
        self._filters: tuple[NoiseFilter | None, ...] = (None,) * len(measurement.channels)
        self._noisy_step = _NOISY_STEP
        self._sliding = self._of_sliding()
        self.take_input_noise_of(self.values(self.with_direct(self.start)))

    def _region(self, has_break_away: bool) -> Region:
        """Return where the parameters may go: static friction nowhere, where no measured break-away shows it."""
        found = region_of(self.parameters, self.model.scene.values)
        if has_break_away or self.model.is_pushed:
            return found
        held = np.array([one.name.startswith(_STATIC) for one in self.parameters])
        return Region(np.where(held, self.start, found.low), np.where(held, self.start, found.high)) \
            if held.any() else found

    def _of_sliding(self) -> DirectMotion | None:
        """Return what the motion under a measured force shows by itself; None where that is nothing."""
        motion = sliding_motion(self.measurement, self._mass) if self.model.is_pushed else None
        if motion is None:
            return None
        found = direct_motion(self.model, self.parameters, self.measurement, motion, self.clear_slips, self.start,
                              self.region)
        return found if found.is_shown.any() else None

    @property
    def is_direct(self) -> bool:
        """Whether a measured force that drives the slider by itself shows parameters directly."""
        return self._sliding is not None

    @property
    def nearest_start(self) -> Numbers:
        """The point (k,) to start from, nearest to what the readings show by themselves; else that of the scene."""
        return self.with_direct(self.start if self._sliding is None else self._sliding.point)

    @property
    def steps(self) -> Numbers:
        """The steps (k,) of derivatives: where noise of the input decides when it breaks away, as long as that noise.

        Between two readings the break-away does not move with its limit, and then it goes to another reading.
        """
        return np.array([self._noisy_step if self.model.is_pushed and one.name.startswith(_STATIC) else STEP
                         for one in self.parameters])

    def take_input_noise_of(self, values: Numbers) -> bool:
        """Take the noise of a measured force as it moves the mass of these values, in steps; return if that is new."""
        dynamics = self.model.dynamics(values)
        if not self.model.is_pushed or dynamics is None:
            return False
        was, self._mass = self._mass, float(np.exp(_STEP * np.round(np.log(dynamics.axis.mass) / _STEP)))
        self._filters = filters_of(self.measurement, self._force_noise, self._mass, self._stops,
                                   self._starts_in_motion)
        self._filters = self._of_break_aways(dynamics, values)
        return self._mass != was or any(one is not None and one.break_aways for one in self._filters)

    def _of_break_aways(self, dynamics: Dynamics, values: Numbers) -> tuple[NoiseFilter | None, ...]:
        """Return the filters with what noise of the force does to the break-aways that there are with trial values."""
        times, deviations = self.measurement.times, self.measurement.force_deviations
        motion = self.model.motion(dynamics, 0.0, dynamics.initial, float(times[-1]))
        if deviations is None or motion is None or all(one is None for one in self._filters):
            return self._filters
        rested, begins, shares = 0.0, [], []
        for event in motion.events:
            if event.kind == EventKind.STICK:
                rested = event.time
            elif event.kind == EventKind.BREAKAWAY and event.static_coefficient > 0.0:
                begins.append(0.5 * (rested + event.time))
                held = event.static_coefficient * dynamics.axis.normal_force
                shares.append(float(np.interp(event.time, times, deviations)) / held)
        at = instants_of(times)
        usual = float(np.median(shares)) if shares else 0.0
        here = motion.samples(at)
        if usual == 0.0 or here is None:
            return self._filters
        self._noisy_step = min(usual, _NOISY_STEP)
        moved = []
        for error, root in ERRORS:
            friction = with_static_times(dynamics.axis.friction, max(1.0 + usual * error, 0.0))
            other = dynamics._replace(axis=replace(dynamics.axis, friction=friction))
            rows = self.model.samples(other, 0.0, dynamics.initial, at)
            if rows is not None:
                moved.append((root, rows))
        edges = np.append(np.searchsorted(times, begins), len(times))
        places = [OUTPUT_PLACES[channel.name] for channel in self.measurement.channels]
        gains = [self.model.gain(values, channel.name)[1] for channel in self.measurement.channels]
        return tuple(one and one.of_break_aways([gain * root * (rows[:, k] - here[:, k]) for root, rows in moved],
                                                edges, np.array(shares) / usual)
                     for one, k, gain in zip(self._filters, places, gains, strict=True))

    def white(self, k: int, residuals: Numbers) -> Numbers:
        """Return the residuals (n,) of the k-th channel without what the noise of a measured force does to them."""
        return white_of(self._filters, k, self.measurement.channels[k], residuals)

    def with_direct(self, point: Numbers) -> Numbers:
        """Return a point (k,) with what the measured force says by itself, within the ranges."""
        found = direct_drive(self.model, self.values(point), self.measurement)
        point = point.copy()
        if self._sliding is not None:
            point[self._sliding.is_shown] = self._sliding.point[self._sliding.is_shown]
        for k, one in enumerate(self.parameters):
            if one.name in found:
                point[k] = one.inner(min(max(found[one.name], one.low), one.high))
        return point

    def values(self, point: Numbers) -> Numbers:
        """Return the values of the parameters at a point (k,), in their units."""
        return values_at(self.parameters, point)

    def of_slips(self, point: Numbers, slips: Sequence[MeasuredSlip], telling: bool = False) -> Numbers:
        """Return the residuals of the figures of single slips, and of what is known beforehand.

        Of `telling` figures break-away force and time at rest weigh most, as for a model that is not that of the axis.
        """
        values = self.values(point)
        dynamics = self.model.dynamics(values)
        if dynamics is None:
            return np.full((N_TELLING if telling else N_FIGURES) * len(slips) + len(point), np.nan)
        distance = telling_distance if telling else slip_distance
        parts = [distance(simulated_slip(self.model, dynamics, values, slip), slip, self.measurement)
                 for slip in slips]
        return np.concatenate([*parts, self.beforehand(point)])

    def stretches(self, first: int | None = None, stride: int = 1, without: Container[MeasuredMotion] = ()
                  ) -> Stretches:
        """Return the whole run as one stretch; or its `first` slips, and behind them a stretch for each further one.

        The first comes from the start of the run; the others come from measured arrests, but those `without`, and weigh
        as little as these are known.  Only every `stride`-th sample is taken.
        """
        times = self.measurement.times
        every = np.arange(len(times))[stride // 2::stride]
        rests = self._rests[max(first - 1, 0):] if first is not None else ()
        begins: list[MeasuredMotion | None] = [None, *(motion for motion in rests if motion.end < times[-1])]
        parts = []
        for before, after in zip(begins, [*begins[1:], None]):
            begin = 0.0 if before is None else before.end
            end = np.inf if after is None else after.end
            rows = every[(times[every] >= begin) & (times[every] < end)]
            if len(rows) and (before is None or before not in without):
                parts.append(MeasuredStretch(before, begin, rows, instants_of(times[rows] - begin)))
        rows = np.concatenate([part.rows for part in parts])
        own = np.concatenate([np.full(len(part.rows), part.before is None and first != 0) for part in parts])
        filters = self._filters if first is None and stride == 1 else (None,) * len(self._filters)
        factors = tuple(np.sqrt(channel.weights[rows]) / np.where(own, channel.resolution, self.roughly(channel))
                        if one is None else np.full(len(rows), 1.0 / one.deviation)
                        for one, channel in zip(filters, self.measurement.channels, strict=True))
        targets = tuple(channel.values[rows] * factor
                        for channel, factor in zip(self.measurement.channels, factors, strict=True))
        return Stretches(tuple(parts), rows, targets, factors, filters)

    def with_inputs_read_again(self, random: np.random.Generator) -> 'FitProblem':
        """Return the problem with other readings of the same inputs."""
        again = copy(self)
        again.model = self.model.with_inputs_read_again(random)
        return again

    def roughly(self, channel: Channel) -> float:
        """Return the standard deviation of a channel where a stretch begins from a measured arrest."""
        ways = [abs(motion.stop - motion.start) for motion in self.motions]
        size = float(np.median(ways)) if channel.name == 'position' and ways else 0.1 * float(np.ptp(channel.values))
        return max(channel.resolution, _ROUGH * size)

    def of_stretches(self, point: Numbers, stretches: Stretches) -> Numbers:
        """Return the weighted residuals of the samples of stretches, and of what is known beforehand."""
        fitted = self.fitted(point, stretches)
        if fitted is None:
            return np.full(len(stretches.rows) * len(stretches.targets) + len(point), np.nan)
        parts = [target - factor * column for target, factor, column in zip(stretches.targets, stretches.factors,
                                                                            fitted, strict=True)]
        parts = [part if one is None else one.weighted(part)
                 for one, part in zip(stretches.filters, parts, strict=True)]
        return np.concatenate([*parts, self.beforehand(point)])

    def of_run(self) -> Residuals:
        """Return the residuals of the whole run, as a function of a point (k,)."""
        return partial(self.of_stretches, stretches=self.stretches())

    def mean_squares(self, point: Numbers, stretches: Stretches) -> Numbers:
        """Return the mean square of the weighted residuals of each stretch."""
        squares = self.of_stretches(point, stretches)[:-len(point)].reshape(len(stretches.targets), -1)**2
        starts = np.cumsum([0, *(len(part.rows) for part in stretches.parts[:-1])])
        return np.asarray([part.mean() for part in np.split(squares, starts[1:], axis=1)])

    def fitted(self, point: Numbers, stretches: Stretches) -> list[Numbers] | None:
        """Return what the sensors would have measured, (n,) for each channel; None where there is no motion."""
        values = self.values(point)
        dynamics = self.model.dynamics(values)
        if dynamics is None:
            return None
        names = [channel.name for channel in self.measurement.channels]
        delays = [self.model.delay(values, name) for name in names]
        columns: list[list[Numbers]] = [[] for _ in names]
        for stretch in stretches.parts:
            initial = self.model.state_after(stretch.before, dynamics, values)
            rows = {delay: self.model.samples(dynamics, stretch.begin, initial, stretch.at, delay)
                    for delay in sorted({*delays})}
            for name, delay, column in zip(names, delays, columns, strict=True):
                if (own := rows[delay]) is None:
                    return None
                column.append(own[:, OUTPUT_PLACES[name]])
        found = []
        for name, column in zip(names, columns, strict=True):
            offset, scale = self.model.gain(values, name)
            whole = np.concatenate(column)
            found.append(whole if (offset, scale) == (0.0, 1.0) else offset + scale * whole)
        return found

    def beforehand(self, point: Numbers) -> Numbers:
        """Return the residuals of what is known beforehand (k,): the prior of each parameter, or a loose one.

        The stretch at the start is known by the drive force that was measured then.
        """
        found = []
        for one, number, begin, width in zip(self.parameters, point, self.start, self.widths, strict=True):
            mean, spread = one.prior or (begin, _LOOSE * width)
            found.append((number - mean) / spread)
        if self._start_force is not None and self._is_stretch.any():
            off = self.model.start_force(self.values(point)) - self._start_force.value
            return np.where(self._is_stretch, off / self._start_force.deviation, found)
        return np.array(found)

    def tied(self, point: Numbers) -> Numbers:
        """Return a point (k,) with the stretch at the start, if it is free, that the measured force says."""
        if self._start_force is None or not self._is_stretch.any():
            return point
        values, k = self.values(point), int(self._is_stretch.argmax())
        force = self.model.start_force(values)
        of_one = self.model.start_force(values + self._is_stretch) - force   # of 1 m: it is linear
        one, found = self.parameters[k], point.copy()
        found[k] = one.inner(min(max(values[k] + (self._start_force.value - force) / of_one, one.low), one.high))
        return found

    def information_beforehand(self) -> Numbers:
        """Return JᵀJ (k, k) of `beforehand`, diagonal, but for what was measured."""
        spreads = [_LOOSE * width if one.prior is None else one.prior[1]
                   for one, width in zip(self.parameters, self.widths, strict=True)]
        return np.diag(np.where(self._is_stretch, 0.0, 1.0 / np.array(spreads)**2))
