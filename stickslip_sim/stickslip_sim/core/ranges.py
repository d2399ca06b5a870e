# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the numbers of an axis and of its inputs may be, for all that check them.

A scene keeps each within its whole range, so that no product of them (an energy, a square of a rate) leaves the range
of doubles: far beyond any machine, from the tip of an atomic force microscope to a tectonic plate, and far within
1e±308.  So does a batch.  A single axis made in Python may go beyond, as long as its numbers have a meaning.
"""

import math
from typing import NamedTuple

from .errors import InputError


class Range(NamedTuple):
    """From `low` to `high`, both included."""

    low: float
    high: float

    def check_meaning(self, name: str, value: float, unit: str, fix: str) -> None:
        """Raise InputError unless a value is finite, and has the sign that all of this range have."""
        if math.isfinite(value) and (self.low < 0.0 or value > 0.0 or value == self.low):
            return
        allowed = 'finite' if self.low < 0.0 else f'finite and {">" if self.low > 0.0 else ">="} 0'
        raise InputError(name, value, f'{allowed} {unit}'.rstrip(), fix)


MASS = Range(1e-9, 1e12)                 # kg
STIFFNESS = Range(0.0, 1e18)             # N/m
CONTACT_STIFFNESS = Range(1e-6, 1e18)    # N/m: softer is none
DAMPING = Range(0.0, 1e15)               # N s/m
NORMAL_FORCE = Range(0.0, 1e15)          # N
FORCE = Range(-1e15, 1e15)               # N
FORCE_RATE = Range(-1e18, 1e18)          # N/s
COEFFICIENT = Range(0.0, 1e3)
SLOPE = Range(0.0, 1e9)                  # s/m, of a coefficient
SPEED = Range(0.0, 1e6)                  # m/s
LAW_SPEED = Range(1e-12, 1e6)            # m/s, at which something lies in a law; the lowest: an atom in two minutes
VELOCITY = Range(-1e6, 1e6)              # m/s
ACCELERATION = Range(-1e9, 1e9)          # m/s²
RAMP = Range(1e-9, 1e9)                  # m/s², of the drive
PLACE = Range(-1e12, 1e12)               # m
TIME = Range(0.0, 1e15)                  # s
TIME_CONSTANT = Range(1e-12, 1e15)       # s
PHASE = Range(-1e6, 1e6)                 # rad
KATO_EXPONENT = Range(1e-2, 1e2)
TOLERANCE = Range(1e-12, 1.0)            # of a table
FACTOR = Range(0.0, 100.0)                # on all of friction
SHARE = Range(0.0, 1.0)
SCATTER = Range(0.0, 0.5)                # relative standard deviation of a coefficient
