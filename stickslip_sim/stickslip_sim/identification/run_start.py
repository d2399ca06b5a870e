# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where a measured run starts: its encoder counts from anywhere, it may move, its spring may be stretched already."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..core.input_profile import InputProfile
from ..scene import Scene, changed
from .free_parameters import FreeParameter
from .motions import YIELDS, MeasuredMotion
from .readings import Channel, SensorReadings, drives_directly, travelled

_FIRST = 10          # samples, of which the start is the mean
_NOISES = 5.0        # standard deviations of one sample: nearer, the start of the scene is as good
_OF_FORCES = 0.03    # of the range of the drive force, likewise
_WIDEST = 2.0        # ranges of a position or a drive force: so far the start may be off
_SHORT = 0.45        # of the second rest: no spring that was slack at the start breaks away after so short a way
_LENGTHS = 10, 20, 40, 80   # of a parabola through the first samples
_WELL, _MOVING = 0.005, 0.01   # of the highest speed: as well a speed at the start is known; one below is no motion
_SPEED_NOISES = 20.0   # so far from the measured speed at the start the true one may be: a parabola is none of it
_LINE_NOISES = 3.0     # of what is left of a line through the first samples: so far it may be off at the start
_RESTS = 1e-3, 1e4   # s: so long the slider may have been at rest before
_PART = 0.5          # of a usual rest: there the search for that begins
_OFFSET = 'sensor.drive_force.offset'
_POSITION, _STRETCH, _VELOCITY, _REST = ('initial.position', 'initial.stretch', 'initial.velocity',
                                         'initial.rest_time')


class StartForce(NamedTuple):
    """The drive force at the start of a run as it was measured, and its standard deviation, N."""

    value: float
    deviation: float


class _Speed(NamedTuple):
    """A speed at the start, m/s, its standard deviation, and the highest of the run."""

    value: float
    deviation: float
    highest: float


def from_measured_start(scene: Scene, parameters: tuple[FreeParameter, ...], measurement: SensorReadings,
                        motions: Sequence[MeasuredMotion]) -> tuple[Scene, tuple[FreeParameter, ...], tuple[str, ...]]:
    """Return a scene that starts where the run does, the parameters with what is not known of that, and notes.

    What is free already, or follows from a prescribed position of the drive, stays.
    """
    names = {one.name for one in parameters}
    notes: list[str] = []
    if scene.values['drive.course'] == 'position' or measurement.times[0] > _FIRST * measurement.period:
        return scene, parameters, ()
    if not names & {_POSITION, 'sensor.position.offset'}:
        scene, own = _moved(scene, measurement, notes)
        parameters = (*parameters, *own)
    if _VELOCITY not in names:
        parameters = (*parameters, *_velocity(scene, measurement, notes))
    if _STRETCH not in names:
        parameters = (*parameters, *_stretch(scene, parameters, measurement, motions, notes))
    return scene, parameters, tuple(notes)


def start_force(measurement: SensorReadings) -> StartForce | None:
    """Return the measured drive force at the start, by a line through the first samples; None without one."""
    channel = measurement.channel('drive_force')
    if channel is None or measurement.times[0] > _FIRST * measurement.period:
        return None
    times, forces = measurement.times[:_FIRST], channel.values[:_FIRST]
    slope, value = np.polyfit(times, forces, 1)
    off = _LINE_NOISES * float(np.sqrt(np.mean((forces - value - slope * times)**2)))
    return StartForce(float(value), max(channel.resolution, off))


def _moved(scene: Scene, measurement: SensorReadings, notes: list[str]) -> tuple[Scene, Sequence[FreeParameter]]:
    """Return the scene with the first measured position, and that as a parameter, if it is another one.

    It is known only as well as one reading, and the error would be in all others.  Where noise of a measured force
    moves the slider, what is new in each sample counts, which does not know it.
    """
    channel = measurement.channel('position')
    if channel is None or abs(float(channel.values[0]) - scene.initial.position) <= _NOISES * channel.resolution:
        return scene, ()
    first = float(channel.values[0])
    scene = changed(scene, {_POSITION: first})
    if drives_directly(scene):
        notes.append(f'the run starts at {first:g} m: so does the scene')
        return scene, ()
    notes.append(f'the run starts at {first:g} m: so does the scene, and {_POSITION} is free, too')
    most = _WIDEST * max(abs(first), float(np.ptp(channel.values)))
    return scene, (FreeParameter(_POSITION, 'm', first, -most, most),)


def _velocity(scene: Scene, measurement: SensorReadings, notes: list[str]) -> Sequence[FreeParameter]:
    """Return the velocity at the start as a parameter, if the run begins in motion."""
    speed = _measured_speed(measurement)
    if speed is None:
        return ()
    drive = measurement.drive or scene.drive
    still = max(_MOVING * speed.highest, _NOISES * speed.deviation,
                0.0 if scene.axis.drive_stiffness == 0.0 else YIELDS * abs(drive.value_at(0.0)))
    if abs(speed.value) <= still or abs(speed.value - scene.initial.velocity) <= _NOISES * speed.deviation:
        return ()
    most = _WIDEST * max(speed.highest, abs(speed.value))
    notes.append(f'the run starts at {speed.value:.3g} m/s: {_VELOCITY} is free, too')
    known = speed.value / (2.0 * most), _SPEED_NOISES * speed.deviation / (2.0 * most)
    return (FreeParameter(_VELOCITY, 'm/s', speed.value, -most, most, known),)


def _measured_speed(measurement: SensorReadings) -> _Speed | None:
    """Return the speed at the start, by the measured one, or by a parabola through the first positions."""
    velocity, position = measurement.channel('velocity'), measurement.channel('position')
    if velocity is not None:
        return _Speed(float(np.mean(velocity.values[:_FIRST])), velocity.resolution / _FIRST**0.5,
                      float(np.abs(velocity.values).max()))
    if position is None or len(measurement.times) < 2 * _LENGTHS[-1]:
        return None
    apart = _LENGTHS[-1]
    highest = float(np.abs((position.values[apart:] - position.values[:-apart])
                           / (measurement.times[apart:] - measurement.times[:-apart])).max())
    for length in _LENGTHS:
        value, deviation = _slope_at_start(measurement, position, length)
        if deviation <= _WELL * highest:
            break
    return _Speed(value, deviation, highest)


def _slope_at_start(measurement: SensorReadings, position: Channel, length: int) -> tuple[float, float]:
    times = measurement.times[:length] - measurement.times[0]
    powers = np.stack([np.ones(length), times, times**2], axis=1)
    inverse = np.linalg.pinv(powers)
    found = inverse @ position.values[:length]
    off = position.values[:length] - powers @ found
    noise = max(position.resolution, float(np.sqrt(off @ off / (length - 3))))
    return float(found[1]), noise * float(np.sqrt(inverse[1] @ inverse[1]))


def _stretch(scene: Scene, parameters: Sequence[FreeParameter], measurement: SensorReadings,
             motions: Sequence[MeasuredMotion], notes: list[str]) -> Sequence[FreeParameter]:
    """Return the stretch of the spring at the start as a parameter, if the run says that it is another."""
    moves = any(one.name == _VELOCITY for one in parameters)
    channel, stiffness = measurement.channel('drive_force'), scene.axis.drive_stiffness
    if stiffness == 0.0:
        return ()
    first = start_force(measurement)
    if channel is None or first is None or _OFFSET in {one.name for one in parameters}:
        return _stretch_by_motion(scene, parameters, measurement, motions, notes)
    speed = _measured_speed(measurement) if moves else None
    velocity = scene.initial.velocity if speed is None else speed.value
    drive = measurement.drive or scene.drive
    damped = scene.axis.drive_damping * (drive.value_at(0.0) - velocity)
    span = float(np.ptp(channel.values))
    off = abs(first.value - stiffness * scene.initial.stretch - damped)
    if off <= max(_NOISES * channel.resolution, _OF_FORCES * span):
        return ()
    most = _WIDEST * max(span, abs(first.value)) / stiffness
    notes.append(f'the run starts with a drive force of {first.value:g} N: {_STRETCH} is free, too')
    return (FreeParameter(_STRETCH, 'm', (first.value - damped) / stiffness, -most, most),
            *(() if moves else _rest_time(scene, parameters, motions, notes)))


def _rest_time(scene: Scene, parameters: Sequence[FreeParameter], motions: Sequence[MeasuredMotion], notes: list[str]
               ) -> Sequence[FreeParameter]:
    """Return the time at rest before the run as a parameter, where static friction depends on it.

    It begins with a part of a usual rest: after a long one nothing would change with it any more.
    """
    if scene.values['friction.static.law'] == 'constant' or _REST in {one.name for one in parameters}:
        return ()
    notes.append(f'how long the slider was at rest before the run is not known: {_REST} is free, too')
    rests = [after.begin - before.end for before, after in pairwise(motions)]
    start = min(scene.initial.rest_time, _PART * float(np.median(rests)) if rests else np.inf)
    return (FreeParameter(_REST, 's', min(max(start, _RESTS[0]), _RESTS[1]), *_RESTS),)


def _stretch_by_motion(scene: Scene, parameters: Sequence[FreeParameter], measurement: SensorReadings,
                       motions: Sequence[MeasuredMotion], notes: list[str]) -> Sequence[FreeParameter]:
    """Return the stretch at the start as a parameter where the motion shows that it is another.

    That is what there is without a force, or with one of which the sensor has an unknown offset.
    """
    stretch, moves = scene.initial.stretch, any(one.name == _VELOCITY for one in parameters)
    if not moves and not _begins_in_a_cycle(motions, measurement, measurement.drive or scene.drive):
        if measurement.channel('drive_force') is None:
            notes.append(f'no force is measured: the spring begins stretched by {stretch:g} m, as in the scene')
        return ()
    friction = scene.axis.friction
    largest = scene.axis.normal_force * max(friction.static.limit, friction.kinetic.coefficients[0])
    most = max(_WIDEST * largest / scene.axis.drive_stiffness, 2.0 * abs(stretch))
    notes.append(f'the run starts within a cycle: {_STRETCH} is free, too')
    if not moves:   # the first break-away is about at the largest friction
        gone = float(travelled(measurement.drive or scene.drive, np.array([motions[0].begin]))[0])
        stretch = motions[0].direction * largest / scene.axis.drive_stiffness - gone
    return (FreeParameter(_STRETCH, 'm', stretch, -most, most),
            *(() if moves else _rest_time(scene, parameters, motions, notes)))


def _begins_in_a_cycle(motions: Sequence[MeasuredMotion], measurement: SensorReadings, drive: InputProfile) -> bool:
    """Return whether the first break-away comes too early for a spring that was slack before."""
    if len(motions) < 2 or motions[0].direction != motions[1].direction:
        return False
    times = np.array([measurement.times[0], motions[0].begin, motions[0].end, motions[1].begin])
    gone = travelled(drive, np.maximum(times, 0.0))
    return bool(abs(gone[1] - gone[0]) < _SHORT * abs(gone[3] - gone[2]))
