# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes: everything that decides a run, as a ROS 2 parameter file that is read without ROS."""

from ..config.parameter import Parameter, When
from .load import (
    changed,
    parse_override,
    parse_scene,
    scene_from_values,
    scene_names,
)
from .model import CommandSettings, RecordSettings, Scene, TimeSettings
from .schema import PARAMETERS
from .solver import SolverSettings

__all__ = [
    'PARAMETERS', 'CommandSettings', 'Parameter', 'RecordSettings', 'Scene', 'SolverSettings', 'TimeSettings',
    'When',
    'changed', 'parse_override', 'parse_scene', 'scene_from_values', 'scene_names',
]
