# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Limits in a file: read strictly, so that a misspelt limit is refused and never passes unseen."""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from ..core.errors import InputError, RecordingError, suggestion
from ..figures.control import MeasuredFigure, Measuring, MotionBlock, MotionSpan, no_sample_in, positions_of_targets
from ..figures.positioning import PositionFigures
from ..inputs.csv_table import CsvTable, column_of
from ..inputs.units import LENGTHS, TIMES
from ..report.quantity import quantity
from ..runs import Run
from ..scene import Parameter
from ..scene.load import named, read_text
from ..scene.ros_yaml import read_yaml, section
from ..scene.schema import MOST_POINTS
from . import observed_run
from .measures import CIRCLE_KINDS, DWELL, FARTHEST, KINDS, TARGET, TARGETS, TIMING_LIMIT, TOLERANCE, CircleKind, Kind
from .observed_run import KnownCommands, ObservedMotion, Reference

# The part of a run that a limit is for, in times of the run or from its first command on.

CHECK_PAGE = 'docs/check.md'
LATEST_TIME = 1e15   # s, as in a scene
FIRST_COMMAND = 'first_command'
_TIME = Parameter('time', 'double', None, 's', 'of the run', low=0.0, high=LATEST_TIME)


class CheckedSpan(NamedTuple):
    """From when to when, s of the run; None: from its start, to its end."""

    begin: float | None = None
    end: float | None = None


class Window(NamedTuple):
    """A span as a file gives it; `is_from_command`: its times count from the first command on."""

    begin: float | None = None
    end: float | None = None
    is_from_command: bool = False

    def at(self, first_command: float | None) -> CheckedSpan | None:
        """Return the span in a run with this first command; None in a run without the command that it begins with."""
        if not self.is_from_command:
            return CheckedSpan(self.begin, self.end)
        if first_command is None:
            return None
        return CheckedSpan(*(None if time is None else first_command + time for time in (self.begin, self.end)))

    def check_fit(self, name: str, begin: float, end: float, first_command: float | None) -> None:
        """Raise InputError when an edge is not within a run from `begin` to `end` (s)."""
        zero = first_command if self.is_from_command and first_command is not None else 0.0
        for edge, time in zip(CheckedSpan._fields, (self.begin, self.end)):
            if time is not None and not begin <= zero + time <= end:
                allowed = (f'at most {end - zero:g}, the time in s that the run goes on after its first command'
                           if self.is_from_command else f'within the run, {begin:g} to {end:g} s')
                raise InputError(f'{name}.{edge}', time, allowed, 'change the window, or check a longer run')


WHOLE_RUN = Window()


def window_of(name: str, given: object, default: Window) -> Window:
    """Return the window that a file gives, with the edges of `default` where it gives none; raises InputError."""
    if given is None:
        return default
    edges = dict(section(name, given, CheckedSpan._fields, CHECK_PAGE))
    window = default
    if edges.get('begin') == FIRST_COMMAND:
        if default.end is not None and not default.is_from_command and 'end' not in edges:
            raise InputError(name, given, 'with an end of its own', 'times of this window count from the first command,'
                             ' those of the window at the top from the start of the run')
        window, edges['begin'] = window._replace(is_from_command=True), 0.0
    times = {edge: _time(f'{name}.{edge}', time) for edge, time in edges.items()}
    window = window._replace(begin=times.get('begin', window.begin), end=times.get('end', window.end))
    if window.begin is not None and not window.begin < (math.inf if window.end is None else window.end):
        raise InputError(name, [window.begin, window.end], 'begin before end', 'give both in seconds')
    return window


def _time(name: str, given: object) -> float:
    if isinstance(given, str) and given.startswith('first'):
        raise InputError(name, given, f'a time in s, or as the begin {FIRST_COMMAND}',
                         f'{{begin: {FIRST_COMMAND}, end: 2.0}} ends 2 s after the first command')
    time: float = replace(_TIME, name=name).checked(given)  # type: ignore[assignment]
    return time


_SECTIONS = ('window', 'target', 'reference', 'commands', 'limits', 'circle', 'positioning')
RADIUS = Parameter('radius', 'double', None, 'm', 'of the nominal circle', low=0.0, low_open=True, high=FARTHEST)
_CENTRE = Parameter('centre', 'double_array', None, 'm', 'x and y of it', low=-FARTHEST, high=FARTHEST)
_TIMES = Parameter('times', 'double_array', None, 's', 'of the run', low=0.0, high=LATEST_TIME)
_POSITIONS = Parameter('positions', 'double_array', None, 'm', 'at these times', low=-FARTHEST, high=FARTHEST)
_NAME = Parameter('name', 'string', None, '', 'of a limit')
_COMMANDS = Parameter('commands', 'string', 'required', '', 'whether a run of the node needs some to be checked',
                      choices=('required', 'optional'))
_VALID = 'valid'
_COLUMNS = {'time': TIMES, 'position': LENGTHS}
_OF_A_FILE = ('file', *_COLUMNS, *(f'{name}_unit' for name in _COLUMNS))


@dataclass(frozen=True)
class Limit:
    """A figure within a window must not be beyond `bound` (in the unit of its kind)."""

    name: str
    kind: Kind
    bound: float
    window: Window
    settings: Mapping[str, float]   # what the kind asks for beside

    def margin(self, value: float) -> float:
        """Return what a value leaves up to the bound; negative beyond it."""
        return value - self.bound if self.kind.is_least else self.bound - value

    @property
    def bound_text(self) -> str:
        """The bound for people, as at most so much."""
        text = quantity(self.bound, self.kind.unit)
        return f'at least {text}' if self.kind.is_least else text

    def is_kept(self, value: Any) -> Any:
        """Return whether values, one or an array of them, are within the bound."""
        return value >= self.bound if self.kind.is_least else value <= self.bound

    def outcome(self, figure: MeasuredFigure, span: CheckedSpan) -> 'LimitOutcome':
        """Return what a figure of a span comes to."""
        value, remark = figure
        return LimitOutcome(self.name, self, bool(self.is_kept(value)), value, remark, span)

    @contextmanager
    def named(self) -> Iterator[None]:
        """Put the name of the limit in front of that of an InputError."""
        try:
            yield
        except InputError as error:
            raise InputError(f'{self.name}.{error.name}', error.value, error.allowed, error.fix) from None


class NominalCircle(NamedTuple):
    """What a file says of the circle that two axes are to follow, m; the rest is that of the commanded path."""

    radius: float | None = None
    centre: tuple[float, float] | None = None


class RestSettings(NamedTuple):
    """What a file says of the rests of a positioning test; see `positions_of_targets`."""

    targets: tuple[float, ...] = ()
    dwell: float = 0.1   # s
    tolerance: float = 1e-6   # m


_AS_COMMANDED, _ANY_REST = NominalCircle(), RestSettings()
_POSITIONING = TARGETS, DWELL, TOLERANCE


@dataclass(frozen=True)
class Limits:
    """All limits of a file; `timing`: the run must be valid in real time.

    `window` is that of the whole file; the times of the reference count as its times do.
    """

    limits: tuple[Limit, ...]
    timing: bool = False
    reference: Reference | None = None
    window: Window = WHOLE_RUN
    needs_commands: bool = True
    circle: NominalCircle = _AS_COMMANDED
    positioning: RestSettings = _ANY_REST

    def with_radius(self, radius: float | None) -> 'Limits':
        """Return the limits for a nominal circle of another radius, m; raises InputError."""
        if radius is None:
            return self
        return replace(self, circle=self.circle._replace(radius=_checked(RADIUS, '', radius, '--radius')))

    def check_axes(self, are_two: bool) -> None:
        """Raise InputError when a limit is for the path of two axes and a check is not, or the other way round."""
        for limit in self.limits:
            if isinstance(limit.kind, CircleKind) != are_two:
                raise InputError(limit.name, limit.kind.name, 'one of ' + ', '.join(CIRCLE_KINDS) if are_two else
                                 'omitted in a check of one axis', 'check each axis by itself with other limits'
                                 if are_two else 'check two axes: --circle RUN_X RUN_Y')

    def reference_for(self, run: Run) -> Reference | None:
        """Return the reference in times of a run, or else its setpoint."""
        first = observed_run.first_command_of(run)
        if self.reference is None or first is None or not self.window.is_from_command:
            return self.reference or observed_run.setpoint_of(run)
        return self.reference.later(first)


def load_limits(path: str) -> Limits:
    """Return the limits of a file; raises InputError, whose text begins with the file."""
    with named(path):
        return limits_of(read_yaml(read_text(Path(path), 'limits file')), Path(path).parent)


def limits_of(document: object, folder: Path = Path()) -> Limits:
    """Return the limits of a document as YAML gives it, whose files are in a folder; raises InputError."""
    given = section('file', document, _SECTIONS, CHECK_PAGE)
    entries = given.get('limits')
    if not isinstance(entries, Mapping) or not entries:
        raise InputError('limits', entries, 'a section with at least one limit', 'for example sticks: {max: 3}')
    window = window_of('window', given.get('window'), WHOLE_RUN)
    positioning = _settings('positioning', given, _POSITIONING)
    defaults = {**positioning, **({'target': _checked(TARGET, '', given['target'])} if 'target' in given else {})}
    for name in entries:
        _NAME.checked(name)
    return Limits(tuple(_limit(name, entry, window, defaults) for name, entry in entries.items()
                        if name != TIMING_LIMIT),
                  _timing(entries), _reference(given.get('reference'), folder), window,
                  _checked(_COMMANDS, '', given.get('commands', _COMMANDS.default)) == _COMMANDS.default,
                  _circle(given), RestSettings(**positioning))


def check_fit(limits: Limits, begin: float, end: float, has_timing: bool, commands: KnownCommands | None) -> None:
    """Raise InputError when a limit is set for what a run from `begin` to `end` (s) does not have."""
    if limits.timing and not has_timing:
        raise InputError(TIMING_LIMIT, _VALID, 'omitted here: only a run that the node recorded in real time has a '
                         'verdict', 'drop this limit')
    for limit in limits.limits:
        name = f'{limit.name}.window'
        if commands is None and limit.window.is_from_command:
            raise InputError(f'{name}.begin', FIRST_COMMAND, 'a time in s here: no command is known of this run',
                             'check a run that the node recorded')
        if not (commands and commands.first is None and limit.window.is_from_command):
            limit.window.check_fit(name, begin, end, commands.first if commands else None)


def _limit(name: str, entry: object, window: Window, defaults: Mapping[str, Any]) -> Limit:
    if not isinstance(entry, Mapping):
        raise InputError(name, entry, 'a limit in braces', f'for example {name}: {{max: 1.0e-3}}')
    kind = _kind(name, entry)
    known = ('check', kind.bound.name, 'window', *(setting.name for setting in kind.settings))
    given = section(name, entry, known, CHECK_PAGE)
    settings = {setting.name: _setting(setting, name, given, defaults) for setting in kind.settings}
    own_window = window_of(f'{name}.window', given.get('window'), window)
    return Limit(name, kind, _setting(kind.bound, name, given, {}), own_window, settings)


def _settings(name: str, given: Mapping[str, object], entries: Sequence[Parameter]) -> dict[str, Any]:
    """Return what a section that may be left out gives."""
    if name not in given:
        return {}
    values = section(name, given[name], [entry.name for entry in entries], CHECK_PAGE)
    return {entry.name: _checked(entry, name, values[entry.name]) for entry in entries if entry.name in values}


def _circle(given: Mapping[str, object]) -> NominalCircle:
    circle = NominalCircle(**_settings('circle', given, (RADIUS, _CENTRE)))
    if circle.centre is not None and len(circle.centre) != 2:
        raise InputError('circle.centre', list(circle.centre), 'two numbers, x and y in m', 'write it as [0.0, 0.0]')
    return circle


def _kind(name: str, entry: Mapping[str, object]) -> Kind:
    """Return what is limited: `check`, or the name itself."""
    given = entry.get('check', name)
    kinds = {**KINDS, **CIRCLE_KINDS}
    if not isinstance(given, str) or given not in kinds:
        fix = suggestion(str(given), kinds, f'name one: {name}: {{check: sticks, max: 3}}')
        raise InputError(f'{name}.check' if 'check' in entry else 'limit', given, 'one of ' + ', '.join(kinds), fix)
    return kinds[given]


def _setting(entry: Parameter, name: str, given: Mapping[str, object], defaults: Mapping[str, Any]) -> Any:
    if entry.name in given:
        return _checked(entry, name, given[entry.name])
    value = defaults.get(entry.name, entry.default)
    if value is None:
        raise InputError(f'{name}.{entry.name}', None, f'given: {entry.allowed}', 'add it')
    return value


def _timing(entries: Mapping[str, object]) -> bool:
    if TIMING_LIMIT in entries and entries[TIMING_LIMIT] != _VALID:
        raise InputError(TIMING_LIMIT, entries[TIMING_LIMIT], _VALID, 'the verdict of the node is yes or no')
    return TIMING_LIMIT in entries


def _reference(given: object, folder: Path) -> Reference | None:
    if given is None:
        return None
    if isinstance(given, Mapping) and 'file' in given:
        return _reference_of_file(section('reference', given, _OF_A_FILE, CHECK_PAGE), folder)
    values = section('reference', given, Reference._fields, CHECK_PAGE)
    for name in Reference._fields:
        if name not in values:
            raise InputError(f'reference.{name}', None, 'given: times and positions make a profile', 'add it')
    reference = Reference(_checked(_TIMES, 'reference', values['times']),
                          _checked(_POSITIONS, 'reference', values['positions']))
    if len(reference.times) != len(reference.positions):
        raise InputError('reference.positions', values['positions'], f'as many as there are times '
                         f'({len(reference.times)})', 'give one for every time')
    if not all(before < after for before, after in pairwise(reference.times)):
        raise InputError('reference.times', values['times'], 'strictly increasing', 'put them in order')
    return reference


def _reference_of_file(given: Mapping[str, object], folder: Path) -> Reference:
    """Return the reference in columns of a CSV file; raises InputError."""
    for name, value in given.items():
        _checked(replace(_NAME, name=name), 'reference', value)
    words = {name: str(value) for name, value in given.items()}
    path = folder / words['file']
    wanted = [column_of(path, [words.get(name, name)], units, f'reference.{name}', words.get(f'{name}_unit'),
                        f'reference.{name}_unit') for name, units in _COLUMNS.items()]
    table = CsvTable('reference.file', path, wanted, MOST_POINTS)
    return Reference(*(tuple(column.tolist()) for column in table.columns))


def _checked(entry: Parameter, section: str, value: object, name: str = '') -> Any:
    """Return a value as the type of a parameter that has its name in a section; raises InputError."""
    return replace(entry, name='.'.join(filter(None, (section, name or entry.name)))).checked(value)


# What comes of every limit of a file on one run.

class LimitOutcome(NamedTuple):
    """What a limit came to; without a `value` there was nothing to measure, or there is no number (timing)."""

    name: str
    limit: Limit | None   # None: timing
    passed: bool
    value: float | None
    remark: str
    span: CheckedSpan = CheckedSpan()
    is_unchecked: bool = False   # no command came in its window: no controller was checked

    @property
    def margin(self) -> float | None:
        """What is left up to the limit; negative beyond it."""
        return None if self.limit is None or self.value is None else self.limit.margin(self.value)


def outcomes_of(limits: Limits, run: Run) -> list[LimitOutcome]:
    """Return the outcome of every limit, timing last; raises InputError when one does not fit the run.

    A recording that was cut off is checked as far as it goes.
    """
    limits.check_axes(are_two=False)
    motion, timing = observed_run.observed_motion(run), observed_run.timing_of(run)
    commands = observed_run.commands_of(run)
    has_timing = timing is not None and timing.valid is not None
    check_fit(limits, motion.begin, motion.end if run.is_complete else math.inf, has_timing, commands)
    found = [_begun(limit, motion, commands, limits.needs_commands) for limit in limits.limits]
    open_ones = [one for one in found if isinstance(one, _Open)]
    for block in observed_run.motion_blocks(observed_run.states_of(run), motion.events, limits.reference_for(run)):
        for one in open_ones:
            one.take(block)
    outcomes = [one.outcome() if isinstance(one, _Open) else one for one in found]
    for outcome in outcomes:
        if outcome.value is not None and math.isnan(outcome.value):
            needed = observed_run.unmeasured(run, outcome.limit.kind.needs if outcome.limit else ())
            raise RecordingError(f'{run.name}: {outcome.name} needs {" and ".join(needed)}, which was not measured; '
                                 'leave this limit out, or import that column too')
    if limits.timing and timing:
        outcomes.append(LimitOutcome(TIMING_LIMIT, None, bool(timing.valid), None, timing.verdict))
    return outcomes


def positions_of(limits: Limits, run: Run) -> list[PositionFigures]:
    """Return the figures of ISO 230-2 of each target within the window of the file; raises InputError without any."""
    motion = observed_run.observed_motion(run)
    span = limits.window.at(observed_run.first_command_of(run)) or CheckedSpan()
    begin = motion.begin if span.begin is None else span.begin
    end = motion.end if span.end is None else span.end
    measurement = Measuring(positions_of_targets(motion.cut(begin, end), *limits.positioning))
    for block in observed_run.motion_blocks(observed_run.states_of(run), motion.events, limits.reference_for(run)):
        measurement.take(block.cut(begin, end))
    return list(measurement.result())


class _Open:
    """A limit that is being checked, while the motion comes block by block."""

    def __init__(self, limit: Limit, checked: CheckedSpan, span: MotionSpan) -> None:
        self._limit, self._checked, self._span = limit, checked, span
        self._measurement: Measuring[MeasuredFigure] = Measuring(limit.kind.measure(span, **limit.settings))
        self._has_samples = False

    def take(self, block: MotionBlock) -> None:
        part = block.cut(self._span.begin, self._span.end)
        self._has_samples |= len(part.time) > 0
        self._measurement.take(part)

    def outcome(self) -> LimitOutcome:
        """Return what came of it; raises InputError when it does not fit what was measured."""
        limit = self._limit
        if not self._has_samples:
            raise no_sample_in(self._span.begin, self._span.end)
        with limit.named():
            return limit.outcome(self._measurement.result(), self._checked)


def _begun(limit: Limit, motion: ObservedMotion, commands: KnownCommands | None, needs_commands: bool
           ) -> LimitOutcome | _Open:
    """Return a limit with its part of the run; its outcome where there is nothing to measure."""
    first = commands.first if commands else None
    span = limit.window.at(first)
    if span is None:
        return _unchecked(limit, CheckedSpan(), motion.end)
    begin = motion.begin if span.begin is None else span.begin
    end = motion.end if span.end is None else min(span.end, motion.end)
    if begin >= motion.end:
        return LimitOutcome(limit.name, limit, False, None, f'the run has nothing from t = {begin:g} s on', span)
    if commands and needs_commands and (first is None or first > end):
        return _unchecked(limit, span, end)
    return _Open(limit, span, motion.cut(begin, end))


def _unchecked(limit: Limit, span: CheckedSpan, end: float) -> LimitOutcome:
    remark = f'no drive velocity came until t = {end:g} s: no controller was checked'
    return LimitOutcome(limit.name, limit, False, None, remark, span, is_unchecked=True)
