# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The duration of the runs: the longest allowed one, and one that is enough when none is given."""

from ..core.errors import InputError
from ..runs import simulate_events
from ..scene import Scene, changed
from .trial_runs import BY_EXACT

_CYCLES = 20
_SHORTEST, _LONGEST = 10.0, 320.0   # s

_MAX_DURATION = 3600.0               # s: solvers that step take minutes for it


def check_duration(duration: float) -> None:
    """Raise InputError unless all solvers can be run for `duration` s in a bearable time."""
    if not 0.0 < duration <= _MAX_DURATION:
        raise InputError('duration', duration, f'> 0 and <= {_MAX_DURATION:g} s',
                         'every solver runs it, also those of the shortest steps: advise on a part of it')


def default_duration(scene: Scene) -> float:
    """Return 10 s, doubled up to 320 s while the exact solver finds fewer than 20 cycles; 10 s if there are none."""
    exact, duration = changed(scene, BY_EXACT), _SHORTEST
    while True:
        cycles = simulate_events(exact, duration).summary.cycles
        if cycles >= _CYCLES:
            return duration
        if duration >= _LONGEST:
            return _LONGEST if cycles else _SHORTEST
        duration *= 2.0
