# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The measured run that an identification starts from: channels over time, and the inputs where they were measured."""

import hashlib
import math
from bisect import bisect_right
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.input_profile import InputProfile, Sinusoid
from ..core.time_grid import Instants
from ..recording import MeasuredRun
from ..runs import Run
from ..scene import Scene

# Inputs as they were measured, as profiles for the engine; and profiles from a later time on.

_Place = tuple[float, float]   # s, m

_ROOM = 1.02       # of the resolution: rounding must not bend a straight way
_STRAIGHT = 1e-9   # of the range: a point so near the line between its neighbours says nothing


def profile_through(times: Numbers, values: Numbers, held: bool = False) -> InputProfile:
    """Return the profile that is linear between measured values, or `held` from each to the next.

    It is constant before the first and after the last; straight parts of it are one piece.
    """
    rates = np.zeros(len(times)) if held else np.append(np.diff(values) / np.diff(times), 0.0)
    small = _STRAIGHT * max(float(np.abs(values).max()), 1e-300)
    goes_on = np.abs(values[:-1] + rates[:-1] * np.diff(times) - values[1:]) <= small
    same = np.abs(np.diff(rates)) * np.append(np.diff(times)[1:], 1.0) <= small
    new = np.append(True, ~(goes_on & same))
    starts = times[new]
    starts[0] = 0.0
    if times[0] > 0.0 and rates[0] != 0.0:
        return InputProfile((0.0, *times[new].tolist()), (float(values[0]), *values[new].tolist()),
                            (0.0, *rates[new].tolist()))
    return InputProfile(tuple(starts.tolist()), tuple(values[new].tolist()), tuple(rates[new].tolist()))


def velocity_within(times: Numbers, places: Numbers, half: float) -> InputProfile:
    """Return the velocity of a drive from measured places (m), each right within `half` (m).

    Differences of the readings of an encoder are none of its axis: one step up in 1 ms, none in the next.  The shortest
    way within its resolution is straight where the axis may have moved evenly, and turns as seldom as it can (Davies
    and Kovac 2001).  It cuts the corners of the true way; so the line that turns at the same times and is nearest to
    the readings, by least squares, is taken.
    """
    turns = _turns_within(times, places, half)
    edges = times[turns]
    part = np.clip(np.searchsorted(edges, times, 'right') - 1, 0, len(edges) - 2)
    share = (times - edges[part]) / (edges[part + 1] - edges[part])
    bands = np.zeros((2, len(edges)))     # of the normal equations of a line with given turns
    np.add.at(bands[1], part, (1.0 - share)**2)
    np.add.at(bands[1], part + 1, share**2)
    np.add.at(bands[0], part + 1, share * (1.0 - share))
    right = np.bincount(part, (1.0 - share) * places, len(edges)) + np.bincount(part + 1, share * places, len(edges))
    way = solveh_banded(bands, right)
    velocities = np.diff(way) / np.diff(edges)
    return InputProfile((0.0, *edges[1:-1].tolist()), tuple(velocities.tolist()), (0.0,) * len(velocities))


def _turns_within(times: Numbers, places: Numbers, half: float) -> NDArray[np.intp]:
    """Return the rows at which the shortest way turns, the first and the last row with them."""
    way = [(float(times[0]), float(places[0]))]
    above, below = deque(way), deque(way)
    last = len(times) - 1
    for k, (time, place) in enumerate(zip(times[1:].tolist(), places[1:].tolist()), 1):
        room = _ROOM * half if k < last else 0.0
        _pull(above, below, (time, place + room), 1.0, way)
        _pull(below, above, (time, place - room), -1.0, way)
    rows: NDArray[np.intp] = np.unique([*np.searchsorted(times, [time for time, _ in way]), last])
    return rows


def _pull(own: deque[_Place], other: deque[_Place], place: _Place, side: float, way: list[_Place]) -> None:
    """Stretch one side of the room for the way to a new place; it turns where the other side bars the straight line.

    Both sides begin where the way ends so far.
    """
    while len(own) > 1 and side * (_slope(own[-1], place) - _slope(own[-2], own[-1])) <= 0.0:
        own.pop()
    own.append(place)
    while len(own) == 2 and len(other) > 1 and side * (_slope(own[0], place) - _slope(other[0], other[1])) < 0.0:
        other.popleft()
        way.append(other[0])
        own[0] = other[0]


def _slope(one: _Place, other: _Place) -> float:
    return (other[1] - one[1]) / (other[0] - one[0])


def shifted(profile: InputProfile, begin: float, duration: float) -> InputProfile:
    """Return a profile as it is from a time on, s, which becomes 0, for a duration."""
    full = 2.0 * math.pi
    sinusoids = tuple(Sinusoid(one.amplitude, one.frequency, math.fmod(one.phase + full * one.frequency * begin, full))
                  for one in profile.sinusoids)
    if profile.period < math.inf:
        return _unrolled(profile, begin, duration, sinusoids)
    value, rate, _ = profile.pieces_at(begin)
    first, last = bisect_right(profile.starts, begin), bisect_right(profile.starts, begin + duration)
    return InputProfile((0.0, *np.subtract(profile.starts[first:last], begin).tolist()),
                        (value, *profile.values[first:last]), (rate, *profile.rates[first:last]), sinusoids=sinusoids)


def _unrolled(profile: InputProfile, begin: float, duration: float, sinusoids: tuple[Sinusoid, ...]) -> InputProfile:
    """Return the pieces of a profile that repeats itself, one after the other."""
    starts, values, rates = [], [], []
    time = begin
    while time <= begin + duration:
        value, rate, end = profile.pieces_at(time)
        starts.append(time - begin)
        values.append(value)
        rates.append(rate)
        time = end
    return InputProfile(tuple(starts), tuple(values), tuple(rates), sinusoids=sinusoids)


def travelled(profile: InputProfile, times: Numbers) -> Numbers:
    """Return how far a velocity profile has gone since 0 at each of the times (n,) >= 0 s, m."""
    last = float(times.max(initial=0.0))
    way = profile if profile.period == math.inf else _unrolled(profile, 0.0, last, ())
    starts, values, rates = map(np.array, (way.starts, way.values, way.rates))
    lengths = np.diff(starts)
    sums = np.append(0.0, np.cumsum((values[:-1] + 0.5 * rates[:-1] * lengths) * lengths))
    at = np.searchsorted(starts, times, 'right') - 1
    since = times - starts[at]
    gone = sums[at] + (values[at] + 0.5 * rates[at] * since) * since
    for one in profile.sinusoids:
        turn = 2.0 * math.pi * one.frequency
        gone += one.amplitude / turn * (math.cos(one.phase) - np.cos(turn * times + one.phase))
    return np.asarray(gone)


# The channels of a measurement that an identification uses, and their units.

OUTPUTS: Mapping[str, str] = {'position': 'm', 'velocity': 'm/s', 'drive_force': 'N', 'friction_force': 'N'}
INPUTS: Mapping[str, str] = {'external_force': 'N'}   # measured inputs with a sensor that may be off
UNITS: Mapping[str, str] = {**OUTPUTS, **INPUTS}


# What a sensor resolves, estimated from its readings alone, and how much each of them says.
#
# A reading of an encoder that counts in steps q is off by up to q/2.  While the axis rests all its readings are off by
# the same: a hundred equal readings in a row say no more than one.  So each of L equal readings in a row weighs 1/L.

_MAD = 1.4826          # standard deviation of a normal distribution over its median absolute deviation
_THIRD = 20.0**0.5     # of a third difference over that of a reading
_GRID = 0.02           # of a step: so far from a whole number of steps readings may be
_PARTS = 12            # steps, that the least change of the readings may be
_BY_CHANCE = 1e-4      # of changes that are any: so likely they are whole numbers of a part of the least one
SMALLEST = 1e-7       # of the range of the readings: no sensor is taken to be better
SMALLEST_FORCE = 1e-4  # the same of a force: no model of friction follows it more closely


def quantum_of(readings: Numbers) -> float:
    """Return the step in which a sensor counts, in its unit; 0 where it counts in none that shows.

    It is the greatest of which all changes are whole numbers: the least change seen, or a part of that.
    """
    changes = np.unique(np.abs(np.diff(readings)))
    changes = changes[changes > 1e-12 * max(float(np.ptp(readings)), 1e-300)]
    if len(changes) < 2:
        return float(changes[0]) if len(changes) else 0.0
    if changes[-1] / changes[0] > 1e7:
        return 0.0
    for parts in range(1, _PARTS + 1):
        quantum = float(changes[0]) / parts
        for _ in range(2):   # the least change of many is rounded; the mean of all is not
            counts = np.rint(changes / quantum)
            quantum = float(np.dot(changes, counts)) / float(np.dot(counts, counts))
        counts = np.rint(changes / quantum)
        small = counts < 1e3
        others = int(small.sum()) - 1
        off = float(np.abs(changes[small] / quantum - counts[small]).max(initial=0.0))
        if others > 0 and off < _GRID and (parts == 1 or parts * (2.0 * off)**others < _BY_CHANCE):
            return quantum
    return 0.0


def noise_of(readings: Numbers, quantum: float, smallest: float = SMALLEST) -> float:
    """Return the standard deviation of the noise in readings, that of counting in steps `quantum` included.

    It is at least `smallest`, a share of their range.
    """
    return max(own_noise_of(readings, quantum), smallest * float(np.ptp(readings)))


def own_noise_of(readings: Numbers, quantum: float) -> float:
    """Return the same without a least one for sensors of a wide range."""
    return noise_of_thirds(np.diff(readings, 3), quantum)


def noise_of_thirds(third: Numbers, quantum: float) -> float:
    """Return the same of third differences (n,) of readings."""
    spread: float = _MAD * float(np.median(np.abs(third - np.median(third)))) / _THIRD if len(third) else 0.0
    return max(spread, quantum / float(np.sqrt(12.0)))


def weights_of(readings: Numbers, quantum: float) -> Numbers:
    """Return how much each reading says: 1, or 1/L where L in a row are equal and the sensor counts in steps."""
    if quantum == 0.0:
        return np.ones(len(readings))
    starts = np.flatnonzero(np.diff(readings) != 0.0) + 1
    edges = np.concatenate([[0], starts, [len(readings)]])
    lengths = np.diff(edges)
    return np.repeat(1.0 / lengths, lengths)


# The readings of an input, and what they would have been had its sensor read it once more.

LINE, HELD, PLACES = 'line', 'held', 'places'
_WITHIN = 2.0   # standard deviations: so near to its measured position a drive is taken to move


class InputReadings(NamedTuple):
    """Readings (n,) of an input at times (n,), s: values on a LINE or HELD in between, or PLACES of a drive (m)."""

    times: Numbers
    values: Numbers
    kind: str

    def profile(self) -> InputProfile:
        """Return the input; of places, the velocity."""
        return self._through(self.values)

    def read_again(self, random: np.random.Generator) -> InputProfile:
        """Return the input as it would have been found from other readings of it, with noise of its own."""
        quantum = quantum_of(self.values)
        noise = noise_of(self.values, quantum)
        if self.kind != PLACES:
            return self._through(self.values + random.normal(0.0, noise, len(self.values)))
        way = self.values[0] + travelled(self.profile(), self.times)
        if quantum == 0.0:
            return self._through(way + random.normal(0.0, noise, len(way)))
        phase = random.uniform(0.0, quantum)   # where its steps begin
        return self._through(np.round((way + phase) / quantum) * quantum)

    def _through(self, values: Numbers) -> InputProfile:
        if self.kind != PLACES:
            return profile_through(self.times, values, self.kind == HELD)
        quantum = quantum_of(self.values)
        return velocity_within(self.times, values, max(0.5 * quantum, _WITHIN * noise_of(self.values, quantum)))


_FEWEST = 20          # samples
_LONGEST_GAP = 1.0    # of the time that was measured without it
_MOST, _NOISES = 0.99, 4.0   # a drive is that of the scene where this share of it is within so many deviations
_RATES = 10.0, 2e5    # Hz


@dataclass(frozen=True)
class Channel:
    """A measured output (n,) in `unit`: `resolution` is the standard deviation of its noise, `quantum` of its steps.

    `weights` (n,) say how much each reading counts (`weights_of`).
    """

    name: str
    unit: str
    values: Numbers
    resolution: float
    quantum: float
    weights: Numbers


@dataclass(frozen=True)
class SensorReadings:
    """Channels over `times` (n,), s since the start of the simulation, which is `shift` s of the measurement.

    `drive` and `force` are the inputs, where they were measured, made of `drive_readings` and `force_readings`;
    `force_noise` is the standard deviation of its readings at rest, N, `force_deviations` (n,) are those of a force
    that was smoothed; `period` (s) is the median time between samples.
    """

    times: Numbers
    shift: float
    period: float
    channels: tuple[Channel, ...]
    drive: InputProfile | None
    force: InputProfile | None
    notes: tuple[str, ...]
    drive_readings: InputReadings | None = None
    force_readings: InputReadings | None = None
    force_noise: float | None = None
    force_deviations: Numbers | None = None

    @property
    def instants(self) -> Instants:
        """The times in two parts."""
        return instants_of(self.times)

    def channel(self, name: str) -> Channel | None:
        """Return a channel by its name, None where it was not measured."""
        return next((channel for channel in self.channels if channel.name == name), None)


def instants_of(times: Numbers) -> Instants:
    """Return times, s, in two parts."""
    seconds = np.floor(times)
    return Instants(seconds, times - seconds)


def hash_of(run: Run) -> str:
    """Return a hash of the readings of a run."""
    readings = hashlib.sha256()
    for name, column in sorted(run.samples.items()):
        readings.update(name.encode())
        readings.update(np.ascontiguousarray(column, dtype=np.float64).tobytes())
    return readings.hexdigest()


def check_distinct(runs: Sequence[Run]) -> None:
    """Raise InputError where a run is there twice: it would count its noise twice, or predict itself."""
    seen: dict[str, str] = {}
    for run in runs:
        own = hash_of(run)
        if own in seen:
            raise InputError('RUN', run.name, f'another run than {seen[own]}: its readings are the same',
                             'give it once')
        seen[own] = run.name


def readings_of(run: Run, scene: Scene, resolutions: Mapping[str, float]) -> SensorReadings:
    """Return what a run measured, with stated `resolutions` (standard deviations) by channel; raises InputError."""
    columns = {name: np.asarray(values, dtype=np.float64) for name, values in run.samples.items()}
    known = run.telling if isinstance(run, MeasuredRun) else (*OUTPUTS, 'drive_velocity', 'external_force')
    keep = np.all([np.isfinite(columns[name]) for name in known if name in columns], axis=0)
    columns = {name: values[keep] for name, values in columns.items()}
    as_force = drives_directly(scene) and 'drive_force' in known
    times, shift, period = _times(columns['time'], as_force or (drives_directly(scene) and 'external_force' in known))
    outputs = [name for name in OUTPUTS if name in known and not (as_force and name == 'drive_force')]
    if not run.is_recorded or not isinstance(run, MeasuredRun):
        outputs = [name for name in outputs if name != 'friction_force']
    for name in resolutions:
        if name not in outputs:
            raise InputError('resolution', name, 'of a channel that was measured: ' + ', '.join(outputs), 'drop it')
    channels = tuple(_channel(name, columns[name], resolutions.get(name)) for name in outputs)
    _check_motion(channels)
    notes = [f'time {shift:g} s of the measurement is the start of the simulation'] if shift else []
    if not keep.all():
        notes.append(f'{len(keep) - len(times)} of {len(keep)} readings are left out: one of their numbers is missing')
    force = columns['drive_force'] if as_force else columns['external_force'] if 'external_force' in known else None
    of_drive, of_force = _drive(columns, known, times, scene, notes), _force(force, times, scene)
    return SensorReadings(times, shift, period, channels, of_drive and of_drive.profile(),
                          of_force and of_force.profile(), tuple(notes), of_drive, of_force)


def _times(times: Numbers, are_pushed: bool) -> tuple[Numbers, float, float]:
    """Return times from the start of the simulation on, that start, and the period; raises InputError.

    Motion under nothing but a measured force starts where its readings do.
    """
    if len(times) < _FEWEST:
        raise InputError('RUN', f'{len(times)} samples', f'{_FEWEST} samples or more', 'measure longer or faster')
    steps = np.diff(times)
    period = float(np.median(steps))
    if not 1.0 / _RATES[1] <= period <= 1.0 / _RATES[0]:
        raise InputError('RUN', f'{1.0 / period:g} samples/s', '{:g} to {:g} samples/s'.format(*_RATES),
                         'check the unit of its time')
    gap = int(steps.argmax())
    if steps[gap] > max(_LONGEST_GAP * (times[-1] - times[0] - steps[gap]), 10.0 * period):
        raise InputError('RUN', f'a jump of its time from {times[gap]:g} to {times[gap + 1]:g} s', 'without a gap that '
                         'is longer than all the rest', 'import the part before or after it')
    is_late = times[0] > (period if are_pushed else times[-1] - times[0])
    shift = float(times[0]) if is_late else 0.0
    return times - shift, shift, period


def _channel(name: str, values: Numbers, resolution: float | None) -> Channel:
    quantum = quantum_of(values)
    least = {'smallest': SMALLEST_FORCE} if OUTPUTS[name] == 'N' else {}
    noise = noise_of(values, quantum, **least) if resolution is None else resolution
    return Channel(name, OUTPUTS[name], values, noise, quantum, weights_of(values, quantum))


def _check_motion(channels: tuple[Channel, ...]) -> None:
    """Raise InputError where the slider does not move."""
    moving = next((channel for channel in channels if channel.name in ('position', 'velocity')), None)
    if moving is None:
        raise InputError('RUN', ', '.join(channel.name for channel in channels), 'with a position or a velocity of the '
                         'slider', 'import one of them')
    span = float(np.ptp(moving.values))
    if span <= max(6.0 * moving.resolution, 3.0 * moving.quantum):
        raise InputError('RUN', f'a {moving.name} that changes by {span:g} {moving.unit}', 'one in which the slider '
                         'moves', 'check its column and unit, or measure at a higher feed')


def drives_directly(scene: Scene) -> bool:
    """Return whether a scene has no drive spring: then the measured drive force acts on the slider by itself."""
    return scene.axis.drive_stiffness == 0.0 and scene.axis.drive_damping == 0.0


def _drive(columns: Mapping[str, Numbers], known: tuple[str, ...], times: Numbers, scene: Scene, notes: list[str]
           ) -> InputReadings | None:
    """Return the measured drive, None where that of the scene is as good."""
    if 'drive_velocity' in known:
        values = columns['drive_velocity']
    elif 'drive_position' in known:
        values = np.diff(columns['drive_position']) / np.diff(times)
        values = np.append(values, values[-1])
    else:
        return None
    own = np.array([scene.drive.value_at(float(time)) for time in times])
    noise = noise_of(values, quantum_of(values))
    off = values - own
    if float(np.quantile(np.abs(off), _MOST)) <= _NOISES * noise and abs(float(np.mean(off))) <= noise:
        return None
    notes.append('the drive moves as it was measured')
    if 'drive_velocity' not in known:
        return InputReadings(times, columns['drive_position'], PLACES)
    return InputReadings(times, values, HELD if _is_held(columns, times, values) else LINE)


def _is_held(columns: Mapping[str, Numbers], times: Numbers, values: Numbers) -> bool:
    """Return whether a drive holds each velocity up to the next sample, as its positions say; else it is linear."""
    if 'drive_position' not in columns or not np.isfinite(columns['drive_position']).all():
        return False
    gone, steps = np.diff(columns['drive_position']), np.diff(times)
    held, linear = gone - values[:-1] * steps, gone - 0.5 * (values[:-1] + values[1:]) * steps
    return float(held @ held) < float(linear @ linear)


def _force(values: NDArray[np.float64] | None, times: Numbers, scene: Scene) -> InputReadings | None:
    """Return the measured force on the slider, None where that of the scene is as good."""
    if values is None:
        return None
    own = np.array([scene.force.value_at(float(time)) for time in times])
    if np.abs(values - own).max() <= 1e-6 * max(np.abs(own).max(), 1e-12):
        return None
    return InputReadings(times, values, LINE)
