# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The residuals of an identification: of single slips, of stretches between measured arrests, and of the whole run."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.time_grid import Instants
from .axis_model import PLACES, AxisModel
from .direct_drive import direct_drive
from .free_parameters import FreeParameter
from .motions import MeasuredMotion, ends_in_rest, track_of
from .readings import Channel, SensorReadings, instants_of
from .slip_features import N_FIGURES, MeasuredSlip, measured_slips, simulated_slip, slip_distance

Numbers = NDArray[np.float64]
Rows = NDArray[np.intp]

_ROUGH = 0.02  # of a slip: so well the motion after a measured arrest is known
_LOOSE = 2.0   # ranges: the standard deviation of a weak prior, which holds what the data do not determine


class MeasuredStretch(NamedTuple):
    """Samples from a measured arrest on (None: from the start of the run), s: their `rows`, and when after it."""

    before: MeasuredMotion | None
    begin: float
    rows: Rows
    at: Instants


class Stretches(NamedTuple):
    """Stretches one after the other: all their `rows`, and of each channel the measured values times `factors`.

    A factor is one over the standard deviation, so that a difference becomes a residual.
    """

    parts: tuple[MeasuredStretch, ...]
    rows: Rows
    targets: tuple[Numbers, ...]
    factors: tuple[Numbers, ...]


class FitProblem:
    """What is sought, from which data; a point is an array (k,) of what the fit works on, one for each parameter."""

    def __init__(self, model: AxisModel, parameters: Sequence[FreeParameter], measurement: SensorReadings,
                 motions: Sequence[MeasuredMotion]) -> None:
        self.model, self.parameters, self.measurement = model, tuple(parameters), measurement
        self.motions = tuple(motions)
        drive = model.drive_of(np.array([one.start for one in parameters]))
        self._rests = ends_in_rest(motions, track_of(measurement, drive), drive)
        rests = {id(motion) for motion in self._rests}
        self.slips = measured_slips(motions, measurement)
        self.clear_slips = [slip for slip in self.slips if slip.before is None or id(slip.before) in rests]
        self.start = np.array([one.inner(one.start) for one in parameters])
        self.low = np.array([one.inner(one.low) for one in parameters])
        self.high = np.array([one.inner(one.high) for one in parameters])

    def with_direct(self, point: Numbers) -> Numbers:
        """Return a point (k,) with what the measured force says by itself of the drive, within the ranges."""
        found = direct_drive(self.model, self.values(point), self.measurement)
        point = point.copy()
        for k, one in enumerate(self.parameters):
            if one.name in found:
                point[k] = one.inner(min(max(found[one.name], one.low), one.high))
        return point

    def values(self, point: Numbers) -> Numbers:
        """Return the values of the parameters at a point (k,), in their units."""
        return np.array([one.outer(number) for one, number in zip(self.parameters, point.tolist(), strict=True)])

    def of_slips(self, point: Numbers, slips: Sequence[MeasuredSlip]) -> Numbers:
        """Return the residuals of the figures of single slips, and of what is known beforehand."""
        values = self.values(point)
        dynamics = self.model.dynamics(values)
        if dynamics is None:
            return np.full(N_FIGURES * len(slips) + len(point), np.nan)
        parts = [slip_distance(simulated_slip(self.model, dynamics, values, slip), slip, self.measurement)
                 for slip in slips]
        return np.concatenate([*parts, self.beforehand(point)])

    def stretches(self, first: int | None = None, stride: int = 1) -> Stretches:
        """Return the whole run as one stretch; or its `first` slips, and behind them a stretch for each further one.

        The first comes from the start of the run; the others come from measured arrests, and weigh as little as these
        are known.  Only every `stride`-th sample is taken.
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
            if len(rows):
                parts.append(MeasuredStretch(before, begin, rows, instants_of(times[rows] - begin)))
        rows = np.concatenate([part.rows for part in parts])
        own = np.concatenate([np.full(len(part.rows), part.before is None and first != 0) for part in parts])
        factors = tuple(np.sqrt(channel.weights[rows]) / np.where(own, channel.resolution, self._roughly(channel))
                        for channel in self.measurement.channels)
        targets = tuple(channel.values[rows] * factor
                        for channel, factor in zip(self.measurement.channels, factors, strict=True))
        return Stretches(tuple(parts), rows, targets, factors)

    def _roughly(self, channel: Channel) -> float:
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
        return np.concatenate([*parts, self.beforehand(point)])

    def fitted(self, point: Numbers, stretches: Stretches) -> list[Numbers] | None:
        """Return what the sensors would have measured, (n,) for each channel; None where there is no motion."""
        values = self.values(point)
        dynamics = self.model.dynamics(values)
        if dynamics is None:
            return None
        names = [channel.name for channel in self.measurement.channels]
        columns: list[list[Numbers]] = [[] for _ in names]
        for stretch in stretches.parts:
            initial = dynamics.initial if stretch.before is None else self.model.state_after(stretch.before, dynamics,
                                                                                            values)
            rows = self.model.samples(dynamics, stretch.begin, initial, stretch.at)
            if rows is None:
                return None
            for name, column in zip(names, columns, strict=True):
                column.append(rows[:, PLACES[name]])
        found = []
        for name, column in zip(names, columns, strict=True):
            offset, scale = self.model.gain(values, name)
            whole = np.concatenate(column)
            found.append(whole if (offset, scale) == (0.0, 1.0) else offset + scale * whole)
        return found

    def beforehand(self, point: Numbers) -> Numbers:
        """Return the residuals of what is known beforehand (k,): the prior of each parameter, or a loose one."""
        found = []
        for one, number, begin, low, high in zip(self.parameters, point, self.start, self.low, self.high, strict=True):
            mean, spread = one.prior or (begin, _LOOSE * (high - low))
            found.append((number - mean) / spread)
        return np.array(found)

    def information_beforehand(self) -> Numbers:
        """Return JᵀJ (k, k) of `beforehand`, diagonal."""
        spreads = [_LOOSE * (high - low) if one.prior is None else one.prior[1]
                   for one, low, high in zip(self.parameters, self.low, self.high, strict=True)]
        return np.diag(1.0 / np.array(spreads)**2)
