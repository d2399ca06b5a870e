# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Compensation of friction that has one branch for acceleration and another for deceleration.

A slide at speed v takes N mu_k(v) while it slows down, and up to the force that it broke away with while it speeds up
(docs/model.md).  While the spring's force is between the two, the slider keeps its speed against the controller;
a cascade crosses this gap by summing up an error, overshoots, and ends in stick-slip.  Both encoders together
measure the spring's force, so that the gap can be crossed at once, as backlash is in a gear.  A reversal is the same:
the spring is brought over to the friction of the new direction.

Only a share of the gap is crossed: overcompensation makes limit cycles of its own.  (Friction measured
behind an elastic joint: Le Tien, Albu-Schäffer, De Luca and Hirzinger 2008, IROS; compensation in general and the risk
of too much: Armstrong-Hélouvry, Dupont and Canudas de Wit 1994, Automatica 30; inverse of a hysteresis: Tao and
Kokotović 1996, Adaptive Control of Systems with Actuator and Sensor Nonlinearities.)
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

from ..axis import Axis
from ..simulation import Measured


class Slide(NamedTuple):
    """Motion in one direction: its sign (0: none yet) and the largest drive force in it so far, N."""

    direction: int = 0
    peak_force: float = 0.0

    def going_on(self, velocity: float, force: float) -> 'Slide':
        """Return the slide with a new velocity (m/s) and drive force (N); a change of sign begins another one."""
        direction = int(math.copysign(1.0, velocity)) if velocity != 0.0 else self.direction
        before = self.peak_force if direction == self.direction else 0.0
        return Slide(direction, max(before, direction * force))


@dataclass(frozen=True, slots=True)
class BranchCompensation:
    """Crosses `share` of the gap between the branches of friction at `rate` (1/s), by the model `axis`.

    `threshold` (m/s) is the error of the velocity from which on it acts in full.
    """

    axis: Axis
    share: float = 0.9
    rate: float = 35.0
    threshold: float = 1.0e-4

    def drive_force(self, measured: Measured) -> float:
        """Return the force of drive spring and damper, N."""
        return (self.axis.drive_stiffness * (measured.drive_position - measured.slider_position)
                + self.axis.drive_damping * (self.axis.feed_share * measured.drive_velocity - measured.slider_velocity))

    def drive_velocity(self, slide: Slide, wanted: float, measured: Measured) -> float:
        """Return the velocity to add to the drive's, m/s, when the slider should move with `wanted` (m/s)."""
        if slide.direction == 0 or self.axis.drive_stiffness == 0.0:
            return 0.0
        error = slide.direction * (wanted - measured.slider_velocity)
        missing = self._missing_force(slide, error > 0.0, measured)
        weight = min(abs(error) / self.threshold, 1.0)
        return slide.direction * weight * self.rate * missing / self.axis.drive_stiffness

    def _missing_force(self, slide: Slide, speed_up: bool, measured: Measured) -> float:
        """Return by how much the force must change along the slide to get to the other branch, N."""
        force = slide.direction * self.drive_force(measured)
        of_slide = self.axis.friction.along(slide.direction)
        friction = of_slide.kinetic.coefficient(abs(measured.slider_velocity))
        lower = self.axis.normal_force * friction
        gap = max(slide.peak_force - lower, 0.0)
        if speed_up:
            return max(lower + self.share * gap - force, 0.0)
        return min(lower + (1.0 - self.share) * gap - force, 0.0)
