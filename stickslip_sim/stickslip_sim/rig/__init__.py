# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The rig around the axis: command channel, drive limits, faults, encoder.  Deterministic; knows no clock and no ROS.

The motion is a function of the scene (with its seed) and of the orders by step, and of nothing else: the same orders
before the same steps give the same numbers in real time, in lock-step, as fast as possible, and offline.
"""

from .encoder import Measured
from .faults import Fault
from .rig import DRIVE_FAILED, SILENT_BRIDGE, Rig
from .step_result import RigEvent, RigEventKind, StepResult

__all__ = ['DRIVE_FAILED', 'SILENT_BRIDGE', 'Fault', 'Measured', 'Rig', 'RigEvent', 'RigEventKind', 'StepResult']
