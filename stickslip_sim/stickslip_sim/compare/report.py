# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A comparison for people, and as a folder: pictures, `report.json` with all figures, `report.html` with everything."""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..advise.trial_runs import default_duration
from ..check.limits import load_limits
from ..check.report import check_run, checks_as_values, complaint, control_figures, matrix, plot_runs
from ..core.types import Progress
from ..figures.catalogue import head_of, read_in, unit_of
from ..figures.cycles import headline
from ..plots.style import labelled
from ..recording import MeasuredRun
from ..report.html import write_page
from ..report.model import NOTE, OTHER, Part, Picture, Section, Sentence, Table, facts
from ..report.values import versions
from ..runs import Run
from ..runs.report import named_apart
from ..scene import Scene
from .cycle_figures import figures_of, write_beside
from .fresh import AsMeasured, as_measured, simulate_densely
from .pictures import PICTURE_KINDS, draw
from .statements import Finding, Statement, StatementOutcome, findings_on

_SHOWN = 12   # cycles of a run that are listed, the first and the last of them
_CYCLE = tuple((head_of(name), name, *(('kN', 1e-3) if unit_of(name) == 'N' else read_in(unit_of(name)))) for name in (
    'begin', 'period', 'stick_time', 'slip_time', 'jump', 'peak_speed', 'peak_acceleration', 'break_away_force',
    'rest_time'))
_RING = (('undamped frequency', 'frequency', 'Hz'), ('damped frequency', 'damped_frequency', 'Hz'),
         ('damping ratio', 'damping_ratio', ''), ('decay', 'decay', '1/s'))
_MARKS = {'holds': Sentence('✓ holds', 'holds'), 'does not hold': Sentence('✗ does not hold', 'fails'),
          'not applicable': Sentence('– not applicable', OTHER)}
_OF_RUNS, _OF_FINDINGS = 0.2, 0.3   # of the time, about; of what is left after the runs


class Compared(NamedTuple):
    """A run under the name that it has in the report, and what came of the paper's statements on it."""

    name: str
    run: Run
    findings: list[tuple[Statement, Finding]]

    @property
    def failed(self) -> list[str]:
        """The names of the statements that apply and do not hold."""
        return [statement.name for statement, finding in self.findings if finding.outcome == StatementOutcome.FAILS]

    @property
    def report(self) -> Section:
        """The run in one line, and what holds on it."""
        return Section(f'{self.name}: {headline(self.run.summary)}', [
            *(Sentence(note, NOTE) for note in self.run.notes),
            facts([(finding.outcome.value, f'{statement.name}: {finding.text}')
                   for statement, finding in self.findings], 14)])


def write_comparison(given: Sequence[Run | Scene], sources: Sequence[str], duration: float | None, folder: Path,
                     progress: Progress = None) -> tuple[list[Part], list[str]]:
    """Write the report of runs and scenes, named in `sources`, into a folder that exists; scenes run `duration` s.

    Returns it for people, and the statements that apply to a run and do not hold.  Where a run was measured, the others
    are compared with it alone.
    """
    for one in given:    # what cannot be read is refused before the work begins
        _ = isinstance(one, Scene) or (one.begin, one.events, isinstance(one, MeasuredRun) or one.scene)
    measured = next((one for one in given if isinstance(one, MeasuredRun)), None)
    if measured is not None:
        followed = [as_measured(one, source, measured, duration) if isinstance(one, Scene) else one
                    for one, source in zip(given, sources)]
        named = named_apart(one.run if isinstance(one, AsMeasured) else one for one in followed)
        beside = {name: one for name, one in zip(named, followed) if isinstance(one, AsMeasured)}
        return write_beside(named, beside, folder), []
    found: list[Run] = []
    for one in given:
        found.append(one if not isinstance(one, Scene) else simulate_densely(
            one, default_duration(one) if duration is None else duration))
        if progress:
            progress(_OF_RUNS * len(found) / len(given))
    compared = write_report(named_apart(found), folder, progress and (
        lambda share: progress(_OF_RUNS + (1.0 - _OF_RUNS) * share)))
    return [one.report for one in compared], [f'{one.name}: {name}' for one in compared for name in one.failed]


def write_report(runs: Mapping[str, Run], folder: Path, progress: Progress = None) -> list[Compared]:
    """Draw runs by their names, and hold them to the statements, into a folder that exists.

    Raises OSError when the disk refuses.
    """
    found = []
    for k, (name, run) in enumerate(runs.items()):
        found.append(Compared(name, run, findings_on(run)))
        if progress:
            progress(_OF_FINDINGS * (k + 1) / len(runs))
    report: dict[str, Any] = {'versions': versions(), 'runs': [figures_of(*each) for each in found]}
    pictures = draw(runs, folder, progress and (lambda share: progress(_OF_FINDINGS + (1.0 - _OF_FINDINGS) * share)))
    report['pictures'] = pictures
    write_page(folder, 'Stick-slip: ' + ', '.join(runs), page(report, folder), report)
    return found


def page(report: dict[str, Any], folder: Path) -> Iterator[Part]:
    """Yield the parts of the page; the pictures are taken from their SVG files in the folder."""
    runs = report['runs']

    def pictures(name: str) -> Iterator[Part]:
        return (Picture(folder / f'{one.name}.svg', one.caption) for one in report['pictures'] if one.run == name)

    yield from (_overview(runs), *pictures(''))
    for run in runs:
        yield Section(run['name'], [*_origin(run), _statements(run), *pictures(run['name']), _cycles(run),
                                    *_ring_down(run)])
    yield Sentence(', '.join(f'{name} {version}' for name, version in report['versions'].items()), OTHER)


def _overview(runs: Sequence[dict[str, Any]]) -> Table:
    """Return the last cycle of each run beside those of the others."""
    rows = [[labelled(name, unit), *(_cell(run['cycles'][-1][field], scale) if run['cycles'] else '–' for run in runs)]
            for name, field, unit, scale in _CYCLE[1:]]
    motion = ['motion', *(run['motion'] + (', settled' if run['settled'] else '') for run in runs)]
    return Table(['', *(run['name'] for run in runs)], [motion, *rows], 'The last complete cycle')


def _origin(run: dict[str, Any]) -> Iterator[Part]:
    yield (f'Scene {run["scene"]} ({run["scene_hash"][:12]}), {run["source"]}; t = {run["begin"]:g} … {run["end"]:g} s;'
           f' {100.0 * run["stick_share"]:.4g} % of the time in stick.')
    yield from (Sentence(note, NOTE) for note in run['notes'])


def _statements(run: dict[str, Any]) -> Table:
    return Table((), [(one['text'], _MARKS[one['outcome']], one['finding']) for one in run['statements']],
                 'What the paper says, on this run', texts=(0, 1, 2))


def _cycles(run: dict[str, Any]) -> Part:
    """Return the first and the last cycles, each with its difference from the one before."""
    cycles, changes = run['cycles'], ['–', *(f'{change:.1e}' for change in run['convergence'])]
    if not cycles:
        return 'No complete cycle.'
    rows = [[str(k + 1), *(_cell(cycle[field], scale) for _, field, _, scale in _CYCLE), changes[k]]
            for k, cycle in enumerate(cycles)]
    if len(rows) > _SHOWN:
        rows = [*rows[:_SHOWN // 2], ['…'] * len(rows[0]), *rows[-_SHOWN // 2:]]
    caption = 'Cycles; the change is relative, of the figure that changes most'
    if run['contraction'] is not None:
        caption += f', and becomes {run["contraction"]:.3g} times as large with each cycle'
    return Table(['cycle', *(labelled(name, unit) for name, _, unit, _ in _CYCLE), 'change'], rows, caption)


def _ring_down(run: dict[str, Any]) -> Iterator[Part]:
    form, found = run['ring_down']['closed_form'], run['ring_down']['identified']
    if form is not None:
        yield Table(('', 'identified from the motion', 'closed form'),
                    [[labelled(name, unit), _cell(found[field] if found else None, 1.0), _cell(form[field], 1.0)]
                     for name, field, unit in _RING], 'Ring-down after a slip')


def _cell(value: Any, scale: float) -> str:
    if value is None:
        return '–'
    number = float(value) * scale   # 'inf' is a text in a report
    return f'{number:.6g}' if math.isfinite(number) else '∞'


# Runs of controllers side by side: a picture with a column for each, their figures of control, their limits.

_CAPTION = ('Speed, error and drive force of each run; blue: the slider sticks.  The error is that to the setpoint, or '
            'to the drive where a run has none.')


def write_controllers(runs: Mapping[str, Run], limits_file: str | None, window: tuple[float, float] | None, folder: Path
                      ) -> tuple[list[Part], str]:
    """Write picture and report of runs by their names, in a window (s) or where they move, into a folder that exists.

    Returns the report for people, and which limits were not kept.  Raises InputError and RecordingError.
    """
    limits = None if limits_file is None else load_limits(limits_file)
    begin, end = plot_runs(runs, *(folder / f'controllers.{kind}' for kind in PICTURE_KINDS), limits=limits,
                           window=window, columns=True)
    figures = [check_run(name, run, control_figures(run, (begin, end), limits)) for name, run in runs.items()]
    checked = [check_run(name, run, limits) for name, run in runs.items()] if limits else []
    tables: list[Part] = [f'from t = {begin:g} to {end:g} s:', matrix(figures)]
    if checked:
        tables += [f'limits of {limits_file}:', matrix(checked)]
    write_page(folder, 'Controllers: ' + ', '.join(runs), [Picture(folder / 'controllers.svg', _CAPTION), *tables], {
        'versions': versions(), 'window': [begin, end],
        'figures': {one.name: {outcome.name: outcome.value for outcome in one.outcomes} for one in figures},
        'limits': checks_as_values(checked) if checked else None})
    return tables, '; '.join(filter(None, (complaint(one, str(limits_file)) for one in checked)))
