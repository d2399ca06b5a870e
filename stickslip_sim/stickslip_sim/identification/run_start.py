# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where a measured run starts: its encoder counts from anywhere, and its drive spring may be stretched already."""

from collections.abc import Sequence

import numpy as np

from ..scene import Scene, changed
from .free_parameters import FreeParameter
from .readings import SensorReadings

_FIRST = 10          # samples, of which the start is the mean
_NOISES = 5.0        # standard deviations of one sample: nearer, the start of the scene is as good
_OF_FORCES = 0.03    # of the range of the drive force, likewise
_WIDEST = 2.0        # ranges of the drive force: so far the spring may be stretched at the start
_POSITION, _STRETCH = 'initial.position', 'initial.stretch'


def from_measured_start(scene: Scene, parameters: tuple[FreeParameter, ...], measurement: SensorReadings
                        ) -> tuple[Scene, tuple[FreeParameter, ...], tuple[str, ...]]:
    """Return a scene that starts where the run does, the parameters with what is not known of that, and notes.

    What is free already, or follows from a prescribed position of the drive, stays.
    """
    names = {one.name for one in parameters}
    notes: list[str] = []
    if scene.values['drive.course'] == 'position' or measurement.times[0] > _FIRST * measurement.period:
        return scene, parameters, ()
    if not names & {_POSITION, 'sensor.position.offset'}:
        scene = _moved(scene, measurement, notes)
    if not names & {_STRETCH, 'sensor.drive_force.offset'}:
        parameters = (*parameters, *_stretch(scene, measurement, notes))
    return scene, parameters, tuple(notes)


def _moved(scene: Scene, measurement: SensorReadings, notes: list[str]) -> Scene:
    """Return the scene with the first measured position, if that is another one."""
    channel = measurement.channel('position')
    if channel is None:
        return scene
    first = float(channel.values[0] if channel.quantum else np.mean(channel.values[:_FIRST]))
    if abs(first - scene.initial.position) <= _NOISES * channel.resolution:
        return scene
    notes.append(f'the run starts at {first:g} m: so does the scene')
    return changed(scene, {_POSITION: first})


def _stretch(scene: Scene, measurement: SensorReadings, notes: list[str]) -> Sequence[FreeParameter]:
    """Return the stretch of the spring at the start as a parameter, if the measured force says that it is another."""
    channel, stiffness = measurement.channel('drive_force'), scene.axis.drive_stiffness
    if channel is None or stiffness == 0.0:
        return ()
    first = float(np.mean(channel.values[:_FIRST]))
    damped = scene.axis.drive_damping * (scene.drive.value_at(0.0) - scene.initial.velocity)
    span = float(np.ptp(channel.values))
    if abs(first - stiffness * scene.initial.stretch - damped) <= max(_NOISES * channel.resolution, _OF_FORCES * span):
        return ()
    most = _WIDEST * max(span, abs(first)) / stiffness
    notes.append(f'the run starts with a drive force of {first:g} N: {_STRETCH} is free, too')
    return (FreeParameter(_STRETCH, 'm', (first - damped) / stiffness, -most, most),)
