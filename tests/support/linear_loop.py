# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The loop of cascade and axis without friction, as a linear recursion from step to step."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from benchmarks.controllers import RATE
from stickslip_sim.axis import Axis
from stickslip_sim.controllers import Cascade

Matrix = NDArray[np.float64]


def loop_matrix(axis: Axis, gains: Cascade, delay: int = 0) -> Matrix:
    """Return the matrix of a step of the loop without friction, at setpoint 0.

    The state is position, velocity, drive position, the drive velocity before, the integral part, and the commands
    that wait.  Drive velocity is held over a step, for which the motion of the axis is exact.
    """
    motion = _held_motion(axis)
    size = 5 + delay
    command = _command_row(gains, size)
    if delay == 0:
        arriving = command
    else:
        arriving = np.zeros(size)
        arriving[5] = 1.0
    matrix = np.zeros((size, size))
    matrix[:3, :3] = motion[:3, :3]
    matrix[:3] += np.outer(motion[:3, 3], arriving)
    matrix[3] = arriving
    matrix[4] = _integral_row(gains, size)
    if delay:
        matrix[5:-1, 6:] = np.eye(delay - 1)
        matrix[-1] = command
    return matrix


def _held_motion(axis: Axis) -> Matrix:
    """Return the transition of (position, velocity, drive position, drive velocity) over a step."""
    c, h, m = axis.drive_stiffness, axis.drive_damping, axis.mass
    rates = np.array([[0.0, 1.0, 0.0, 0.0], [-c / m, -h / m, c / m, h / m], [0.0, 0.0, 0.0, 1.0], [0.0] * 4])
    transition: Matrix = expm(rates / RATE)
    return transition


def _integral_row(gains: Cascade, size: int) -> Matrix:
    row = np.zeros(size)
    row[:2] = np.array([-gains.position_gain, -1.0]) * gains.velocity_gain / (gains.integral_time * RATE)
    row[4] = 1.0
    return row


def _command_row(gains: Cascade, size: int) -> Matrix:
    row = _integral_row(gains, size)
    row[0] -= gains.position_gain * (1.0 + gains.velocity_gain)
    row[1] -= gains.velocity_gain
    return row
