# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The result of a run of the reference: the words of the package, floats, each the one nearest to the exact value."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ..core.types import Event, Mode

if TYPE_CHECKING:
    from .exact_run import Run


class Final(NamedTuple):
    """The state at the end of a run."""

    position: float  # m
    velocity: float  # m/s
    drive_position: float  # m
    mode: Mode


class ReferenceRun(NamedTuple):
    """`events` and `final` state, correctly rounded; `exact` keeps the values in multiple precision.

    `exact` is the list of events as `exact_run.Event`, and has `state_at(times)`.
    """

    events: list[Event]
    final: Final
    exact: Run
