# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers of the drive: cascade, compensation of friction, and the moves that they follow.  Pure; knows no ROS."""

from .drive_controller import AT_REST, Answer, Cascade, Controller, DriveCommand, Following, Memory, MoveProgress
from .friction_branches import BranchCompensation, Slide
from .moves import Moves, Setpoint

__all__ = [
    'AT_REST',
    'Answer',
    'BranchCompensation',
    'Cascade',
    'Controller',
    'DriveCommand',
    'Following',
    'Memory',
    'MoveProgress',
    'Moves',
    'Setpoint',
    'Slide',
]
