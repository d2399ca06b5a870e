# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What checking, verifying and asking what if found: for people, as JSON values and as JUnit XML; SI units."""

import math
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from ..core.errors import InputError, check_kind
from ..core.paths import check_picture_name
from ..core.types import EventKind
from ..figures.catalogue import OF_A_CYCLE, head_of, label_of, unit_of
from ..figures.circular import QUADRANTS, SENSES, CircularTest
from ..figures.positioning import PositionFigures, positioning_figures
from ..recording import MeasuredRun, RecordedRun
from ..report.model import NOTE, Part, Sentence, Table
from ..report.quantity import quantity
from ..report.values import json_text
from ..runs import Run
from ..scene.load import values_in_file
from ..scene.values import scene_text
from .limits import Limit, LimitOutcome, Limits, Window, load_limits, outcomes_of, positions_of
from .measures import KINDS, TIMING_LIMIT
from .observed_run import commands_of, first_command_of, gaps_in, observed_motion, timing_of, unmeasured
from .remake import made_with
from .verification import Verdict

if TYPE_CHECKING:
    from ..runs.picture import RunBeside

IsoTest = CircularTest | Sequence[PositionFigures]
_OF_BOTH = 'bidirectional_circular_deviation', 'mean_radial_deviation'
_TWO_WAY = 'positioning_accuracy', 'positioning_repeatability', 'systematic_positioning_error'
_OF_A_TARGET = 'mean_forward', 'mean_backward', 'mean', 'reversal', 's_forward', 's_backward', 'repeatability'


def iso_parts(test: IsoTest) -> Iterator[Part]:
    """Yield tables of a test for people."""
    yield from _circle(test) if isinstance(test, CircularTest) else _positions(test)


def iso_values(test: IsoTest) -> dict[str, Any]:
    """Return the same by name, in m, for JSON."""
    if not isinstance(test, CircularTest):
        return {'positioning': {**positioning_figures(test)._asdict(), 'targets': [
            {'target': one.target, **{name: getattr(one, name) for name in _OF_A_TARGET}} for one in test]}}
    turns = [{'sense': SENSES[turn.sense], 'circular_deviation': turn.circular_deviation,
              'largest_radial_deviation': turn.largest, 'smallest_radial_deviation': turn.smallest,
              'quadrant_glitches': turn.glitches} for turn in test.turns]
    both = {name: getattr(test, name) for name in _OF_BOTH} if test.is_bidirectional else {}
    return {'circle': {'nominal': test.nominal, 'turns': turns, **both}}


def _circle(test: CircularTest) -> Iterator[Part]:
    x, y, radius = (quantity(value, 'm') for value in test.nominal)
    yield f'ISO 230-4: circle of radius {radius} about x = {x}, y = {y}'
    rows: list[tuple[str, list[float | None]]] = [
        ('G, circular deviation', [turn.circular_deviation for turn in test.turns]),
        ('F max, radial deviation', [turn.largest for turn in test.turns]),
        ('F min', [turn.smallest for turn in test.turns]),
        *((f'quadrant glitch at {name}', [turn.glitches.get(name) for turn in test.turns]) for name in QUADRANTS)]
    yield Table(('', *(SENSES[turn.sense] for turn in test.turns)),
                [(label, *('–' if value is None else quantity(value, 'm') for value in values))
                 for label, values in rows])
    if test.is_bidirectional:
        yield (f'G(b) {quantity(test.bidirectional_circular_deviation, "m")}, '
               f'D {quantity(test.mean_radial_deviation, "m")}')


def _positions(positions: Sequence[PositionFigures]) -> Iterator[Part]:
    figures = positioning_figures(positions)._asdict()
    yield f'ISO 230-2: {len(positions)} targets'
    yield Table(('target', *(f'{head} / µm' for head in ('mean ↑', 'mean ↓', 'mean', 'B', 's ↑', 's ↓', 'R'))),
                [(quantity(one.target, 'm'), *(_micrometres(getattr(one, name)) for name in _OF_A_TARGET))
                 for one in positions], texts=())
    yield Table(('', 'bi-directional', 'forward', 'backward'),
                [*((label_of(name), *(quantity(figures[name + way], 'm') for way in ('', '_forward', '_backward')))
                   for name in _TWO_WAY),
                 *((label_of(name), quantity(figures[name], 'm'), '', '')
                   for name in ('mean_positioning_error', 'reversal_error', 'mean_reversal_error'))])


def _micrometres(value: float) -> str:
    """Return a length to a tenth of a nanometre, without a sign before 0."""
    return f'{round(1e6 * value, 4) + 0.0:.4f}'


_MOST_BESIDE = 8   # runs in a picture


class Checked(NamedTuple):
    """A run that was checked, under the name that it has in what is written about it; None: runs of two axes.

    `test` has all figures of ISO 230 that were asked for.
    """

    name: str
    run: Run | None
    outcomes: Sequence[LimitOutcome]
    test: IsoTest | None = None

    @property
    def passed(self) -> bool:
        """Whether all limits were kept."""
        return not failures(self.outcomes)


def check_run(name: str, run: Run, limits: Limits, positioning: bool = False) -> Checked:
    """Return a run as it was checked, with all figures of `positioning`; raises InputError and RecordingError."""
    return Checked(name, run, outcomes_of(limits, run), positions_of(limits, run) if positioning else None)


def draw_test(checked: Checked, path: Path) -> None:
    """Draw the circle of a check."""
    from ..plots.polar import plot_circle  # matplotlib takes half a second

    assert isinstance(checked.test, CircularTest)
    plot_circle(checked.test, checked.name, path)


def verdict_line(checked: Checked) -> str:
    """Return passed or failed, of how many, and which failed."""
    _, run, outcomes, _ = checked
    failed = failures(outcomes)
    if failed:
        return f'FAILED: {len(failed)} of {len(outcomes)}: {", ".join(failed)}'
    timing = timing_of(run) if run and run.is_complete else None
    doubt = ', but the run is not valid in real time' if timing and timing.valid is False else ''
    return f'PASSED: {len(outcomes)} of {len(outcomes)}{doubt}'


def checked_line(checked: Checked) -> str:
    """Return what was checked: from when to when, how much is known of it, and when its first command came."""
    name, run, *_ = checked
    if run is None:
        return name
    motion, commands = observed_motion(run), commands_of(run)
    text = (f'{name}: {motion.begin:g} to {motion.end:g} s, {motion.states} states, '
            f'{len(motion.events)} transitions')
    if commands is None:
        return text
    return f'{text}, {"no command" if commands.first is None else f"first command at t = {commands.first:g} s"}'


def real_time_verdict(run: Run | None) -> str:
    """Return what the node said of its timing at the end of a run; empty without that."""
    timing = timing_of(run) if run and run.is_complete else None
    return timing.verdict if timing else ''


def complaint(checked: Checked, limits_file: str) -> str:
    """Return in one line why a run did not pass, empty when it did."""
    name, _, outcomes, _ = checked
    missed = [outcome.name for outcome in outcomes if not (outcome.passed or outcome.is_unchecked)]
    unchecked = [outcome.name for outcome in outcomes if outcome.is_unchecked]
    parts = [f'{name} does not keep {limits_file}: {", ".join(missed)}'] if missed else []
    if unchecked:
        parts.append(f'{name}: no drive velocity came within the window of {", ".join(unchecked)}, so that no '
                     'controller was checked: let the window begin with first_command, or allow that with commands: '
                     'optional')
    return '; '.join(parts)


def failures(outcomes: Sequence[LimitOutcome]) -> list[str]:
    """Return the names of the limits that were not kept."""
    return [outcome.name for outcome in outcomes if not outcome.passed]


def line_of(outcome: LimitOutcome) -> str:
    """Return what was measured, and the limit, in a sentence."""
    if outcome.limit is None or outcome.value is None:
        return outcome.remark
    unit = f' {outcome.limit.kind.unit}'.rstrip()
    text = f'{outcome.limit.kind.name} = {outcome.value!r}{unit}, limit {outcome.limit.bound!r}{unit}'
    return f'{text} ({outcome.remark})' if outcome.remark else text


def checks_as_values(runs: Sequence[Checked]) -> dict[str, Any]:
    """Return everything that was found: of one run, or a list of several."""
    found = [_found(*checked) for checked in runs]
    return found[0] if len(found) == 1 else {'passed': all(one['passed'] for one in found), 'runs': found}


def _found(name: str, run: Run | None, outcomes: Sequence[LimitOutcome], test: IsoTest | None) -> dict[str, Any]:
    return {
        'run': {'name': name, **(_facts_of(run, outcomes) if run else {})},
        'passed': not failures(outcomes),
        'limits': [_entry(outcome) for outcome in outcomes],
        **(iso_values(test) if test else {}),
    }


def _facts_of(run: Run, outcomes: Sequence[LimitOutcome]) -> dict[str, Any]:
    motion, commands = observed_motion(run), commands_of(run)
    return {'begin': motion.begin, 'end': motion.end, 'states': motion.states, 'events': len(motion.events),
            'is_complete': run.is_complete, 'notes': list(_notes(run, outcomes)),
            'first_command': commands.first if commands else None, 'timing': timing_of(run)}


def _entry(outcome: LimitOutcome) -> dict[str, Any]:
    limit = outcome.limit
    found = {'name': outcome.name, 'passed': outcome.passed, 'remark': outcome.remark}
    if limit is None:
        return {**found, 'check': TIMING_LIMIT}
    return {**found, 'check': limit.kind.name, 'unit': limit.kind.unit, 'measured': outcome.value,
            limit.kind.bound.name: limit.bound, 'margin': outcome.margin, 'window': outcome.span, **limit.settings}


# The outcome as JUnit XML, which CI servers read: one test case for each limit.

def junit_text(runs: Sequence[Checked]) -> str:
    """Return the file, valid against the schema of Jenkins: a suite for each run, with the name of what was checked.

    The verdict on its timing, if there is one, is a property of the suite.
    """
    suites = [_suite(checked) for checked in runs]
    root = suites[0] if len(suites) == 1 else ElementTree.Element('testsuites')
    root.extend(suites if len(suites) > 1 else ())
    ElementTree.indent(root)
    document: bytes = ElementTree.tostring(root, encoding='utf-8', xml_declaration=True)
    return document.decode() + '\n'


def _suite(checked: Checked) -> ElementTree.Element:
    name, run, outcomes, _ = checked
    failed = sum(not outcome.passed for outcome in outcomes)
    suite = ElementTree.Element('testsuite', name=name, tests=str(len(outcomes)), failures=str(failed), errors='0')
    if verdict := real_time_verdict(run):
        properties = ElementTree.SubElement(suite, 'properties')
        ElementTree.SubElement(properties, 'property', name='real time', value=verdict)
    for outcome in outcomes:
        case = ElementTree.SubElement(suite, 'testcase', name=outcome.name, classname=f'stickslip.check.{name}')
        if outcome.passed:
            ElementTree.SubElement(case, 'system-out').text = line_of(outcome)
        else:
            failure = ElementTree.SubElement(case, 'failure', type='limit', message=line_of(outcome))
            failure.text = line_of(outcome)
    return suite


# The outcome of a check for people.

def check_report(checked: Checked) -> Iterator[Part]:
    """Yield the checked run, whether it kept real time, its missing parts, its limits, and the verdict."""
    yield checked_line(checked)
    yield from filter(None, [real_time_verdict(checked.run)])
    yield from (Sentence(note, NOTE) for note in (_notes(checked.run, checked.outcomes) if checked.run else ()))
    yield from iso_parts(checked.test) if checked.test else ()
    if not checked.outcomes:
        return
    yield Table(('limit', 'measured', 'at most', 'margin', '', ''), [*map(_cells, checked.outcomes)], texts=(0, 4, 5))
    yield verdict_line(checked)


def _notes(run: Run, outcomes: Sequence[LimitOutcome]) -> Iterator[str]:
    """Yield what is missing of a run, and which limits say little of it."""
    yield from gaps_in(run)
    creeping = [outcome.name for outcome in outcomes if outcome.limit and outcome.limit.kind.name == 'longest_stick']
    if creeping and not isinstance(run, MeasuredRun) and run.scene.values.get('contact.model') == 'compliant':
        yield (f'{", ".join(creeping)}: in stick the slider moves on its compliant contact; the check standstill has '
               'the time below a speed')


def _cells(outcome: LimitOutcome) -> tuple[str, ...]:
    verdict = 'PASS' if outcome.passed else 'FAIL'
    if outcome.limit is None or outcome.value is None or outcome.margin is None:
        return outcome.name, '–', '–', '–', verdict, outcome.remark
    value, margin = (quantity(number, outcome.limit.kind.unit) for number in (outcome.value, outcome.margin))
    return outcome.name, value, outcome.limit.bound_text, margin, verdict, outcome.remark


def matrix(runs: Sequence[Checked]) -> Table:
    """Return a row for each run with what was measured for each limit; those that failed say so."""
    names = list(dict.fromkeys(outcome.name for checked in runs for outcome in checked.outcomes))
    rows = []
    for checked in runs:
        of_run = {outcome.name: _cells(outcome) for outcome in checked.outcomes}
        cells = (of_run.get(name, ('', '–', '', '', '', '')) for name in names)
        rows.append((checked.name, *(f'{cell[1]} FAIL' if cell[4] == 'FAIL' else cell[1] for cell in cells)))
    return Table(('run', *names), rows)


# The verdict on a recording that was run again, and what would have been.

def verdict_report(run: RecordedRun, verdict: Verdict) -> Iterator[Part]:
    """Yield how much is identical, and what a recording that differs was made with."""
    amount = f'{verdict.steps} steps, {verdict.events} events'
    if verdict.missing:
        yield Sentence(f'{verdict.missing} steps have no recorded state', NOTE)
    if verdict.difference:
        yield f'differs after {amount} that are identical'
        yield f'      recorded with {made_with(run)}'
    else:
        extent = 'identical' if run.is_complete else 'identical as far as it goes'
        yield f'{extent}, {amount}, up to t = {verdict.end:.9g} s'


def beside_table(recorded: Run, other: Run) -> Table:
    """Return two runs beside each other: motion, break-aways, errors to a setpoint, means of the last cycles."""
    both = recorded.summary, other.summary
    rows = [('motion', *(figures.motion for figures in both)),
            ('time in stick', *(f'{100.0 * figures.stick_share:.4g} %' for figures in both)),
            ('break-aways', *(str(figures.events[EventKind.BREAKAWAY]) for figures in both)),
            ('complete cycles', *(str(figures.cycles) for figures in both))]
    rows += [(head_of(name), *(quantity(getattr(figures.mean, name), unit_of(name)) if figures.mean else '–'
                               for figures in both))
             for name in OF_A_CYCLE if both[0].mean or both[1].mean]
    if recorded.setpoint:
        found = [outcomes_of(control_figures(run, (run.begin, run.end)), run) for run in (recorded, other)]
        rows += [(outcome.name, *(_cells(outcomes[row])[1] for outcomes in found))
                 for row, outcome in enumerate(found[0]) if outcome.name.startswith('following_error')]
    return Table(('', 'recorded', 'what if'), rows, least=(22, 13, 13))


def write_what_if(folder: Path, changes: Mapping[str, object], recorded: RecordedRun, other: Run) -> None:
    """Write picture, figures and scene of what would have been; raises OSError."""
    changed = ', '.join(f'{name} = {value}' for name, value in changes.items())
    plot_runs({recorded.title: recorded, f'what if {changed}': other}, folder / 'what_if.png')
    figures = {'scene': other.scene.name, 'changes': changes, 'recorded': recorded.summary, 'what_if': other.summary}
    (folder / 'what_if.json').write_text(json_text(figures, 2), encoding='utf-8')
    (folder / 'scene.yaml').write_text(scene_text(values_in_file(other.scene)), encoding='utf-8')


# Runs beside each other.

_AT_EACH_INSTANT = {'following_error': 'error', 'peak_speed': 'speed', 'lowest_speed': 'speed'}
_OF_CONTROL = ('following_error', 'following_error_rms', 'sticks', 'longest_stick', 'peak_speed', 'command_peak',
               'command_rms')


def plot_runs(runs: Mapping[str, Run], *paths: Path | str, limits: Limits | str | None = None,
              window: tuple[float, float] | None = None, columns: bool = False) -> tuple[float, float]:
    """Draw speed, error and drive force of runs by their names over each other, or in `columns`, into each path.

    The error is that to the reference of `limits` (a file, or its content) or to the setpoint; without any, to the
    drive.  Limits that hold at each instant are drawn as lines.  Without a `window` (begin and end, s) that of the
    moves is shown; returns it.  Raises InputError.
    """
    check_kind('runs', runs, Mapping, 'runs by their names', 'for example {"one": run}')
    for path in paths:
        check_picture_name('path', str(path))
    if not 1 <= len(runs) <= _MOST_BESIDE:
        raise InputError('runs', f'{len(runs)} runs', f'1 to {_MOST_BESIDE} at once', 'draw fewer')
    from ..runs.picture import draw_runs  # matplotlib takes half a second

    limits = load_limits(limits) if isinstance(limits, str) else limits or Limits(())
    return draw_runs({name: _beside(run, limits) for name, run in runs.items()}, window, columns, *paths)


def _beside(run: Run, limits: Limits) -> 'RunBeside':
    from ..plots.overlay import Bound
    from ..runs.picture import RunBeside

    spans = [(limit, limit.window.at(first_command_of(run))) for limit in limits.limits]
    bounds = [Bound(limit.name, _AT_EACH_INSTANT[limit.kind.name], limit.bound, span.begin or run.begin,
                    run.end if span.end is None else span.end)
              for limit, span in spans if span is not None and limit.kind.name in _AT_EACH_INSTANT]
    given = limits.reference and limits.reference_for(run)
    wanted = {'time': np.array(given.times), 'position': np.array(given.positions)} if given else run.setpoint
    return RunBeside(run, wanted, bounds)


def control_figures(run: Run, window: tuple[float, float], limits: Limits | None = None) -> Limits:
    """Return the figures of control of a run in a window (s) as limits that it keeps, with the reference of limits."""
    part = Window(max(window[0], run.begin), min(window[1], run.end))
    kinds = [KINDS[name] for name in _OF_CONTROL if not unmeasured(run, KINDS[name].needs)]
    return Limits(tuple(Limit(kind.name, kind, math.inf, part, {}) for kind in kinds), needs_commands=False,
                  reference=limits.reference_for(run) if limits else None)
