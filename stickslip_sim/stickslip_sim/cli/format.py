# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of a run as text for people."""

from ..core.types import EventKind
from ..runs.wording import CYCLE_FIGURES, quantity, touch_note
from ..simulation.cycles import Cycle, Summary
from .count_words import counted


def summary_lines(figures: Summary) -> list[str]:
    """Return a short table: the events by kind, the kind of motion, the cycle figures."""
    counts = ', '.join(f'{n} {kind.name.lower()}' for kind, n in figures.events.items()
                       if n and kind != EventKind.KNOT)
    note = touch_note(figures)
    return [f'{"events":22} {counts or "none"}', f'{"motion":22} {_motion(figures)}',
            *([f'{"note":22} {note}'] if note else []), *_cycle_lines(figures)]


def beside_lines(recorded: Summary, other: Summary) -> list[str]:
    """Return the figures of two runs beside each other: kind of motion, break-aways, means of the last cycles."""
    both = recorded, other
    rows = [('', ['recorded', 'what if']), ('motion', [figures.motion for figures in both]),
            ('time in stick', [f'{100.0 * figures.stick_share:.4g} %' for figures in both]),
            ('break-aways', [str(figures.events[EventKind.BREAKAWAY]) for figures in both]),
            ('complete cycles', [str(figures.cycles) for figures in both])]
    rows += [(name, [quantity(getattr(figures.mean, field), unit) if figures.mean else '–' for figures in both])
             for name, field, unit in CYCLE_FIGURES if recorded.mean or other.mean]
    return [f'{name:22} {a:>14} {b:>14}'.rstrip() for name, (a, b) in rows]


def _motion(figures: Summary) -> str:
    text = f'{figures.motion}, {100.0 * figures.stick_share:.4g} % of the time in stick'
    if figures.cycles:
        text += f'; {counted(figures.cycles, "cycle")}'
        text += ', settled' if figures.settled else ', not settled'
    return text


def _cycle_lines(figures: Summary) -> list[str]:
    if figures.last is None or figures.mean is None:
        return []
    lines = [f'{"":22} {"last cycle":>14} {f"mean of {figures.averaged}":>14}']
    return lines + [_cycle_line(figures.last, figures.mean, *line) for line in CYCLE_FIGURES]


def _cycle_line(last: Cycle, mean: Cycle, name: str, field: str, unit: str) -> str:
    return f'{name:22} {quantity(getattr(last, field), unit):>14} {quantity(getattr(mean, field), unit):>14}'
