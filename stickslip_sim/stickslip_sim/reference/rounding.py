# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From multiple precision to the floats of the package."""

from __future__ import annotations

import mpmath
from mpmath import mpf

from ..core import types
from . import exact_run
from .result import Final, ReferenceRun

_KINDS = {kind.name.lower(): kind for kind in types.EventKind}


def rounded(run: exact_run.Run) -> ReferenceRun:
    """Return the run with its numbers rounded to floats."""
    with mpmath.workdps(run.digits):
        return ReferenceRun([_event(event) for event in run], _final(run), run)


def _event(event: exact_run.Event) -> types.Event:
    second, fraction = split(event.time)
    return types.Event(
        second,
        fraction,
        _KINDS[event.kind],
        event.mode,
        event.direction,
        float(event.position),
        float(event.velocity),
        float(event.drive_position),
        float(event.drive_force),
        float(event.friction_force),
        float(event.static_coefficient),
        float(event.rest_time),
    )


def split(time: mpf) -> tuple[float, float]:
    """Return whole seconds and the rest, which is the nearest float below 1 s."""
    second = mpmath.floor(time)
    fraction = float(time - second)
    return (float(second), fraction) if fraction < 1.0 else (float(second) + 1.0, 0.0)


def _final(run: exact_run.Run) -> Final:
    end = run.final
    return Final(float(end.position), float(end.velocity), float(end.drive_position), end.mode)
