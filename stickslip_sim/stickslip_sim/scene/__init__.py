# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes: everything that decides a run, as a ROS 2 parameter file.  Finding and loading files is in `inputs`."""

from .load import changed, parse_override, parse_scene, scene_from_values, scene_names
from .model import CommandSettings, RecordSettings, Scene, SolverSettings, TimeSettings
from .parameter import Parameter, When
from .schema import PARAMETERS

__all__ = [
    'PARAMETERS', 'CommandSettings', 'Parameter', 'RecordSettings', 'Scene', 'SolverSettings', 'TimeSettings',
    'When',
    'changed', 'parse_override', 'parse_scene', 'scene_from_values', 'scene_names',
]
