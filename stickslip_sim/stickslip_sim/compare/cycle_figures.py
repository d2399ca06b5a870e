# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The cycle figures of a run, its ring-down, and how it converges: what `report.json` holds."""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..core.errors import InputError, RecordingError
from ..core.types import Mode
from ..figures.catalogue import head_of, unit_of
from ..figures.cycles import Cycle, Summary, cycle_figures, summary
from ..figures.distance import cycle_difference
from ..figures.slips import events_of_slips
from ..plots.overlay import DrawnOver, plot_over_measured
from ..recording import MeasuredRun
from ..report.html import write_page
from ..report.model import NOTE, Part, Picture, Section, Sentence, Table, facts
from ..report.quantity import quantity
from ..report.values import plain, versions
from ..runs import Run
from .fresh import AsMeasured
from .pictures import PICTURE_KINDS
from .ring_down import RING_DOWN, SLIP_PEAKS, closed_form, identified, peak_accelerations
from .statements import Finding, Statement, observed

_ROUNDING = 1e-10   # relative: a smaller difference of two cycles says nothing of how they converge


def convergence(cycles: Sequence[Cycle]) -> list[float]:
    """Return by how much each cycle differs from the one before, relative."""
    return [cycle_difference(before, cycle) for before, cycle in pairwise(cycles)]


def contraction(changes: Sequence[float]) -> float | None:
    """Return the factor by which the difference from cycle to cycle shrinks; None while there are no two to compare."""
    ratios = [after / before for before, after in pairwise(changes) if after > _ROUNDING]
    return float(np.median(ratios)) if ratios else None


def figures_of(name: str, run: Run, findings: Sequence[tuple[Statement, Finding]]) -> dict[str, Any]:
    """Return all figures of a run by its name, as JSON values, in SI; an infinite number is the text 'inf'."""
    outline, form, found = run.summary, closed_form(run.scene.axis), observed(run).found
    ring = identified(found[RING_DOWN])
    changes = convergence(run.cycles())
    figures = {
        'name': name, 'source': run.source, 'notes': list(run.notes),
        'scene': run.scene.name, 'scene_hash': run.scene.hash,
        'begin': run.begin, 'end': run.end, 'motion': outline.motion, 'settled': outline.settled,
        'stick_share': outline.stick_share,
        'cycles': [{**cycle._asdict(), 'peak_acceleration': peak}
                   for cycle, peak in zip(run.cycles(), peak_accelerations(run, found[SLIP_PEAKS]))],
        'convergence': changes, 'contraction': contraction(changes),
        'ring_down': {'identified': ring and ring._asdict(), 'closed_form': form and form._asdict()},
        'statements': [{'name': statement.name, 'text': statement.text, 'outcome': finding.outcome.value,
                        'finding': finding.text, 'figures': finding.figures} for statement, finding in findings],
    }
    result: dict[str, Any] = plain(figures)
    return result


# Runs over a measured one, as in Fig. 4 of the paper, and the differences of their cycles.
#
# Cycles are found in all of them by one rule, from the speed and with the threshold of the measured run: so a
# break-away that is found late in one is found as late in the others.

_FIGURES = {**{name: head_of(name) for name in ('period', 'stick_time', 'slip_time', 'jump', 'peak_speed',
                                                'break_away_drive_force', 'arrest_drive_force')},
            'break_away_force': 'friction at break-away'}   # beside the force of the drive
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


def write_beside(runs: Mapping[str, Run], followed: Mapping[str, AsMeasured], folder: Path) -> list[Part]:
    """Write picture and report of runs of which the first that was measured is compared with the others.

    Those that were simulated as it was measured are `followed`, too.  Returns the differences for people.  Raises
    RecordingError when it has no cycle, and no position beside which one was simulated, InputError when it is alone.
    """
    if len(runs) < 2:
        raise InputError('RUN_OR_SCENE', next(iter(runs.values())).name, 'two runs or more with a measured one',
                         'add a scene, or the run of one')
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
    write_page(folder, f'{name}, measured, and {", ".join(one.name for one in beside)}',
               _page(name, measured.notes, beside, folder),
               {'versions': versions(), 'measured': name, 'stick_velocity': measured.stick_velocity,
                'notes': {each: list(run.notes) for each, run in runs.items()},
                'beside': [{'name': one.name, 'position_rmse': one.position_rmse, 'figures': one.differences}
                           for one in beside]})
    return beside_report(name, measured.notes, beside)


def beside_report(name: str, notes: Sequence[str], beside: Sequence[Beside]) -> list[Part]:
    """Return the differences for people."""
    return [*(f'{name}: {note}' for note in notes),
            *(Section(f'{one.name} beside {name}{", means of the last ten cycles" if one.differences else ""}:',
                      [*one.lines, facts([(each.name, each.text) for each in one.differences], 24)])
              for one in beside)]


def _figures(run: Run, threshold: float) -> Summary:
    return summary(events_of_slips(run.samples, threshold), run.duration, Mode.STICK, run.begin)


def _differences(measured: Cycle, other: Cycle | None) -> list[CycleDifference]:
    """Return the figures that were measured; another run has all, or none."""
    return [CycleDifference(label, unit_of(name), getattr(measured, name), other and getattr(other, name))
            for name, label in _FIGURES.items()
            if not math.isnan(getattr(measured, name)) and not (other and math.isnan(getattr(other, name)))]


def _drawn(run: Run, threshold: float, is_measured: bool) -> DrawnOver:
    """Return the last cycles of a run; all of it without any."""
    cycles = cycle_figures(events_of_slips(run.samples, threshold))[-_SHOWN:]
    zero = cycles[0].begin if cycles else run.begin
    length = sum(cycle.period for cycle in cycles) if cycles else run.duration
    return DrawnOver(run.samples, zero, length, is_measured)


def _page(name: str, notes: Sequence[str], beside: list[Beside], folder: Path) -> Iterator[Part]:
    yield from (Sentence(note, NOTE) for note in notes)
    has_cycles = any(one.differences for one in beside)
    yield Picture(folder / 'overlay.svg', _CAPTION if has_cycles else _CAPTION_WHOLE)
    for one in beside:
        yield from (f'{one.name}: {line}' for line in one.lines)
        if one.differences:
            yield Table(('', name, one.name, 'difference'), [
                (each.name, quantity(each.measured, each.unit),
                 '–' if each.other is None else quantity(each.other, each.unit), each.share)
                for each in one.differences], 'Cycles: means of the last ten, found by one rule in both')
