# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A controller of the user in a loop with the rig of a scene, in process: the same bits as in lock-step over ROS."""

from .loop import ClosedLoopRun, close_loop
from .many import ClosedLoops, close_loops
from .tuning import Tuning, tune

__all__ = ['ClosedLoopRun', 'ClosedLoops', 'Tuning', 'close_loop', 'close_loops', 'tune']
