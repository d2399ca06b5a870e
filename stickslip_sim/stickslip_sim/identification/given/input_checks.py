# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a measurement must have for the parameters that are sought in it, and units that were mistaken."""

from collections.abc import Sequence

import numpy as np

from ...core.errors import InputError
from ...scene import Scene
from .free_parameters import FreeParameter
from .measured_inputs import travelled
from .motions import MeasuredMotion
from .readings import SensorReadings

_NEEDS_REST = 'friction.static.', 'contact.'
_FAR = 30.0   # times: a unit was mistaken
_PER_PARAMETER = 5.0   # effective samples


def check_parameters(parameters: Sequence[FreeParameter], measurement: SensorReadings) -> None:
    """Raise InputError where the data are too few for the parameters, or have no such channel."""
    for one in parameters:
        inputs = ('external_force',) if measurement.force is not None else ()
        if one.sensor is not None and one.sensor[0] not in inputs and measurement.channel(one.sensor[0]) is None:
            known = ', '.join((*(channel.name for channel in measurement.channels), *inputs))
            fix = 'the drive force drives the slider here, and is its external_force' if measurement.force is not None \
                and one.sensor[0] == 'drive_force' else 'leave it out'
            raise InputError('free parameter', one.name, f'of a channel that was measured: {known}', fix)
    count = sum(float(channel.weights.sum()) for channel in measurement.channels)
    if count < _PER_PARAMETER * len(parameters):
        raise InputError('RUN', f'{len(measurement.times)} samples, which say as much as {count:.0f} different ones',
                         f'{_PER_PARAMETER:g} or more for each of the {len(parameters)} free parameters',
                         'measure longer, or free fewer')


def check_data(parameters: Sequence[FreeParameter], measurement: SensorReadings, motions: Sequence[MeasuredMotion],
               scene: Scene) -> None:
    """Raise InputError where the motion has nothing of what is sought, or a unit was mistaken."""
    needed = next((one.name for one in parameters if one.name.startswith(_NEEDS_REST)), None)
    if needed is not None and not motions:
        raise InputError('free parameter', needed, 'one that the motion shows: there is no rest between two motions in '
                         'it, so no static friction', 'measure at a lower feed, or leave it out')
    position = measurement.channel('position')
    drive = measurement.drive or scene.drive
    gone = float(np.ptp(travelled(drive, measurement.times)))
    if position is not None and gone > 0.0 and scene.axis.drive_stiffness > 0.0:
        way = float(np.ptp(position.values))
        if not gone / _FAR < way < gone * _FAR:
            raise InputError('RUN', f'a way of {way:g} m', f'about as long as that of the drive, {gone:g} m',
                             'look at the unit of the position, and at the drive of the scene')
    force = measurement.channel('drive_force')
    scaled = any(one.name == 'sensor.drive_force.scale' for one in parameters)
    friction = scene.axis.friction
    most = scene.axis.normal_force * max(friction.static.limit, friction.kinetic.coefficients[0])
    if force is not None and most > 0.0 and not scaled:
        size = float(np.abs(force.values).max())
        if not most / _FAR < size < most * _FAR:
            raise InputError('RUN', f'a drive force up to {size:g} N', 'about as large as friction in the scene, '
                             f'{most:g} N', 'look at its unit, or free sensor.drive_force.scale')
