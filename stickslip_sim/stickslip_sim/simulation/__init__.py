# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One axis through time, with the rig around it: commands, drive limits, faults, encoders.  Knows no clock and no ROS.

The motion is a function of the scene (with its seed) and of the orders by step, and of nothing else: the same orders
before the same steps give the same numbers in real time, in lock-step, as fast as possible, and offline.  What the
axis itself does between two events is next door in `axis` and `solvers`; the figures of a run are in `figures`.
"""

from .encoder import Measured
from .faults import Fault
from .rig import DRIVE_FAILED, SILENT_BRIDGE, Rig
from .step_result import RigEvent, RigEventKind, StepResult

__all__ = ['DRIVE_FAILED', 'SILENT_BRIDGE', 'Fault', 'Measured', 'Rig', 'RigEvent', 'RigEventKind', 'StepResult']
