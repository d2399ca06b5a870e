# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Statement: from several starts the motion converges to one stable limit cycle."""

import math
from collections.abc import Iterator, Sequence

from ..axis import InitialState
from ..runs import Run
from ..simulation.cycles import Cycle
from .long_runs import CYCLES, distance, last_cycles, lasts, longest_period
from .look import look_at
from .statement import Finding, Statement, found, not_applicable

_SAME = 1e-6   # relative difference of two limit cycles that are one


def _finding(run: Run, _: Sequence[object]) -> Finding:
    """Start the axis of this run in other ways, with the same inputs, and compare the cycles that it ends in."""
    inputs = look_at(run).steady
    if inputs is None:
        return not_applicable('drive or force are not constant')
    if not lasts(run.cycles(), run.end):
        return not_applicable(f'stick-slip does not last: {len(run.cycles())} complete cycles')
    own = run.cycles()[-1]
    ends = {label: last_cycles(run.scene.axis, start, inputs, longest_period(run.cycles()))
            for label, start in _starts(run, own)}
    strays = [label for label, cycles in ends.items() if not cycles]
    if strays:
        return found(False, f'stick-slip does not last from {len(strays)} of {len(ends)} starts: {", ".join(strays)}',
                     starts=len(ends), without_cycle=len(strays))
    reference, *others = ends.values()
    spread = max(distance(reference[-1], cycles) for cycles in others)
    is_one, apart, end = spread <= _SAME, distance(own, reference), reference[-1]
    text = (f'{len(ends)} starts ({", ".join(ends)}) end after {CYCLES} cycles in {"one" if is_one else "several"}, '
            f'{spread:.1g} apart; period {end.period:.6g} s, jump {end.jump * 1e3:.6g} mm; the last of the '
            f'{len(run.cycles())} of this run is {apart:.1g} from it')
    return found(is_one, text, starts=len(ends), spread=spread, period=end.period, jump=end.jump, own_difference=apart)


def _starts(run: Run, own: Cycle) -> Iterator[tuple[str, InitialState]]:
    """Yield starts at rest, for any time before, and in motion, both ways."""
    rests = [0.0, 0.5 * own.stick_time]
    if run.scene.axis.friction.static.bounded:
        rests.append(math.inf)
    for rest in rests:
        yield f'rested {rest:.3g} s', InitialState(rest_time=rest)
    for share in (-0.5, 0.5, 2.0):
        velocity = share * own.peak_speed
        yield f'at {velocity * 1e3:.3g} mm/s', InitialState(velocity=velocity, rest_time=0.0)


LIMIT_CYCLE = Statement('stable limit cycle', 'From several starts the motion converges to one stable limit cycle.',
                        _finding)
