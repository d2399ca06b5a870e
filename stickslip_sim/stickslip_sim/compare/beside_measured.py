# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs over a measured one, as in Fig. 4 of the paper, and the differences of their cycles.

Cycles are found in all of them by one rule, from the speed and with the threshold of the measured run: so a break-away
that is found late in one is found as late in the others.
"""

import json
import math
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

from ..core.errors import RecordingError
from ..core.types import Mode
from ..plots.html_page import figure, html_page, html_table
from ..plots.overlay import DrawnOver, plot_over_measured
from ..recording import MeasuredRun
from ..runs import Run
from ..runs.receipt import versions
from ..runs.slips import events_of_slips
from ..runs.wording import quantity
from ..simulation.cycles import Cycle, Summary, cycle_figures, summary
from .as_measured import AsMeasured
from .pictures import PICTURE_KINDS

_FIGURES = (
    ('period', 'period', 's'), ('stick', 'stick_time', 's'), ('slip', 'slip_time', 's'), ('jump', 'jump', 'm'),
    ('peak speed', 'peak_speed', 'm/s'), ('drive force at break-away', 'break_away_drive_force', 'N'),
    ('drive force at arrest', 'arrest_drive_force', 'N'), ('friction at break-away', 'break_away_force', 'N'),
)
_SHOWN = 2   # cycles
_CAPTION = ('Measured and simulated over each other, as in Fig. 4 of the paper, from a break-away on: (a) forces, '
            '(b) velocity and (c) travel over time; (d) force over velocity.')
_CAPTION_WHOLE = ('Measured and simulated over each other over the same time: (a) forces, (b) velocity and (c) travel; '
                  '(d) force over velocity.')


class CycleDifference(NamedTuple):
    """A figure of the cycles, the mean of the last ones, SI: measured, and of another run (None: it has no cycle)."""

    name: str
    unit: str
    measured: float
    other: float | None

    @property
    def text(self) -> str:
        """Both and their difference, for people."""
        if self.other is None:
            return f'{quantity(self.measured, self.unit)}; no cycle beside it'
        return f'{quantity(self.measured, self.unit)} measured, {quantity(self.other, self.unit)}, {self.share}'

    @property
    def share(self) -> str:
        """The difference in parts of the measured figure."""
        if self.other is None or self.measured == 0.0:
            return '–'
        return f'{100.0 * (self.other - self.measured) / abs(self.measured):+.2f} %'


class Beside(NamedTuple):
    """A run beside the measured one, by its name in the report: how its cycles differ, and what was done to it.

    `position_rmse` (m) is that of a scene simulated as the run was measured; None of another run.
    """

    name: str
    differences: list[CycleDifference]
    notes: Sequence[str]
    position_rmse: float | None

    @property
    def lines(self) -> list[str]:
        """All of it for people, but the differences."""
        rmse = [] if self.position_rmse is None else [
            f'position: {quantity(self.position_rmse, "m")} RMSE over the same time']
        return [*self.notes, *rmse]


def write_beside(runs: Mapping[str, Run], followed: Mapping[str, AsMeasured], folder: Path) -> tuple[str, list[Beside]]:
    """Write picture and report of runs of which the first that was measured is compared with the others.

    Those that were simulated as it was measured are `followed`, too.  Returns its name and the comparisons.  Raises
    RecordingError when it has no cycle, and no position beside which one was simulated.
    """
    name, measured = next((name, run) for name, run in runs.items() if isinstance(run, MeasuredRun))
    threshold = measured.stick_velocity
    found = {each: _figures(run, threshold) for each, run in runs.items()}
    mean = found[name].mean
    if mean is None and not any(one.position_rmse is not None for one in followed.values()):
        raise RecordingError(f'{name}: {found[name].motion}, no complete cycle to be compared; a slip is faster than '
                             f'{threshold * 1e3:.4g} mm/s: import it with another --stick-velocity')
    beside = [Beside(each, _differences(mean, found[each].mean) if mean else [], runs[each].notes,
                     followed[each].position_rmse if each in followed else None) for each in runs if each != name]
    drawn = {each: _drawn(run, threshold, run is measured) if mean else
             DrawnOver(run.samples, -followed[each].zero if each in followed else 0.0, measured.end, run is measured)
             for each, run in runs.items()}
    plot_over_measured(drawn, 'time from a break-away / s' if mean else 'time / s',
                       *(folder / f'overlay.{kind}' for kind in PICTURE_KINDS))
    _report(name, measured, runs, beside, folder)
    return name, beside


def _figures(run: Run, threshold: float) -> Summary:
    return summary(events_of_slips(run.samples, threshold), run.duration, Mode.STICK, run.begin)


def _differences(measured: Cycle, other: Cycle | None) -> list[CycleDifference]:
    """Return the figures that were measured; another run has all, or none."""
    return [CycleDifference(name, unit, getattr(measured, field), None if other is None else getattr(other, field))
            for name, field, unit in _FIGURES
            if not math.isnan(getattr(measured, field)) and not (other and math.isnan(getattr(other, field)))]


def _drawn(run: Run, threshold: float, is_measured: bool) -> DrawnOver:
    """Return the last cycles of a run; all of it without any."""
    cycles = cycle_figures(events_of_slips(run.samples, threshold))[-_SHOWN:]
    zero = cycles[0].begin if cycles else run.begin
    length = sum(cycle.period for cycle in cycles) if cycles else run.duration
    return DrawnOver(run.samples, zero, length, is_measured)


def _report(name: str, measured: MeasuredRun, runs: Mapping[str, Run], beside: list[Beside], folder: Path) -> None:
    notes = {each: list(run.notes) for each, run in runs.items()}
    report: dict[str, Any] = {
        'versions': versions(), 'measured': name, 'stick_velocity': measured.stick_velocity, 'notes': notes,
        'beside': [{'name': one.name, 'position_rmse': one.position_rmse,
                    'figures': [each._asdict() for each in one.differences]} for one in beside],
    }
    (folder / 'report.json').write_text(json.dumps(report, indent=1, allow_nan=False) + '\n', encoding='utf-8')
    body = [f'<h1>{escape(name)}, measured, and {escape(", ".join(one.name for one in beside))}</h1>']
    body += [f'<p class="note">{escape(note)}</p>' for note in notes[name]]
    has_cycles = any(one.differences for one in beside)
    body.append(figure(folder / 'overlay.svg', _CAPTION if has_cycles else _CAPTION_WHOLE))
    for one in beside:
        body += [f'<p>{escape(f"{one.name}: {line}")}</p>' for line in one.lines]
        if not one.differences:
            continue
        rows = [[each.name, quantity(each.measured, each.unit),
                 '–' if each.other is None else quantity(each.other, each.unit), each.share]
                for each in one.differences]
        body.append(html_table('Cycles: means of the last ten, found by one rule in both',
                          ['', name, one.name, 'difference'], rows))
    (folder / 'report.html').write_text(html_page(f'{name}, measured', body), encoding='utf-8')
