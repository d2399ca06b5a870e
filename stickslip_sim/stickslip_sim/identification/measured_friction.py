# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Friction over speed straight from a measurement: what is left of the forces on the slider while it slips.

    F = F_d + F_e − m ẍ

The drive force is that of its sensor, or of the identified drive spring between measured positions; mass and sensor
errors are the identified ones.  Speed and acceleration are those of polynomials through stretches of the position
(Savitzky and Golay, 1964), a tenth of a slip long, so that noise of the position does not drown them.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ..axis import Axis, Friction
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..figures.slips import SLIP_TIMES, SlipRows, slips_of
from ..plots.characteristics import Band, Bins, KnownFriction, Scatter
from ..runs import Run
from ..scene import Scene
from ..study.points import scene_at
from .identified import FOUND, Estimate, Identification, moved
from .identified_scene import OF_SENSORS

_STRETCH = 0.1      # of a slip
FEWEST_ROWS = 7     # of a stretch
_DEGREE = 3
_SLOWEST = 0.05     # of the highest speed: where a run states no threshold, as of an imported one
_BINS = 24
_IN_A_BIN = 8       # points, or more


class FrictionPoints(NamedTuple):
    """Speeds (m/s, >= 0) and coefficients of all readings within slips."""

    speeds: Numbers
    coefficients: Numbers


class FrictionBins(NamedTuple):
    """Readings by speed: the middle speed of each bin (m/s), the median coefficient, and the quartiles."""

    speeds: Numbers
    medians: Numbers
    low: Numbers
    high: Numbers


NOTHING = FrictionPoints(np.empty(0), np.empty(0))


def friction_points(run: Run, found: Identification, direction: float = 0.0) -> FrictionPoints:
    """Return the friction at each reading within a slip, of both directions (0) or one; nothing without a force."""
    times, drawn = even(corrected(run, found))
    if len(times) < 2 * FEWEST_ROWS:
        return NOTHING
    period = times[1] - times[0]
    rough = motion(drawn, FEWEST_ROWS, period)[0] if 'position' in drawn else drawn['velocity']
    slips = list(slips_of(rough, threshold_of(run, rough)))
    if not slips:
        return NOTHING
    window = window_of(slips)
    velocity, acceleration = motion(drawn, window, period)
    force = friction_force(drawn, found.scene.axis, velocity, acceleration, window, period)
    if force is None:
        return NOTHING
    rows = np.concatenate([np.arange(slip.first + window // 2, slip.end - window // 2) for slip in slips])
    loads = loads_at(found, times[rows])
    kept = (loads > 0.0) & (velocity[rows] * direction >= 0.0)
    rows, loads = rows[kept], loads[kept]
    return FrictionPoints(np.abs(velocity[rows]), np.sign(velocity[rows]) * force[rows] / loads)


def loads_at(found: Identification, times: Numbers) -> Numbers:
    """Return the normal force on the slideway at times of the measurement (n,), N."""
    if found.scene.normal_load is None:
        return np.full(len(times), found.scene.axis.normal_force)
    profile = found.scene.normal_force
    return np.array([profile.value_at(time) for time in (times - found.shift).tolist()])


def binned(points: FrictionPoints) -> FrictionBins:
    """Return medians and quartiles of the points by speed, in bins with as many points each."""
    speeds, coefficients = points
    count = min(_BINS, len(speeds) // _IN_A_BIN)
    if count < 1:
        return FrictionBins(*[np.empty(0)] * 4)
    order = np.argsort(speeds)
    parts = np.array_split(order, count)
    quartiles = np.array([np.percentile(coefficients[part], (25.0, 50.0, 75.0)) for part in parts])
    return FrictionBins(np.array([np.median(speeds[part]) for part in parts]), quartiles[:, 1], quartiles[:, 0],
                        quartiles[:, 2])


def corrected(run: Run, found: Identification) -> dict[str, Numbers]:
    """Return the columns that were measured without the sensor errors that were found: (measured − offset) / scale."""
    values = found.values
    columns: dict[str, Numbers] = {}
    for name, column in run.samples.items():
        if np.isfinite(column).any():
            offset = values.get(f'sensor.{name}.offset', 0.0)
            columns[name] = (np.asarray(column) - offset) / values.get(f'sensor.{name}.scale', 1.0)
    return columns


def even(columns: Mapping[str, Numbers]) -> tuple[Numbers, dict[str, Numbers]]:
    """Return the columns at even times, as far apart as the readings are in the median."""
    times = columns['time']
    period = float(np.median(np.diff(times)))
    even = times[0] + period * np.arange(int((times[-1] - times[0]) / period) + 1)
    known = {name: np.isfinite(column) for name, column in columns.items()}
    return even, {name: np.interp(even, times[known[name]], column[known[name]]) for name, column in columns.items()
                  if name != 'time'}


def threshold_of(run: Run, velocity: Numbers) -> float:
    """Return the speed that a slip passes, m/s: that of the run, or a share of the highest."""
    stated = getattr(run, 'stick_velocity', None)
    highest = float(np.abs(velocity).max())
    return min(_SLOWEST * highest if stated is None else float(stated), highest / (2.0 * SLIP_TIMES))


def window_of(slips: list[SlipRows]) -> int:
    """Return how many rows a stretch has: an odd number."""
    rows = float(np.median([slip.end - slip.first for slip in slips]))
    return max(FEWEST_ROWS, 2 * int(_STRETCH * rows / 2.0) + 1)


def motion(drawn: Mapping[str, Numbers], window: int, period: float) -> tuple[Numbers, Numbers]:
    """Return speed and acceleration, those of a sensor of their own where there is one."""
    name, first = ('position', 1) if 'position' in drawn else ('velocity', 0)
    return (_smooth(drawn[name], window, first) / period**first,
            _smooth(drawn[name], window, first + 1) / period**(first + 1))


def friction_force(drawn: Mapping[str, Numbers], axis: Axis, velocity: Numbers, acceleration: Numbers, window: int,
                   period: float) -> Numbers | None:
    """Return the friction force, positive against a motion along +x; None where no force is known."""
    if 'friction_force' in drawn:
        return drawn['friction_force']
    if 'drive_force' in drawn:
        drive = drawn['drive_force'] - axis.slideway_damping * velocity
    elif 'drive_position' in drawn and 'position' in drawn:
        feed = axis.feed_share * _smooth(drawn['drive_position'], window, 1) / period
        drive = (axis.drive_stiffness * (drawn['drive_position'] - drawn['position'])
                 + axis.drive_damping * (feed - velocity))
    else:
        return None
    return np.asarray(drive + drawn.get('external_force', 0.0) - axis.mass * acceleration)


def _smooth(values: Numbers, window: int, derivative: int) -> Numbers:
    from scipy.signal import savgol_filter

    return np.asarray(savgol_filter(values, window, _DEGREE, derivative))


# Where in its cycle a reading stands: a share of the time from one measured break-away to the next.

def measured_break_aways(found: Identification) -> Numbers:
    """Return the times of the measured break-aways, s."""
    return np.array([slip.time for slip in found.slips if math.isfinite(slip.time)], dtype=np.float64)


def phases(found: Identification, times: Numbers) -> Numbers:
    """Return the share of the cycle at each time (n,), NaN before the first break-away and after the last."""
    begins = measured_break_aways(found)
    shares = np.full(len(times), np.nan)
    if len(begins) > 1:
        cycle = np.searchsorted(begins, times, side='right') - 1
        inside = (cycle >= 0) & (cycle < len(begins) - 1)
        begin, end = begins[cycle[inside]], begins[cycle[inside] + 1]
        shares[inside] = (times[inside] - begin) / (end - begin)
    return shares


def slip_share(found: Identification) -> float:
    """Return the share of a cycle after which its slip has ended, in the median; 0 where it is not known."""
    begins = measured_break_aways(found)
    sticks = np.array([slip.stick_time for slip in found.slips if math.isfinite(slip.time)], dtype=np.float64)[1:]
    periods = np.diff(begins)
    known = np.isfinite(sticks) & (sticks < periods)
    return float(np.median(1.0 - sticks[known] / periods[known])) if known.any() else 0.0


def usual_cycles(found: Identification, count: int = 2) -> tuple[float, float]:
    """Return from when to when some cycles are that take as long as most do, s; without cycles the last tenth."""
    times, begins = found.channels[0].times, measured_break_aways(found)
    lengths = begins[count:] - begins[:-count]
    if not len(lengths):
        return float(times[-1] - 0.1 * (times[-1] - times[0])), float(times[-1])
    usual = int(np.abs(lengths - np.median(lengths)).argmin())
    margin = 0.05 * lengths[usual]
    return (max(float(begins[usual] - margin), float(times[0])),
            min(float(begins[usual + count] + margin), float(times[-1])))


# The friction that was identified, beside what was measured, as a report shows it.

# The friction curves of an identified scene, and how well the numbers that were found determine them.
#
# The band is that of the linearised curve: 1.96 √(J C Jᵀ), J its derivatives by what was fitted, C their covariance.
# Numbers that the run does not tell are taken as they are.

FrictionCurveOf = Callable[[Scene], Numbers]

_STEP = 0.05        # of a standard deviation
_QUANTILE = 1.959963984540054
_LIMITED = 0.2      # of the value: beyond, a step of a logarithm is no small one


def half_width(found: Identification, curve: FrictionCurveOf) -> Numbers:
    """Return half the width of the 95 % band of a curve that a scene has; 0 where nothing that was found moves it.

    NaN of a model that a test rejects, of whose error nothing is known.
    """
    if not found.fits:
        return np.full_like(curve(found.scene), np.nan)
    free = [k for k, one in enumerate(found.estimates) if _is_known(one)]
    if not free:
        return np.zeros_like(curve(found.scene))
    slopes = np.stack([_slope(found.scene, found.estimates[k], curve) for k in free], axis=-1)
    inner = np.asarray(found.correlation)[np.ix_(free, free)]
    inner = np.where(np.isfinite(inner), inner, np.eye(len(free)))
    return np.asarray(_QUANTILE * np.sqrt(np.maximum(np.einsum('ij,jk,ik->i', slopes, inner, slopes), 0.0)))


def kinetic_of(speeds: Numbers, direction: float = 1.0) -> FrictionCurveOf:
    """Return the curve of kinetic friction over speeds, m/s, in a direction."""
    return lambda scene: np.array([scene.axis.friction.along(direction).kinetic.coefficient(speed)
                                   for speed in speeds.tolist()])


def accelerating_of(speeds: Numbers, rest_time: float, direction: float = 1.0) -> FrictionCurveOf:
    """Return the accelerating branch over speeds, m/s, of a slip after a time at rest, s, in a direction."""
    def curve(scene: Scene) -> Numbers:
        friction = scene.axis.friction.along(direction)
        excess = friction.static.coefficient(rest_time) - friction.kinetic.coefficient(0.0)
        return kinetic_of(speeds, direction)(scene) + max(excess, 0.0) * _shape(friction, speeds.tolist())
    return curve


def static_of(rest_times: Numbers, direction: float = 1.0) -> FrictionCurveOf:
    """Return the curve of static friction over times at rest, s, against a force in a direction."""
    return lambda scene: np.array([scene.axis.friction.along(direction).static.coefficient(time)
                                   for time in rest_times.tolist()])


def _shape(friction: Friction, speeds: Sequence[float]) -> Numbers:
    if friction.excess is None:
        return np.zeros(len(speeds))
    return np.array([friction.excess.fraction(speed) for speed in speeds])


def _is_known(one: Estimate) -> bool:
    return (one.kind == FOUND and not one.name.startswith(OF_SENSORS) and one.name.startswith('friction.')
            and 0.0 < one.standard_deviation < math.inf)


def _slope(scene: Scene, one: Estimate, curve: FrictionCurveOf) -> Numbers:
    """Return the derivative of a curve by a number, times its standard deviation; one-sided at the end of a range."""
    step = _STEP * one.standard_deviation
    if one.logarithmic:
        step = min(step, _LIMITED)
    ends = [(sign * step, curve(other)) for sign in (1.0, -1.0) if (other := _scene_with(scene, one, sign * step))]
    if len(ends) < 2:
        ends.append((0.0, curve(scene)))
    (there, value), (here, other_value) = ends[0], ends[-1]
    return np.asarray((value - other_value) / (there - here) * one.standard_deviation if there != here
                      else np.zeros_like(value))


def _scene_with(scene: Scene, one: Estimate, step: float) -> Scene | None:
    """Return the scene with another value of a number; None where that is none."""
    try:
        return scene_at(scene.values, [one.name], np.array([moved(one, step)]))
    except InputError:
        return None


_CURVE = 160          # points of a curve
_BEYOND = 1.15        # of the fastest reading, and of the longest rest
_TIME_CONSTANTS = 5.0
_SECOND = 1.0         # s, of static friction that does not grow


def known_friction(run: Run, found: Identification) -> dict[str, KnownFriction]:
    """Return what is known of friction by directions: one without a name where both have the same."""
    if len(found.scene.axis.friction.sides) == 1:
        return {'': _in_direction(run, found, 0.0)}
    return {'forward': _in_direction(run, found, 1.0), 'backward': _in_direction(run, found, -1.0)}


def _in_direction(run: Run, found: Identification, direction: float) -> KnownFriction:
    """Return both curves with their bands, those of the scene to start with, and what was measured."""
    points = friction_points(run, found, direction)
    fastest = float(points.speeds.max(initial=0.0)) or _fastest(run)
    speeds = np.linspace(0.0, _BEYOND * fastest, _CURVE, dtype=np.float64)
    rests, forces = _break_aways(found, direction)
    times = np.linspace(0.0, _longest(found, rests), _CURVE, dtype=np.float64)
    kinetic, static = kinetic_of(speeds, direction), static_of(times, direction)
    return KnownFriction(
        Band(speeds, kinetic(found.scene), half_width(found, kinetic)),
        _accelerating(found, speeds, rests, direction),
        Scatter(speeds, kinetic(found.start)), Scatter(*points), Bins(*binned(points)),
        Band(times, static(found.scene), half_width(found, static)), Scatter(times, static(found.start)),
        Scatter(rests, forces), law.scatter.deviation if (law := found.scene.axis.friction.static).scatter else 0.0)


def _accelerating(found: Identification, speeds: Numbers, rests: Numbers, direction: float) -> Band | None:
    if found.scene.axis.friction.excess is None:
        return None
    curve = accelerating_of(speeds, float(np.median(rests)) if len(rests) else math.inf, direction)
    return Band(speeds, curve(found.scene), half_width(found, curve))


def _fastest(run: Run) -> float:
    velocity = run.samples['velocity']
    return float(np.nanmax(np.abs(velocity), initial=0.0)) or 1.0


def _break_aways(found: Identification, direction: float) -> tuple[Numbers, Numbers]:
    """Return times at rest and coefficients of the measured break-aways, of a direction, that have both."""
    slips = [slip for slip in found.slips if math.isfinite(slip.stick_time) and math.isfinite(slip.break_away_force)
             and slip.break_away_force * direction >= 0.0]
    loads = loads_at(found, np.array([slip.time for slip in slips], dtype=np.float64))
    rows = [(slip.stick_time, abs(slip.break_away_force) / load) for slip, load in zip(slips, loads) if load > 0.0]
    rests, forces = np.array(rows, dtype=np.float64).reshape(-1, 2).T
    return rests, forces


def _longest(found: Identification, rests: Numbers) -> float:
    law = found.scene.axis.friction.static
    return max(_TIME_CONSTANTS * law.time_constant, _BEYOND * float(rests.max(initial=0.0))) or _SECOND
