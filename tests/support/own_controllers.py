# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The controllers of the package as controllers of a user."""

from stickslip_sim.controllers import AT_REST, Controller
from stickslip_sim.controllers.own_controller import Measurement
from stickslip_sim.simulation import Measured


class Following:
    """Follows the setpoint that it is told."""

    def __init__(self, controller: Controller) -> None:
        self._controller = controller

    def reset(self) -> None:
        self._memory, self._latest = AT_REST, 0.0

    def __call__(self, time: float, measured: Measurement) -> float:
        assert measured.setpoint is not None
        self._memory, command = self._controller.step(self._memory, measured.setpoint, Measured(*measured[:4]),
                                                      time - self._latest)
        self._latest = time
        return command.velocity
