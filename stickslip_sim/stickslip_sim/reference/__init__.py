# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An independent judge: the same model in multiple precision, by other means than the engine.

It shares no equation and no line of numerics with the engine: power series of the motion and roots isolated by
Bernstein coefficients (Descartes' rule of signs), in the arithmetic of mpmath and decimal with any number of digits.

    run = simulate(axis, initial, drive, force, duration=60.0, digits=30)
    run.events, run.final         # in the words of the package, floats correctly rounded
    run.exact.state_at([0.5])     # and in multiple precision
"""

from __future__ import annotations

from ..axis import Axis, InitialState
from ..core.errors import InputError
from ..core.input_profile import InputProfile
from .result import Final, ReferenceRun

__all__ = ['Final', 'ReferenceRun', 'simulate']

FEWEST_DIGITS = 20


def simulate(
    axis: Axis, initial: InitialState, drive: InputProfile, force: InputProfile, duration: float, digits: int = 30,
    load: InputProfile | None = None,
) -> ReferenceRun:
    """Return the run from time 0 to `duration` (s), right to about `digits` digits.

    `drive` is in m/s, `force` in N; a `load` in N is added to the normal force, the sum not to fall below 0.
    Raises InputError when mpmath is missing or an argument has no meaning, and SolverError when the events do not end.
    """
    if not 0.0 <= duration < float('inf'):
        raise InputError('duration', duration, 'finite and >= 0 s', 'give the seconds to simulate')
    if digits < FEWEST_DIGITS:
        raise InputError('digits', digits, f'>= {FEWEST_DIGITS}', 'judging doubles needs more digits than they have')
    try:
        import mpmath  # noqa: F401
    except ImportError:
        raise InputError('mpmath', None, 'installed for the reference', 'pip install mpmath') from None
    from .automaton import run
    from .exact_run import rounded
    from .problem import problem

    return rounded(run(problem(axis, initial, drive, force, load), duration, digits))
