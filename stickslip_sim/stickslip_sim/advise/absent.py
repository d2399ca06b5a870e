# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parts that a scene leaves out, and the values with which each of them, given, does nothing."""

from typing import NamedTuple

from ..scene import Scene
from .part import Changes, SceneValues

_ANY_TIME = 1.0        # s, a time constant of a growth from a value to the same value
_ANY_FREQUENCY = 10.0  # Hz, of a sine without an amplitude


class Absent(NamedTuple):
    """A part that is not in a scene; `changes` give it there with no effect."""

    name: str
    changes: Changes


def absent_parts(scene: Scene) -> list[Absent]:
    """Return the parts that a scene leaves out and that have values without an effect."""
    return [Absent(name, changes) for name, changes in _neutral(scene.values).items()]


def _neutral(values: SceneValues) -> dict[str, Changes]:
    found: dict[str, Changes] = {}
    if values['friction.static.law'] == 'constant':
        found['rest-time growth of mu_s'] = {
            'friction.static.law': 'exponential', 'friction.static.limit': values['friction.static.initial'],
            'friction.static.time_constant': _ANY_TIME}
    for section, what in (('drive', 'sine on the drive'), ('force', 'sine on the force')):
        if f'{section}.amplitudes' not in values:
            found[what] = {f'{section}.amplitudes': (0.0,), f'{section}.frequencies': (_ANY_FREQUENCY,)}
    for name, parameter in (('drive damping', 'axis.drive_damping'), ('contact damping', 'contact.damping'),
                            ('external force', 'force.constant'), ('encoder', 'encoder.resolution'),
                            ('command time-out', 'command.timeout')):
        if values.get(parameter) == 0.0:
            found[name] = {parameter: 0.0}
    return found
