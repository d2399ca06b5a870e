# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The axis of a scene as a component for LinuxCNC: stickslip.comp, and the engine that it includes."""

from ..core.errors import InputError
from ..core.input_profile import constant
from ..core.version import __version__
from ..scene import Scene
from ..simulation.drive import DriveLimits
from ..simulation.encoder import EncoderSettings
from .c_files import c_files, c_row, filled, numbers_of

HAL_NAMES = 'stickslip.comp', 'stickslip_axis.c', 'stickslip_axis.h'
_MM = 1000.0   # a metre


def hal_files(scene: Scene) -> dict[str, str]:
    """Return the texts of the files by name; raises InputError where the component cannot do what the scene says.

    The profile of the drive is left out: the pin `velocity` is the drive.
    """
    rig, resolution = scene.rig, scene.rig.encoder.resolution
    for name, is_there, fix in (
            ('solver.name', scene.solver.name != 'exact', 'take --set solver.name=exact'),
            ('normal_load', scene.normal_load is not None, 'take --set normal_load.course=none'),
            ('force', scene.force != constant(0.0), 'take --set force.course=constant --set force.constant=0, and drive'
             ' the pin force'),
            ('faults', bool(rig.faults), 'leave them out, and drive the pins friction-scale and force'),
            ('encoder', rig.encoder != EncoderSettings(resolution), 'leave out all but encoder.resolution'),
            ('command.velocity_limit or acceleration_limit', rig.limits != DriveLimits(),
             'leave them out: MAX_VELOCITY and MAX_ACCELERATION in the INI limit the axis')):
        if is_there:
            raise InputError(name, f'that of {scene.name}', 'one that a component of LinuxCNC can do', fix)
    core, numbers = c_files(scene, 1.0), numbers_of(scene)
    comp = filled('stickslip.comp', {
        'NAME': scene.name, 'VERSION': __version__, 'RESOLUTION': repr(_MM * resolution),
        'PARAMETERS': c_row(numbers.parameters), 'INITIAL': c_row(numbers.initial)})
    return {name: core.get(name, comp) for name in HAL_NAMES}
