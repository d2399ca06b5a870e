# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The usual cascade: P for the position, PI for the velocity, the setpoint's velocity fed forward.

    w = v_set + K_v (x_set − x)                       position loop
    u = w + K_p (w − ẋ) + (K_p / T_n) ∫ (w − ẋ) dt    velocity loop; u is the velocity of the drive

The drive sets the velocity of one end of the spring and the slider is measured at the other, so that K_p makes spring
and damper of the drive act 1 + K_p times as strong: the axis gets √(1 + K_p) times its natural frequency and damping
ratio.  (Altintas, Verl, Brecher, Uriarte and Pritschow 2011, Machine tool feed drives, CIRP Annals 60.)
"""

import math
from dataclasses import dataclass

from ..rig import Measured
from .moves import Setpoint


@dataclass(frozen=True, slots=True)
class Cascade:
    """Gains: position K_v (1/s), velocity K_p (no unit) and its integral time T_n (s; infinite: no integral part)."""

    position_gain: float = 10.0
    velocity_gain: float = 8.0
    integral_time: float = 0.1

    def wanted_velocity(self, setpoint: Setpoint, measured: Measured) -> float:
        """Return w, the velocity that the slider should have, m/s."""
        return setpoint.velocity + self.position_gain * (setpoint.position - measured.slider_position)

    def drive_velocity(self, wanted: float, measured: Measured, integral: float) -> float:
        """Return u, m/s, `integral` (m/s) being the part of it that has been summed up so far."""
        return wanted + self.velocity_gain * (wanted - measured.slider_velocity) + integral

    def integrated(self, integral: float, wanted: float, measured: Measured, period: float) -> float:
        """Return the integral part after another `period` (s)."""
        if math.isinf(self.integral_time):
            return integral
        return integral + self.velocity_gain * (wanted - measured.slider_velocity) * period / self.integral_time
