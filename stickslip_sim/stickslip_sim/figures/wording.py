# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of a run in words: numbers with their units, and a run in one line."""

import math

from ..friction import StaticLawKind
from ..report.quantity import quantity
from ..scene import Scene
from .catalogue import OF_A_CYCLE, head_of, unit_of
from .cycles import Summary

_IN_A_LINE = 6   # of OF_A_CYCLE


def headline(figures: Summary) -> str:
    """Return the figures of the last cycle in one line, or what happened instead."""
    cycle = figures.last
    if figures.touches:
        return f'{figures.touches} of {figures.cycles} cycles only touch rest: their figures mean nothing'
    if cycle is None:
        return f'{figures.motion}; {100.0 * figures.stick_share:.3g} % of the time in stick'
    shown = (f'{head_of(name)} {quantity(getattr(cycle, name), unit_of(name), 4)}' for name in OF_A_CYCLE[:_IN_A_LINE]
             if not math.isnan(getattr(cycle, name)))   # not measured
    return ('' if figures.settled else 'last cycle: ') + ' · '.join(shown)


def touch_note(figures: Summary) -> str:
    """Say that the counts of a run mean nothing where cycles only touch rest; nothing of another run."""
    if not figures.touches:
        return ''
    return (f'{figures.touches} of {figures.cycles} cycles only touch rest: rounding chooses whether a stick, a turn '
            'or nothing is listed there; the motion is right, the counts and means of sticks and cycles mean nothing')


def miss_note(scene: Scene) -> str:
    """Say that the solver may miss events where it may, and what misses none; nothing of another scene."""
    if scene.solver.name != 'adaptive' or scene.normal_load is None or scene.normal_load.is_stepwise:
        return ''
    without = 'solver.name: exact misses none' if scene.axis.friction.static.kind != StaticLawKind.KATO else (
        'no solver takes Kato\'s law there without')
    return ('under a normal force that varies smoothly the adaptive solver may miss an event: its events depend on its '
            f'tolerances; {without}')
