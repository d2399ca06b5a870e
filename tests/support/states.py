# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of a state of the hot path, compiled or not, changed from outside."""

from typing import Any

from stickslip_sim.axis.state_record import STATE_PLACES


def set_number(state: Any, place: str, number: float) -> None:
    """Set a number of a state, as `next.time`."""
    numbers = state.numbers()
    numbers[STATE_PLACES.index(place)] = number
    state.take(numbers)


def scale_number(state: Any, place: str, factor: float) -> None:
    """Multiply a number of a state."""
    set_number(state, place, factor * state.numbers()[STATE_PLACES.index(place)])
