# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Follow a setpoint with encoder feedback: 10 mm in 1.4 s, then rest.

The axis needs joint_interface.enabled.  In lock-step (time.mode) this program makes the steps.  The same class runs
without ROS:
stickslip close-loop examples/setpoint.py:Follower --scene positioning --duration 2 --rate 200
"""

import math
import sys
from typing import Any

from stickslip_sim.ros.executables import controller_node

_TRAVEL, _TIME, _REST = 0.010, 1.4, 0.6    # m, s, s
_GAIN = 10.0                               # 1/s: velocity per position error
_RATE = 200                                # Hz, on an axis of 1 kHz


class Follower:
    """Setpoint velocity plus a proportional correction of the position error."""

    def reset(self) -> None:
        """Start a new move at the next measured position."""
        self._origin: float | None = None
        self._velocity = self._worst = 0.0    # m/s; m, the largest error so far
        self._is_done = False

    def __call__(self, t: float, measured: Any) -> float:
        """Return the drive velocity (m/s) at a time of the move (s); repeat it while measurements are lost."""
        if measured.is_lost:
            return self._velocity
        if self._origin is None:
            self._origin = measured.slider_position
        phase = 2.0 * math.pi * min(t / _TIME, 1.0)
        wanted = _TRAVEL * (phase - math.sin(phase)) / (2.0 * math.pi)
        error = wanted - (measured.slider_position - self._origin)
        self._worst = max(self._worst, abs(error))
        self._velocity = _TRAVEL / _TIME * (1.0 - math.cos(phase)) + _GAIN * error
        if t >= _TIME and not self._is_done:
            self._is_done = True
            print(f'there: the largest error was {self._worst * 1e3:.6f} mm', flush=True)
        return self._velocity


if __name__ == '__main__':
    sys.exit(controller_node(['--controller', f'{__file__}:Follower', '--rate', str(_RATE), '--duration',
                              str(_TIME + _REST), *sys.argv[1:]]))
