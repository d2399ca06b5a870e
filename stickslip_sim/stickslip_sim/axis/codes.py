# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The modes and the kinds of events as the records hold them: floats, as all their fields are."""

from ..core.types import EventKind, Mode

STICK = float(Mode.STICK)
ACCELERATING = float(Mode.ACCELERATING)
COASTING = float(Mode.COASTING)
DECELERATING = float(Mode.DECELERATING)
YIELDING = float(Mode.YIELDING)

BREAKAWAY = float(EventKind.BREAKAWAY)
COAST = float(EventKind.COAST)
ACCELERATE = float(EventKind.ACCELERATE)
DECELERATE = float(EventKind.DECELERATE)
ARREST = float(EventKind.STICK)
REVERSE = float(EventKind.REVERSE)
KNOT = float(EventKind.KNOT)
YIELD = float(EventKind.YIELD)
