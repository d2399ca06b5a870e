# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The measured run that an identification starts from: channels over time, and the inputs where they were measured."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.input_profile import InputProfile
from ..core.time_grid import Instants
from ..recording.measured_run import MeasuredRun
from ..runs import Run
from ..scene import Scene
from .measured_inputs import profile_through, travelled, velocity_within

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
_SMALLEST = 1e-7       # of the range of the readings: no sensor is taken to be better
SMALLEST_FORCE = 1e-4  # the same of a force: no model of friction follows it more closely


def quantum_of(readings: Numbers) -> float:
    """Return the step in which a sensor counts, in its unit; 0 where it counts in none that shows."""
    steps = np.unique(np.abs(np.diff(readings)))
    steps = steps[steps > 1e-12 * max(float(np.ptp(readings)), 1e-300)]
    if len(steps) < 2:
        return float(steps[0]) if len(steps) else 0.0
    quantum = float(steps[0])
    if steps[-1] / quantum > 1e7:
        return 0.0
    for _ in range(2):   # the least difference of many is rounded; the mean of all is not
        counts = np.rint(steps / quantum)
        quantum = float(np.dot(steps, counts)) / float(np.dot(counts, counts))
    counts = np.rint(steps / quantum)
    small = counts < 1e3
    is_even = bool(np.all(np.abs(steps[small] / quantum - counts[small]) < _GRID))
    return quantum if is_even and int(small.sum()) > 1 else 0.0


def noise_of(readings: Numbers, quantum: float, smallest: float = _SMALLEST) -> float:
    """Return the standard deviation of the noise in readings, that of counting in steps `quantum` included.

    It is at least `smallest`, a share of their range.
    """
    return max(own_noise_of(readings, quantum), smallest * float(np.ptp(readings)))


def own_noise_of(readings: Numbers, quantum: float) -> float:
    """Return the same without a least one for sensors of a wide range."""
    third = np.diff(readings, 3)
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
    `period` (s) is the median time between samples.
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


def readings_of(run: Run, scene: Scene, resolutions: Mapping[str, float]) -> SensorReadings:
    """Return what a run measured, with stated `resolutions` (standard deviations) by channel; raises InputError."""
    columns = {name: np.asarray(values, dtype=np.float64) for name, values in run.samples.items()}
    known = run.measured if isinstance(run, MeasuredRun) else (*OUTPUTS, 'drive_velocity', 'external_force')
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
    force = columns['drive_force'] if as_force else columns['external_force'] if 'external_force' in known else None
    of_drive, of_force = _drive(columns, known, times, scene, notes), _force(force, times, scene)
    return SensorReadings(times, shift, period, channels, of_drive and of_drive.profile(),
                          of_force and of_force.profile(), tuple(notes), of_drive, of_force)


def _times(times: Numbers, are_pushed: bool) -> tuple[Numbers, float, float]:
    """Return times from the start of the simulation on, that start, and the period; raises InputError.

    Motion under nothing but a measured force starts where its readings do.
    """
    if len(times) < _FEWEST:
        raise InputError('RUN', f'{len(times)} samples', f'{_FEWEST} samples or more', 'measure longer or more often')
    steps = np.diff(times)
    period = float(np.median(steps))
    if not 1.0 / _RATES[1] <= period <= 1.0 / _RATES[0]:
        raise InputError('RUN', f'{1.0 / period:g} samples/s', '{:g} to {:g} samples/s'.format(*_RATES),
                         'look at the unit of its time')
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
                         'moves', 'look at its column and unit, or measure with a larger feed')


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
