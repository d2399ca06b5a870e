# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A slow sine on the drive whose force grazes the static limit: the hardest break-away to see (and not to invent).

From rest, the drive swings by A/w (cos θ − cos(wt + θ)).  The force that reaches the contact of the stuck slider peaks
at mean + amplitude of its steady answer, both proportional to A; so A follows from the overshoot in closed form.
"""

import math
from dataclasses import replace

from ..axis import Axis, CompliantContact
from ..core.errors import InputError
from ..core.input_profile import InputProfile, Sinusoid, constant

GRAZING_FREQUENCIES = 0.02, 0.2          # Hz: slow enough for the ring-down of a start to vanish before the first peak
PHASES = -0.45 * math.pi, 0.45 * math.pi   # rad: the first extreme is the peak


def grazing_drive(axis: Axis, overshoot: float, frequency: float, phase: float) -> InputProfile:
    """Return a drive profile (m/s) whose contact force peaks at N mu_inf (1 + overshoot), from prolonged rest.

    The peak comes at (π − phase)/(2π frequency), or a little later through the damper; it is the only way to the limit.
    Raises InputError without a drive spring or a finite limit, or for a phase (rad) whose first extreme is no peak.
    """
    if not PHASES[0] <= phase <= PHASES[1]:
        raise InputError('phase', phase, f'from {PHASES[0]!r} to {PHASES[1]!r} rad', 'take a phase around 0')
    if not axis.drive_stiffness > 0.0 or not axis.friction.static.bounded:
        raise InputError('axis', axis, 'with a drive spring and a bounded static law', 'take another axis')
    limit = axis.normal_force * axis.friction.static.coefficient(math.inf)
    peak = _force_peak(axis, 2.0 * math.pi * frequency, phase)
    return replace(constant(0.0), sinusoids=(Sinusoid(limit * (1.0 + overshoot) / peak, frequency, phase),))


def _force_peak(axis: Axis, w: float, phase: float) -> float:
    """Return the peak of the force in the contact for a drive velocity of 1 m/s sin(w t + phase), N."""
    pull = complex(axis.drive_stiffness, w * axis.drive_damping)
    if not isinstance(axis.contact, CompliantContact):
        return (axis.drive_stiffness * math.cos(phase) + abs(pull)) / w
    contact = complex(axis.contact.stiffness, w * axis.contact.damping)
    share = axis.contact.stiffness / (axis.drive_stiffness + axis.contact.stiffness)
    swing = abs(pull * contact / (pull + contact - axis.mass * w * w))
    return (axis.drive_stiffness * math.cos(phase) * share + swing) / w
