# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a live axis has other than the scene that travels in a recording."""

from collections.abc import Mapping

from ...scene import Scene
from ...scene.schema import BY_NAME

_SHOWN = 3
_ELSEWHERE = ('scene', 'time', 'clock', 'record', 'timing', 'joint_interface')   # sections without a say in the motion


def compared_names(scene: Scene) -> list[str]:
    """Return the parameters of a recorded scene that decide the motion."""
    return [name for name in scene.values if name in BY_NAME and name.partition('.')[0] not in _ELSEWHERE]


def difference_between(recorded: Scene, live: Mapping[str, object]) -> str:
    """Return in which parameters a live axis differs from the recorded scene, for people; empty where in none."""
    found = [f'{name} is {_plain(value)}, not {_plain(recorded.values[name])}' for name, value in live.items()
             if _plain(value) != _plain(recorded.values[name])]
    more = f', and {len(found) - _SHOWN} more' if len(found) > _SHOWN else ''
    return ', '.join(found[:_SHOWN]) + more


def _plain(value: object) -> object:
    """Return a value as ROS and scenes both have it: an empty list is none."""
    listed = list(value) if hasattr(value, '__iter__') and not isinstance(value, str) else value
    return None if listed == [] else listed
