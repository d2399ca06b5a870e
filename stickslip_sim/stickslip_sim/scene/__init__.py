# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes: everything that decides a run, as a ROS 2 parameter file.  Finding and loading files is in `inputs`.

A scene is a mapping of `values` by dotted name all the way: as a file states them (`read_scene`), with `changes` on top
(`overridden`), checked and complete (`complete_values`, `Scene.values`).
"""

from .build import scene_from_values
from .load import changed, parse_override, parse_scene, scene_names
from .model import CommandSettings, RecordSettings, Scene, SolverSettings, TimeSettings
from .parameter import Parameter, When
from .schema import PARAMETERS

__all__ = [
    'PARAMETERS', 'CommandSettings', 'Parameter', 'RecordSettings', 'Scene', 'SolverSettings', 'TimeSettings',
    'When',
    'changed', 'parse_override', 'parse_scene', 'scene_from_values', 'scene_names',
]
