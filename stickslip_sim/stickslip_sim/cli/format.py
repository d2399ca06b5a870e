# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of a run as text for people."""

import math

from ..core.types import EventKind
from ..simulation.cycles import Cycle, Summary

_PREFIXES = ((1e3, 'k'), (1.0, ''), (1e-3, 'm'), (1e-6, 'µ'), (1e-9, 'n'))
_LINES = (
    ('period', 'period', 's'), ('stick', 'stick_time', 's'), ('slip', 'slip_time', 's'), ('jump', 'jump', 'm'),
    ('peak speed', 'peak_speed', 'm/s'), ('break-away force', 'break_away_force', 'N'),
    ('drive force at arrest', 'arrest_drive_force', 'N'), ('static coefficient', 'static_coefficient', ''),
)


def quantity(value: float, unit: str, digits: int = 5) -> str:
    """Return a number, and its unit with the prefix that suits it: 659.07 ms."""
    if not unit or value == 0.0 or not math.isfinite(value):
        return f'{value:.{digits}g} {unit}'.rstrip()
    scale, prefix = next(((s, p) for s, p in _PREFIXES if abs(value) >= s), _PREFIXES[-1])
    if unit == 's' and scale > 1.0:
        scale, prefix = 1.0, ''
    return f'{value / scale:.{digits}g} {prefix}{unit}'


def headline(figures: Summary) -> str:
    """Return the figures of the last cycle in one line, or the motion where there is no cycle."""
    cycle = figures.last
    if cycle is None:
        return f'{figures.motion}; {100.0 * figures.stick_share:.3g} % of the time in stick'
    shown = (f'{name} {quantity(getattr(cycle, field), unit, 4)}' for name, field, unit in _LINES[:6])
    return ('' if figures.settled else 'last cycle: ') + ' · '.join(shown)


def summary_lines(figures: Summary) -> list[str]:
    """Return a short table: the events by kind, the kind of motion, the cycle figures."""
    counts = ', '.join(f'{n} {kind.name.lower()}' for kind, n in figures.events.items()
                       if n and kind != EventKind.KNOT)
    return [f'{"events":22} {counts or "none"}', f'{"motion":22} {_motion(figures)}', *_cycle_lines(figures)]


def beside_lines(recorded: Summary, other: Summary) -> list[str]:
    """Return the figures of two runs beside each other: kind of motion, break-aways, means of the last cycles."""
    both = recorded, other
    rows = [('', ['recorded', 'what if']), ('motion', [figures.motion for figures in both]),
            ('time in stick', [f'{100.0 * figures.stick_share:.4g} %' for figures in both]),
            ('break-aways', [str(figures.events[EventKind.BREAKAWAY]) for figures in both]),
            ('complete cycles', [str(figures.cycles) for figures in both])]
    rows += [(name, [quantity(getattr(figures.mean, field), unit) if figures.mean else '–' for figures in both])
             for name, field, unit in _LINES if recorded.mean or other.mean]
    return [f'{name:22} {a:>14} {b:>14}'.rstrip() for name, (a, b) in rows]


def _motion(figures: Summary) -> str:
    text = f'{figures.motion}, {100.0 * figures.stick_share:.4g} % of the time in stick'
    if figures.cycles:
        text += f'; {figures.cycles} cycle{"s" if figures.cycles > 1 else ""}'
        text += ', settled' if figures.settled else ', not settled'
    return text


def _cycle_lines(figures: Summary) -> list[str]:
    if figures.last is None or figures.mean is None:
        return []
    lines = [f'{"":22} {"last cycle":>14} {f"mean of {figures.averaged}":>14}']
    return lines + [_cycle_line(figures.last, figures.mean, *line) for line in _LINES]


def _cycle_line(last: Cycle, mean: Cycle, name: str, field: str, unit: str) -> str:
    return f'{name:22} {quantity(getattr(last, field), unit):>14} {quantity(getattr(mean, field), unit):>14}'
