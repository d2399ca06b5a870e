# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The residuals of an identification: of single slips, of stretches between measured arrests, and of the whole run."""

from collections.abc import Container, Mapping, Sequence
from copy import copy
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..axis import CompliantContact, InitialState
from ..core.arrays import Numbers
from ..core.time_grid import Instants
from ..core.types import EventKind
from ..scene.build import Dynamics
from .axis_model import OUTPUT_PLACES, AxisModel
from .direct import (
    FORCE_DELAY,
    DirectMotion,
    MeasuredBreakAway,
    direct_drive,
    direct_motion,
    force_noise_of,
    sliding_motion,
    static_apart,
)
from .force_noise import (
    ERRORS,
    BreakAwayNoise,
    NoiseFilter,
    corners_of,
    filters_of,
    unknown,
    white_of,
    with_static_times,
)
from .free_parameters import FreeParameter, Region, region_of, values_at
from .least_squares import STEP, Residuals, square_cost
from .motions import MeasuredMotion, ends_in_rest, has_break_away, still_rests, stops_of, track_of
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
_BEFORE = 5      # readings before a rest, which in the simulation may come a little earlier
_MOST = 3.0      # standard deviations of a speed that noise of a force has made
# periods from the last reading of a rest to the times that are tried for a break-away, and from the best to others
_NEAR, _NEARER = np.linspace(-20.0, 2.0, 45), np.linspace(-0.5, 0.5, 21)
_APART, _TINY = 0.2, 1e-300   # of a period, for a derivative
_FINE, _TURNS = 0.05, 4       # of a period, the last steps of these times; at most so many of Newton's beyond
_CREEPS = 1e-9   # m/s: a slider that has just broken away
_BELOW = 1.0 - 1e-12   # of the force: so much the contact held
_LEAST_FORCE = 1e-6   # of the largest force: no break-away is known better
_WORSE = 1.3     # times what is known of a force and a time: parabolas, and times, are chosen by the readings
_EVEN = 12.0**0.5   # the standard deviation of what is anywhere in a step is the step over that
_ASIDE = 8.0     # times the median of how far break-aways are off, or what is known: one further off is of no rest
_STRETCH = 'initial.stretch'
_STEP = 0.02   # of the logarithm of a mass: how far noise of the force moves it is taken in such steps
_LOOSE = 2.0   # ranges: the standard deviation of a weak prior, which holds what the data do not determine


class BreakAway(NamedTuple):
    """A break-away at a `time` (s) from a measured rest at a `place`, after the motion `before` (None: the run begins).

    The slider moves in a `direction` (1 or −1) up to the row `end`; `first` is a row in the rest, which began `since` a
    time and shows up to the `last` one (s).  The time has a standard `deviation`, s.
    """

    before: MeasuredMotion | None
    first: int
    end: int
    since: float
    last: float
    place: float
    direction: float
    time: float
    deviation: float = 0.0


class MeasuredStretch(NamedTuple):
    """Samples from a measured arrest on (None: from the start of the run), s: their `rows`, and when after it.

    One that begins with a `break_away` is simulated up to the next rest, in fewer rows, and holds its place there.
    """

    before: MeasuredMotion | None
    begin: float
    rows: Rows
    at: Instants
    break_away: BreakAway | None = None


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
        readings = measurement.force_readings if model.is_pushed else None
        self._corners = corners_of(readings.values if readings else np.zeros(0), self._force_noise)
        yields, self._noisy_step = isinstance(model.scene.axis.contact, CompliantContact), _NOISY_STEP
        self._break_aways = self._measured_break_aways() if model.is_pushed and not yields else ()
        self._static_deviations: Numbers = np.zeros(0)   # of their coefficients, where static friction is free
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

    def _measured_break_aways(self) -> tuple[BreakAway, ...]:
        """Return the break-aways from rests that the position shows.

        The motion after it counts as long as it is so fast that noise of the force cannot have brought the simulated
        one to rest before.
        """
        channel, times = self.measurement.channel('position'), self.measurement.times
        rests, ends = still_rests(self.measurement, self.motions)
        speeds = np.abs(np.interp(times, self.track.times, self.track.velocity))
        step = _MOST * self._force_noise / self._mass * self.measurement.period
        found: list[BreakAway] = []
        for before, motion, rest, over in zip((None, *self.motions), self.motions, rests, ends):
            begin = rest.last if rest else found[-1].first if found else 0
            fast = np.flatnonzero(speeds[begin:over] > step * (over - begin)**0.5)
            end = begin + min(int(fast[-1]) if len(fast) else 0, over - begin - _BEFORE)
            if rest is None or channel is None or (before is None and self._starts_in_motion):
                found[-1:] = [one._replace(end=end) for one in found[-1:]]   # the one before goes on
            else:
                found.append(BreakAway(before, rest.first, max(end, rest.last), times[rest.since].item(),
                                       times[rest.last].item(), rest.place, motion.direction, times[rest.last].item()))
        return tuple(found)

    @property
    def steps(self) -> Numbers:
        """The steps (k,) of derivatives: where noise of the input decides when it breaks away, as long as that noise.

        Between two readings the break-away does not move with its limit, and then it goes to another reading.
        """
        is_noisy = self.model.is_pushed and not self._break_aways
        return np.array([self._noisy_step if is_noisy and one.name.startswith(_STATIC) else STEP
                         for one in self.parameters])

    def take_input_noise_of(self, values: Numbers) -> bool:
        """Take the noise of a measured force as it moves the mass of these values, in steps; return if that is new."""
        dynamics = self.model.dynamics(values)
        if not self.model.is_pushed or dynamics is None:
            return False
        was, self._mass = self._mass, float(np.exp(_STEP * np.round(np.log(dynamics.axis.mass) / _STEP)))
        parts = [slice(one.first, one.end) for one in self._break_aways]
        if parts and self._starts_in_motion:
            parts.insert(0, slice(0, parts[0].start))
        self._filters = filters_of(self.measurement, self._force_noise, self._mass, self._stops,
                                   self._starts_in_motion, parts, self._corners)
        if self._break_aways:
            timed = [self._timed(one, dynamics, values) for one in self._break_aways]
            self._break_aways = tuple(one for one, _ in timed)
            self._filters = tuple(one and one._replace(break_aways=tuple(noise for _, of in timed for noise in of[k]))
                                  for k, one in enumerate(self._filters))
            self._static_deviations = self._deviations_of_static(dynamics, values)
        else:
            self._filters = self._of_errors(dynamics, values)
        return self._mass != was or any(one is not None and one.break_aways for one in self._filters)

    def _of_errors(self, dynamics: Dynamics, values: Numbers) -> tuple[NoiseFilter | None, ...]:
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

    def _timed(self, one: BreakAway, dynamics: Dynamics, values: Numbers
               ) -> tuple[BreakAway, list[tuple[BreakAwayNoise, ...]]]:
        """Return a break-away at the time that the positions after it say, and what is unknown of it in each channel.

        The time is the mean of all that explain them, each as likely as it is: where the force is hardly larger than
        kinetic friction, a wide range of times does.
        """
        period, rows, channels = self.measurement.period, slice(one.first, one.end), self.measurement.channels
        plain = [of and of.from_row(rows) for of in self._filters]
        places = [of and of.weighted(np.full(one.end - one.first, float(channel.name == 'position'))) / of.deviation
                  for of, channel in zip(plain, channels, strict=True)]
        filters = [of and of._replace(break_aways=() if place is None else (unknown(0, place),))
                   for of, place in zip(plain, places, strict=True)]

        def off(time: float, filters: Sequence[NoiseFilter | None] = filters) -> list[Numbers]:
            part = self._part(one._replace(time=time), rows.stop)
            columns = self._columns(part, dynamics, values) or [channel.values[rows] for channel in channels]
            return [np.zeros(len(part.rows)) if of is None else
                    of.weighted(channel.values[rows] - column) / of.deviation
                    for of, channel, column in zip(filters, channels, columns, strict=True)]

        kinetic = dynamics.axis.friction.along(one.direction).kinetic.coefficients[0] * dynamics.axis.normal_force
        costs: dict[float, float] = {}
        best = one.last
        for near in (_NEAR, _NEARER):
            times = [float(best + step * period) for step in near]
            costs |= {time: square_cost(np.concatenate(off(time))) for time in times
                      if time >= 0.0 and one.direction * dynamics.force.value_at(time) > kinetic}
            best = min(costs, key=costs.__getitem__, default=best)
        time, deviation = _mean(costs) if len(costs) > 1 else (best, period)
        for _ in range(_TURNS):   # a time that is known better than the grid is fine
            later, here = max(deviation, _APART * period), off(time)
            ways = [(after - own) / later for own, after in zip(here, off(time + later), strict=True)]
            if deviation >= _FINE * period:
                break
            way, left = np.concatenate(ways), np.concatenate(here)
            nearer = time - float(way @ left) / max(square_cost(way), _TINY)
            if not square_cost(np.concatenate(off(nearer))) < square_cost(left):
                break
            time = nearer
        shift = sum(float(place @ here) / max(square_cost(place), _TINY)
                    for place, here in zip(places, off(time, plain), strict=True) if place is not None)
        return (one._replace(time=time, place=one.place + shift, deviation=deviation),
                [() if place is None else (unknown(one.first, place), unknown(one.first, way))
                 for way, place in zip(ways, places, strict=True)])

    def _part(self, one: BreakAway, until: int) -> MeasuredStretch:
        """Return the stretch from a rest on, up to a row."""
        times = self.measurement.times
        rows = np.arange(one.first, until)
        moving = times[one.first:min(max(one.end, one.first + 1), until)]
        return MeasuredStretch(one.before, one.time, rows, instants_of(moving - times[one.first]), one)

    def _static_coefficients(self, dynamics: Dynamics) -> list[MeasuredBreakAway]:
        """Return what each break-away took of the force on the slider, over the normal force."""
        axis, load, found = dynamics.axis, dynamics.load, []
        for one in self._break_aways:
            rest = one.time - one.since + (dynamics.initial.rest_time if one.before is None else 0.0)
            normal = axis.normal_force + (load.value_at(one.time) if load else 0.0)
            found.append(MeasuredBreakAway(rest, one.direction * dynamics.force.value_at(one.time) / normal,
                                           one.direction > 0.0))
        return found

    def _deviations_of_static(self, dynamics: Dynamics, values: Numbers) -> Numbers:
        """Return the standard deviations of the coefficients that break-aways took; none where that is not sought.

        A force that a controller holds, as one that acts late may be, breaks the slider away at one of its steps; a
        line through the readings does anywhere in between.  Coefficients that scatter by more are known less well by
        as much (Birge's ratio).  One far from most does not count: the slider crept there, and did not rest.
        """
        deviations, period, readings = (self.measurement.force_deviations, self.measurement.period,
                                        self.measurement.force_readings)
        if deviations is None or readings is None or not any(one.name.startswith(_STATIC) for one in self.parameters):
            return np.zeros(0)
        times = np.array([one.time for one in self._break_aways])
        steps = np.array([dynamics.force.value_at(time) - dynamics.force.value_at(max(time - period, 0.0))
                          for time in times.tolist()])
        noise = np.interp(times - self.model.delay(values), self.measurement.times, deviations)
        late = steps / period * np.array([one.deviation for one in self._break_aways])
        is_late = any(one.name == FORCE_DELAY for one in self.parameters)
        found = np.hypot(_WORSE * np.hypot(noise, late), steps / _EVEN if is_late else 0.0)
        least = _LEAST_FORCE * float(np.abs(readings.values).max())
        found = np.maximum(found, least) / dynamics.axis.normal_force
        apart = static_apart(dynamics, self._static_coefficients(dynamics))
        aside = np.abs(apart - np.median(apart))
        counts = aside <= _ASIDE * np.maximum(found, np.median(aside))
        found = np.where(counts, found, np.inf)
        off = (apart - np.average(apart, weights=found**-2.0)) / found
        return np.asarray(found * max(square_cost(off) / max(np.count_nonzero(counts) - 1, 1), 1.0)**0.5)

    def _of_static(self, values: Numbers) -> Numbers:
        """Return by how much break-aways took more than static friction, in standard deviations."""
        dynamics = self.model.dynamics(values) if len(self._static_deviations) else None
        if dynamics is None:
            return np.full(len(self._static_deviations), np.nan)
        return static_apart(dynamics, self._static_coefficients(dynamics)) / self._static_deviations

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
        as little as these are known.  Only every `stride`-th sample is taken.  Under a measured force that drives the
        slider by itself the whole run is one stretch for each measured break-away.
        """
        times = self.measurement.times
        if first is None and stride == 1 and self._break_aways and any(self._filters):
            return self._of_break_aways()
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

    def _of_break_aways(self) -> Stretches:
        """Return the whole run, in stretches that begin with measured break-aways."""
        times, channels = self.measurement.times, self.measurement.channels
        rows = np.arange(len(times))
        begin = self._break_aways[0].first
        parts = [MeasuredStretch(None, 0.0, rows[:begin], instants_of(times[:begin if self._starts_in_motion else 1]))
                 ] if begin else []
        ends = [*(one.first for one in self._break_aways[1:]), len(times)]
        parts += [self._part(one, end) for one, end in zip(self._break_aways, ends, strict=True)]
        factors = tuple(np.sqrt(channel.weights) / channel.resolution if one is None else
                        np.full(len(rows), 1.0 / one.deviation)
                        for one, channel in zip(self._filters, channels, strict=True))
        targets = tuple(channel.values * factor for channel, factor in zip(channels, factors, strict=True))
        return Stretches(tuple(parts), rows, targets, factors, self._filters)

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
        static = self._of_static(self.values(point)) if any(stretches.filters) else np.zeros(0)
        if fitted is None or not np.isfinite(static).all():
            return np.full(len(stretches.rows) * len(stretches.targets) + len(static) + len(point), np.nan)
        parts = [target - factor * column for target, factor, column in zip(stretches.targets, stretches.factors,
                                                                            fitted, strict=True)]
        parts = [part if one is None else one.weighted(part)
                 for one, part in zip(stretches.filters, parts, strict=True)]
        return np.concatenate([*parts, static, self.beforehand(point)])

    def of_channels(self, point: Numbers, stretches: Stretches) -> Numbers:
        """Return the weighted residuals (c, n) of the samples of stretches, those of each channel by themselves."""
        count = len(stretches.targets) * len(stretches.rows)
        return self.of_stretches(point, stretches)[:count].reshape(len(stretches.targets), -1)

    def of_run(self) -> Residuals:
        """Return the residuals of the whole run, as a function of a point (k,)."""
        return partial(self.of_stretches, stretches=self.stretches())

    def mean_squares(self, point: Numbers, stretches: Stretches) -> Numbers:
        """Return the mean square of the weighted residuals of each stretch."""
        squares = self.of_channels(point, stretches)**2
        starts = np.cumsum([0, *(len(part.rows) for part in stretches.parts[:-1])])
        return np.asarray([part.mean() for part in np.split(squares, starts[1:], axis=1)])

    def fitted(self, point: Numbers, stretches: Stretches) -> list[Numbers] | None:
        """Return what the sensors would have measured, (n,) for each channel; None where there is no motion."""
        values = self.values(point)
        dynamics = self.model.dynamics(values)
        if dynamics is None:
            return None
        columns = [self._columns(stretch, dynamics, values) for stretch in stretches.parts]
        if any(column is None for column in columns):
            return None
        return [np.concatenate(column) for column in zip(*columns, strict=True)]

    def _columns(self, stretch: MeasuredStretch, dynamics: Dynamics, values: Numbers) -> list[Numbers] | None:
        """Return what the sensors would have measured of a stretch, (n,) for each channel; None without a motion."""
        late, begin = 0.0, stretch.begin
        held: float | None = None
        if (start := stretch.break_away) is None:
            initial = self.model.state_after(stretch.before, dynamics, values)
        else:
            offset, scale = self.model.gain(values, 'position')
            late = start.time - float(self.measurement.times[start.first])
            friction = dynamics.axis.friction.along(start.direction)
            held = _BELOW * start.direction * dynamics.force.value_at(begin) / dynamics.axis.normal_force
            if friction.excess is None or held < friction.kinetic.coefficients[0]:
                held = None
            velocity = start.direction * _CREEPS if held is None else 0.0
            initial = InitialState((start.place - offset) / scale, velocity, 0.0)
        columns: list[Numbers] = []
        rows: dict[float, Numbers | None] = {}
        for channel in self.measurement.channels:
            delay = late + self.model.delay(values, channel.name)
            if delay not in rows:
                rows[delay] = self.model.samples(dynamics, begin, initial, stretch.at, delay, held)
            if (own := rows[delay]) is None:
                return None
            column, (offset, scale) = own[:, OUTPUT_PLACES[channel.name]], self.model.gain(values, channel.name)
            if len(column) < len(stretch.rows):   # it rests
                rest = column[-1] if channel.name == 'position' else 0.0
                column = np.append(column, np.full(len(stretch.rows) - len(column), rest))
            columns.append(column if (offset, scale) == (0.0, 1.0) else offset + scale * column)
        return columns

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


def _mean(costs: Mapping[float, float]) -> tuple[float, float]:
    """Return mean and standard deviation of numbers, of which each has a cost: minus twice its log-likelihood."""
    numbers = np.array(sorted(costs))
    cost = np.array([costs[number] for number in numbers.tolist()])
    likely = np.exp(-0.5 * (cost - cost.min())) * np.gradient(numbers)
    mean = float(numbers @ likely / likely.sum())
    return mean, float(np.sqrt((numbers - mean)**2 @ likely / likely.sum()))
