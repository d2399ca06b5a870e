# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that readings say by themselves, before any fit: those of friction, of the drive, and of a free slider.

A measured force that drives the slider by itself shows its mass and friction:
F = m ẍ + N mu_k(|ẋ|) sign ẋ while it slides, and F = N mu_s sign F where it breaks away.
Velocity and acceleration are those of parabolas through the position.  So is the force, through its integral over the
integral: a step of it spreads as the acceleration that it makes.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.input_profile import InputProfile
from ..scene.build import Dynamics
from .axis_model import AxisModel
from .free_parameters import FreeParameter, Region, values_at
from .least_squares import minimise
from .motions import track_of
from .readings import SensorReadings, noise_of, quantum_of, travelled
from .slip_features import MeasuredSlip, rest_force

# Static friction from the measured break-aways alone: the force that each one took, over the normal force.

_SHARE = 0.02   # of a coefficient: so well it is known


class MeasuredBreakAway(NamedTuple):
    """A measured break-away: the `rest` before it, s, the `coefficient` of friction, and whether it is forwards."""

    rest: float
    coefficient: float
    forwards: bool


def friction_at_break_aways(model: AxisModel, values: Numbers, measurement: SensorReadings,
                            slips: Sequence[MeasuredSlip]) -> list[MeasuredBreakAway]:
    """Return the break-aways of slips, of which the force was measured or follows from the stretch of the spring.

    A coefficient below 0 is that of no break-away: with these values the force is against the motion.
    """
    dynamics = model.dynamics(values)
    if dynamics is None:
        return []
    initial, axis = dynamics.initial, dynamics.axis
    zero, gain = model.gain(values, 'drive_force')
    offset, scale = model.gain(values, 'position')
    found = []
    for slip in slips:
        begin, direction = slip.motion.begin, slip.motion.direction
        rest = begin - slip.rest_begin + (initial.rest_time if slip.before is None else 0.0)
        force = (rest_force(measurement, begin, slip.rest_begin, begin) - zero) / gain
        if np.isnan(force):
            gone = float(travelled(dynamics.drive, np.array([begin]))[0])
            stretch = initial.stretch + gone - ((slip.motion.start - offset) / scale - initial.position)
            force = axis.drive_stiffness * stretch + axis.drive_damping * dynamics.drive.value_at(begin)
        normal = axis.normal_force + (dynamics.load.value_at(begin) if dynamics.load else 0.0)
        coefficient = direction * (force + dynamics.force.value_at(begin)) / normal
        found.append(MeasuredBreakAway(rest, coefficient, direction > 0.0))
    return found


def static_residuals(model: AxisModel, measured: Sequence[MeasuredBreakAway], values: Numbers) -> Numbers:
    """Return by how much measured coefficients are larger than those of the law with trial values, in what is known."""
    dynamics = model.dynamics(values)
    if dynamics is None:
        return np.full(len(measured), np.nan)
    right, apart = np.array([one.coefficient for one in measured]), static_apart(dynamics, measured)
    return np.asarray(apart / (_SHARE * np.maximum(np.abs(right), _SHARE * (right - apart))))


def static_apart(dynamics: Dynamics, measured: Sequence[MeasuredBreakAway]) -> Numbers:
    """Return by how much measured coefficients (n,) are larger than those of the law."""
    friction = dynamics.axis.friction
    sides = {True: friction.static, False: (friction.backward or friction).static}
    return np.array([one.coefficient - sides[one.forwards].coefficient(one.rest) for one in measured])


_CURVED = 720.0**0.5   # of the second derivative of a parabola through n readings: σ times that over n^2.5 periods²
_FEWEST, _MOST = 5, 0.01   # readings in a parabola, and as a share of the run
_STILL = 0.03         # of the highest speed: slower is no sure slip
_WELL = 0.1           # of a range: a standard deviation, beyond which a parameter is not taken
_TAME = 3.0           # of the residual of a break-away: beyond, its size counts, for not each is one
FORCE_DELAY = 'sensor.external_force.delay'
_LONGEST, _FINE = 10, 8   # periods, and steps in each
_SHOWN = 3         # periods: so far from the best a delay must be worse for sure, of a motion that shows it
_SURE = 25.0       # of a logarithm of the likelihood, twice
_ENOUGH = 50          # readings
_SPEEDS = np.linspace(0.0, 1.0, 9)**2   # quantiles, between which friction is a line: most of them slow


class SlidingMotion(NamedTuple):
    """Velocity (m/s) and acceleration (m/s²) at the `rows` (n,) of even times in which the slider surely slides.

    `force` (N) is at all of these times, `noise` the standard deviation of one reading of it.  The `length` of the
    filter is in readings: so many in a row say as much as one.
    """

    velocity: Numbers
    acceleration: Numbers
    rows: NDArray[np.intp]
    force: Numbers
    noise: float
    period: float
    length: int

    def force_after(self, delay: float) -> Numbers:
        """Return the force (n,) that acts in these rows when it acts so much later (s) than it was read."""
        return np.asarray(np.interp(self.rows - delay / self.period, np.arange(len(self.force)), self.force))


def force_noise_of(measurement: SensorReadings) -> float:
    """Return the standard deviation of the noise in the measured force on the slider, N."""
    if measurement.force_noise is not None or measurement.force_readings is None:
        return measurement.force_noise or 0.0
    values = measurement.force_readings.values
    return noise_of(values, quantum_of(values))


def sliding_motion(measurement: SensorReadings, mass: float) -> SlidingMotion | None:
    """Return the motion without rests and turns; None without a force, or where there is too little of it."""
    channel = measurement.channel('position')
    if channel is None or measurement.force is None:
        return None
    from scipy.signal import savgol_filter  # takes a while, and only a measured force needs it

    count = max(round(float(np.ptp(measurement.times)) / measurement.period), 3) + 1
    times = np.linspace(measurement.times[0], measurement.times[-1], count)
    position = np.interp(times, measurement.times, channel.values)
    noise = force_noise_of(measurement)
    length = _length(channel.resolution, noise / mass, measurement.period, count)
    if length >= count:
        return None
    velocity, acceleration = (savgol_filter(position, length, 2, deriv, measurement.period) for deriv in (1, 2))
    force = savgol_filter(_integrated(measurement.force, times), length, 2, 2, measurement.period)
    slow = np.abs(velocity) < _STILL * float(np.abs(velocity).max())
    clear = ~np.convolve(slow | (np.diff(np.sign(velocity), prepend=0.0) != 0.0), np.ones(length), 'same').astype(bool)
    if int(clear.sum()) < _ENOUGH:
        return None
    return SlidingMotion(velocity[clear], acceleration[clear], np.flatnonzero(clear), force, max(noise, 1e-300),
                         measurement.period, length)


def with_delay(parameters: tuple[FreeParameter, ...], measurement: SensorReadings, mass: float
               ) -> tuple[tuple[FreeParameter, ...], SensorReadings]:
    """Return the parameters with the delay of the measured force among them, and a note, unless there is none for sure.

    A force that a controller holds up to its next reading acts half a period later than the line through the readings;
    a drive has delays of its own.  The delay is right that leaves least of F = m ẍ + R(|ẋ|) sign ẋ + a constant, all
    fitted, whatever the law of friction.  A motion of one frequency shows none.
    """
    motion = sliding_motion(measurement, mass)
    if motion is None or any(one.name == FORCE_DELAY for one in parameters):
        return parameters, measurement
    delays = measurement.period * np.linspace(-_LONGEST, _LONGEST, 2 * _LONGEST * _FINE + 1)
    left = np.array([_left(motion, float(delay)) for delay in delays])
    best, none, held = int(left.argmin()), _left(motion, 0.0), _left(motion, 0.5 * measurement.period)
    count = len(motion.rows) / motion.length
    if not _SHOWN * _FINE <= best < len(delays) - _SHOWN * _FINE:
        return parameters, measurement
    is_shown, is_late, is_line = (count * (other / least - 1.0) >= _SURE for other, least in (
        (min(left[best - _SHOWN * _FINE], left[best + _SHOWN * _FINE]), left[best]), (none, left[best]), (held, none)))
    if not is_late and (is_line or not is_shown):
        return parameters, measurement
    delay, most = float(delays[best]), float(delays[-1])
    note = f'the measured force acts {1e3 * delay:.2g} ms after its readings: {FORCE_DELAY} is free, too'
    return ((*parameters, FreeParameter(FORCE_DELAY, 's', delay, -most, most)),
            replace(measurement, notes=(*measurement.notes, note)))


def _left(motion: SlidingMotion, delay: float) -> float:
    """Return the sum of squares that is left of the force; friction is a line through some speeds."""
    speed, force = np.abs(motion.velocity), motion.force_after(delay)
    knots = np.unique(np.quantile(speed, _SPEEDS))
    friction = [np.sign(motion.velocity) * np.interp(speed, knots, one) for one in np.eye(len(knots))]
    terms = np.stack([motion.acceleration, np.ones(len(speed)), *friction], axis=1)
    found, *_ = np.linalg.lstsq(terms, force, rcond=None)
    left = force - terms @ found
    return float(left @ left)


def _integrated(force: InputProfile, times: Numbers) -> Numbers:
    """Return the integral of the integral (n,) of a force that is a line between even times (n,), exactly."""
    impulse, between = travelled(force, times), travelled(force, 0.5 * (times[1:] + times[:-1]))
    return np.append(0.0, np.cumsum((impulse[:-1] + 4.0 * between + impulse[1:]) * np.diff(times) / 6.0))


class DirectMotion(NamedTuple):
    """The `point` (k,) of parameters, as the fit works on them, nearest to the motion; which of them it shows (k,)."""

    point: Numbers
    is_shown: NDArray[np.bool_]


def direct_motion(model: AxisModel, parameters: Sequence[FreeParameter], measurement: SensorReadings,
                  motion: SlidingMotion, slips: Sequence[MeasuredSlip], start: Numbers, region: Region) -> DirectMotion:
    """Return what the sliding motion and the break-aways of slips show of the parameters.

    `start` (k,) and the region are as the fit works on them.  An offset of the force and friction that differs by
    direction do the same while the slider slides; at a break-away they do not.
    """
    spread = np.array([one.width for one in parameters])
    forwards = motion.velocity > 0.0

    def residuals(point: Numbers) -> Numbers:
        values = values_at(parameters, point)
        dynamics = model.dynamics(values)
        if dynamics is None:
            return np.full(len(motion.rows) + len(slips) + len(point), np.nan)
        axis, speed = dynamics.axis, np.abs(motion.velocity)
        needed = axis.mass * motion.acceleration
        for direction, rows in ((1.0, forwards), (-1.0, ~forwards)):
            kinetic = axis.friction.along(direction).kinetic
            at = speed[rows]
            beyond = np.maximum(at - kinetic.velocities[-1], 0.0)
            coefficient = np.interp(at, kinetic.velocities, kinetic.coefficients) + kinetic.end_slope * beyond
            needed[rows] += direction * axis.normal_force * coefficient
        offset, scale = model.gain(values, 'external_force')
        force = (motion.force_after(model.delay(values)) - offset) / scale
        measured = friction_at_break_aways(model, values, measurement, slips)
        return np.concatenate([(needed - force) / motion.noise, _tamed(static_residuals(model, measured, values)),
                               (point - start) / spread])

    found = minimise(residuals, start, region, most=20, tolerance=1e-2)
    deviations = np.sqrt(np.diag(np.linalg.pinv(found.information, hermitian=True)))
    return DirectMotion(found.point, deviations < _WELL * spread)


def _tamed(residuals: Numbers) -> Numbers:
    """Return residuals (n,) of which the squares of large ones rise with their size."""
    return np.asarray(np.sign(residuals) * _TAME * np.sqrt(2.0 * (np.sqrt(1.0 + (residuals / _TAME)**2) - 1.0)))


def _length(position_noise: float, acceleration_noise: float, period: float, count: int) -> int:
    """Return an odd number of readings, in a parabola through which position and force say as much as each other."""
    if acceleration_noise == 0.0:
        return _FEWEST
    length = (_CURVED * position_noise / (period**2 * acceleration_noise))**0.5
    return 2 * int(min(max(length, _FEWEST), max(_MOST * count, _FEWEST)) / 2.0) + 1


# Drive spring and damper from a measured drive force alone: F = c stretch + h (v − ẋ) is linear in both.

_STIFFNESS, _DAMPING = 'axis.drive_stiffness', 'axis.drive_damping'
_WELL_KNOWN = 0.1    # of a number: its standard deviation, beyond which it is not taken


def direct_drive(model: AxisModel, values: Numbers, measurement: SensorReadings) -> dict[str, float]:
    """Return stiffness and damping of the drive, those that a measured force determines; others are as in `values`.

    Nothing without a measured force, or where the inputs are not known.
    """
    force = measurement.channel('drive_force')
    dynamics = model.dynamics(values)
    if force is None or measurement.channel('position') is None or dynamics is None:
        return {}
    track = track_of(measurement, dynamics.drive)
    offset, scale = model.gain(values, 'position')
    gone = travelled(dynamics.drive, track.times)
    position = (track.position - offset) / scale
    stretch = dynamics.initial.stretch + gone - (position - dynamics.initial.position)
    speed = np.gradient(gone, track.times) - track.velocity / scale
    zero, gain = model.gain(values, 'drive_force')
    measured = np.interp(track.times, measurement.times, force.values) - zero
    slopes = np.stack([gain * stretch, gain * speed, np.ones(len(speed))], axis=1)   # the start may be another one
    found, *_ = np.linalg.lstsq(slopes, measured, rcond=None)
    left = measured - slopes @ found
    errors = np.sqrt(np.diag(np.linalg.pinv(slopes.T @ slopes)) * float(left @ left) / len(left))
    return {name: float(value) for name, value, error in zip((_STIFFNESS, _DAMPING), found, errors)
            if value > 0.0 and error < _WELL_KNOWN * value}
