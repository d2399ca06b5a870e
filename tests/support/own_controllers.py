# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Controllers as a user has them."""

import math

import stickslip_sim as stickslip
from stickslip_sim.controllers import AT_REST, Controller
from stickslip_sim.controllers.own_controller import Measurement
from stickslip_sim.simulation import Measured


class Cascade:
    """P and PI, and a force now and then; keeps its command where the measurement is lost."""

    def __init__(self, pushes: bool = False) -> None:
        self._pushes = pushes

    def reset(self) -> None:
        self._integral = self._latest = 0.0

    def __call__(self, time: float, measured: Measurement) -> float | stickslip.Command:
        position, velocity = measured.setpoint or (0.004 * time, 0.004)
        if not measured.is_lost:
            wanted = velocity + 20.0 * (position - measured.slider_position) + 1e-8 * measured.drive_force
            self._integral += 0.05 * (wanted - measured.slider_velocity)
            self._latest = min(max(wanted + 2.0 * (wanted - measured.slider_velocity) + self._integral, -0.05), 0.05)
        return stickslip.Command(self._latest, 50.0 * math.sin(9.0 * time)) if self._pushes else self._latest


class Following:
    """Follows the setpoint that it is told, with a controller of the package."""

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
