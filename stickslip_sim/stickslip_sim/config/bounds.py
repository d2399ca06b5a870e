# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How large and how small the numbers of a scene may be.

Every number has bounds, so that no product of them (an energy, a square of a rate) leaves the range of doubles: far
beyond any machine, from the tip of an atomic force microscope to a tectonic plate, and far within 1e±308.
"""

MASS = 1e-9, 1e12                          # kg
STIFFNESS = 1e18                           # N/m
SOFTEST = 1e-6                             # N/m, of a contact: softer is none
DAMPING = 1e15                             # N s/m
FORCE, FORCE_RATE = 1e15, 1e18             # N, N/s
COEFFICIENT = 1e3
SLOPE = 1e9                                # s/m, of a coefficient
SPEED, ACCELERATION = 1e6, 1e9             # m/s, m/s²
LOWEST_SPEED = 1e-12                       # m/s, at which something may lie in a law: an atom in two minutes
PLACE = 1e12                               # m
TIME, SHORTEST = 1e15, 1e-12               # s
PHASE = 1e6                                # rad
KATO = 1e-2, 1e2                           # exponents
FINEST = 1e-12                             # tolerance of a table
