# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of a run in words: numbers with their units, and a run in one line."""

import math
from collections.abc import Sequence

from ..friction import StaticLawKind
from ..scene import Scene
from ..simulation.cycles import Summary

CYCLE_FIGURES = (
    ('period', 'period', 's'), ('stick', 'stick_time', 's'), ('slip', 'slip_time', 's'), ('jump', 'jump', 'm'),
    ('peak speed', 'peak_speed', 'm/s'), ('break-away force', 'break_away_force', 'N'),
    ('drive force at arrest', 'arrest_drive_force', 'N'), ('static coefficient', 'static_coefficient', ''),
)
_PREFIXES = ((1e3, 'k'), (1.0, ''), (1e-3, 'm'), (1e-6, 'µ'), (1e-9, 'n'))
_IN_A_LINE = 6   # of CYCLE_FIGURES


def quantity(value: float, unit: str, digits: int = 5) -> str:
    """Return a number, and its unit with the prefix that suits it: 659.07 ms."""
    if not unit or value == 0.0 or not math.isfinite(value):
        return f'{value:.{digits}g} {unit}'.rstrip()
    if unit == 'kg' and abs(value) < 1.0:    # it has a prefix already
        return quantity(1e3 * value, 'g', digits)
    scale, prefix = next(((s, p) for s, p in _PREFIXES if abs(value) >= s), _PREFIXES[-1])
    if unit in ('s', 'kg') and scale > 1.0:
        scale, prefix = 1.0, ''
    number = f'{value / scale:.{digits}g}'
    if abs(value / scale) < 1e3 and 'e' in number:    # 4.6e+02
        number = f'{float(number):.0f}'
    return f'{number} {prefix}{unit}'


def quantities(values: Sequence[float], unit: str, digits: int = 5) -> list[str]:
    """Return numbers that are read beside each other: all with the prefix that suits the one in the middle."""
    middle = sorted(values)[len(values) // 2]
    if unit == 'kg' and 0.0 < abs(middle) < 1.0:
        return quantities([1e3 * value for value in values], 'g', digits)
    first = quantity(middle, unit, digits).rpartition(' ')[2]
    scale = next((s for s, p in _PREFIXES if unit and first == f'{p}{unit}'), 1.0)
    if any(abs(value) >= scale * 10.0 ** digits for value in values):   # it would be written as a power of ten
        return [quantity(value, unit, digits) for value in values]
    return [f'{value / scale:.{digits}g} {first if unit else ""}'.rstrip() for value in values]


def headline(figures: Summary) -> str:
    """Return the figures of the last cycle in one line, or what happened instead."""
    cycle = figures.last
    if figures.touches:
        return f'{figures.touches} of {figures.cycles} cycles only touch rest: their figures mean nothing'
    if cycle is None:
        return f'{figures.motion}; {100.0 * figures.stick_share:.3g} % of the time in stick'
    shown = (f'{name} {quantity(getattr(cycle, field), unit, 4)}' for name, field, unit in CYCLE_FIGURES[:_IN_A_LINE]
             if not math.isnan(getattr(cycle, field)))   # not measured
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
