# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One look through a run, sample by sample, for all that is said and drawn of it.

However long it is, its samples pass by in blocks; what remains is small.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from ..core.arrays import Columns, Numbers, rows_between
from ..core.types import Event, EventKind, Mode
from ..figures.slips import begins_slip, complete_slips
from ..plots.paper_panels import ALIKE, RANGED, DrawnMotion, DrawnSpan
from ..runs import Run
from ..runs.samples import MOST_HELD, ReducedWindow, ReducedWindows, joined
from ..scene import Scene

# A run cut where its slips begin: each part has a slip and the stick after it, and is small however long the run.

APPLIED = 'applied_force'   # the external force as the balance of forces has it
SEEN = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force',
        'friction_force', 'mode', APPLIED)


@dataclass(frozen=True)
class RunPart:
    """A part of a run from `begin` to `end` (s); its samples have one more on either side.

    When it `is_closed`, the last of its events is the first of the next part.
    """

    scene: Scene
    begin: float
    end: float
    is_closed: bool
    events: Sequence[Event]
    before: Columns    # the state just before each event
    samples: Columns   # SEEN, and perhaps more


class PartCutter:
    """Cuts a run into parts; `before` are the states before its events, known up to the samples that are taken."""

    def __init__(self, run: Run, before: Columns) -> None:
        self._scene, self._events, self._before = run.scene, run.events, before
        self._spans = _spans(run)
        self._span = next(self._spans)
        self._held: Columns = {}                  # samples, from one before the part under way on
        self._long: ReducedWindow | None = None   # takes them in its place where they are many

    def take(self, block: Columns) -> Iterator[RunPart]:
        """Take the next samples; yield the parts that end before the last of them."""
        self._held = joined([self._held, block]) if self._held else block
        if self._long:
            self._long.take(block)
        while self._span.is_closed and self._span.end < block['time'][-1]:
            yield self.under_way
            self._span, self._long = next(self._spans), None
        first = int(np.searchsorted(self._held['time'], self._span.begin))
        if not self._long and len(self._held['time']) - first > MOST_HELD:
            self._long = ReducedWindow(self._span.begin, self._span.end, SEEN, is_whole_first=True)
            self._long.take(self._held)
        self._held = _rows(self._held, slice(-1 if self._long else max(first - 1, 0), None))

    @property
    def under_way(self) -> RunPart:
        """The part under way, as far as its samples were taken."""
        first, last, begin, end, is_closed = self._span
        if self._long:
            samples = self._long.columns
        else:
            samples = _rows(self._held, slice(max(int(np.searchsorted(self._held['time'], begin)) - 1, 0),
                                              int(np.searchsorted(self._held['time'], end, 'right')) + 1))
        return RunPart(self._scene, begin, end, is_closed, self._events[first:last],
                       _rows(self._before, slice(first, last)), samples)


class _Span(NamedTuple):
    """The events of a part, from the first to the one behind the last, and its time, s."""

    first: int
    last: int
    begin: float
    end: float
    is_closed: bool


def _spans(run: Run) -> Iterator[_Span]:
    """Yield the parts of a run, from its start to its end."""
    first, begin = 0, run.begin
    for k, event in enumerate(run.events):
        if begins_slip(event):
            yield _Span(first, k + 1, begin, event.time, True)
            first, begin = k, event.time
    yield _Span(first, len(run.events), begin, run.end, False)


def _rows(columns: Columns, rows: slice) -> Columns:
    return {name: column[rows] for name, column in columns.items()}


# What is read off a part of a run: its rows, and its inputs where they are constant.

DRAWN = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_force', 'friction_force', 'mode')
_STEADY = 1e-9   # relative: inputs that vary less are constant


class SteadyInputs(NamedTuple):
    """Inputs that do not change."""

    velocity: float   # m/s, of the drive
    force: float      # N


class InputsSeen:
    """Takes samples with APPLIED block by block, and says whether the inputs were constant."""

    def __init__(self) -> None:
        self._velocity, self._force = [math.inf, -math.inf], [math.inf, -math.inf]   # the least, the most
        self._scale = 0.0                 # N
        self._first = math.nan            # m/s
        self._medians: list[float] = []   # N, of the blocks

    def take(self, samples: Columns, inside: slice) -> None:
        """Take some rows of samples, at least one."""
        velocity, force = samples['drive_velocity'][inside], samples[APPLIED][inside]
        if not self._medians:
            self._first = float(velocity[0])
        for seen, values in ((self._velocity, velocity), (self._force, force)):
            seen[:] = min(seen[0], float(values.min())), max(seen[1], float(values.max()))
        self._scale = max(self._scale, *(float(np.abs(samples[name][inside]).max())
                                         for name in ('friction_force', 'drive_force')))
        self._medians.append(float(np.median(force)))

    @property
    def steady(self) -> SteadyInputs | None:
        """The inputs; None when they were not constant."""
        (slowest, fastest), (least, most), allowed = self._velocity, self._force, _STEADY * self._scale
        if fastest - slowest > _STEADY * max(abs(slowest), abs(fastest)) or most - least > allowed:
            return None
        acts = max(abs(least), abs(most)) > allowed
        return SteadyInputs(self._first, float(np.median(self._medians)) if acts else 0.0)


def within(part: RunPart, begin: float, end: float) -> Columns:
    """Return the samples from `begin` to `end` (s), and the state just before each event there.

    So corners and jumps are where they are.
    """
    return in_order(*({name: source[name][rows_between(source['time'], begin, end)] for name in DRAWN}
                      for source in (part.before, part.samples)))


def in_order(before: Columns, samples: Columns) -> Columns:
    """Return states before events and samples in the order of time; at equal times the state before comes first."""
    order = np.argsort(np.concatenate([before['time'], samples['time']]), kind='stable')
    return {name: np.concatenate([before[name], samples[name]])[order] for name in DRAWN}


def steady_inputs(part: RunPart, begin: float, end: float) -> SteadyInputs | None:
    """Return the drive velocity and the external force between two times (s); None when they are not constant.

    So it is under a normal load, which is no part of the axis.
    """
    if part.scene.normal_load is not None:
        return None
    inside = rows_between(part.samples['time'], begin, end)
    if inside.start >= inside.stop:
        return None
    seen = InputsSeen()
    seen.take(part.samples, inside)
    return seen.steady


# Which parts of a run are worth a picture.

_CYCLES = 5                    # that show how the motion begins
_IN_ORBIT = 30                 # that show where it goes
_BEFORE, _AFTER = 0.25, 0.75   # of a slip's duration: what is shown of the sticks around it
_BEGINNING = 0.1               # of a slip without an end: what is shown


class DrawnStretches(NamedTuple):
    """What is drawn of a run: its first cycles, its last complete slip, its last complete cycle (DrawnMotion)."""

    opening: DrawnSpan
    slip: DrawnSpan
    break_away: float | None
    orbit: DrawnSpan
    cycle: DrawnSpan | None

    @property
    def all(self) -> list[DrawnSpan]:
        """All stretches of which the samples are needed: beside other runs more of the opening may be drawn."""
        begin, end = self.opening
        beside = begin, begin + ALIKE * (end - begin)
        return [beside, self.slip, self.orbit, *([self.cycle] if self.cycle else [])]


def drawn_stretches(run: Run) -> DrawnStretches:
    """Return what is drawn of a run."""
    return DrawnStretches(_opening(run), *_slip(run), _orbit(run), _cycle(run))


def _opening(run: Run) -> DrawnSpan:
    cycles = run.cycles()
    if not cycles:
        return run.begin, run.end
    last = cycles[min(_CYCLES, len(cycles)) - 1]
    return run.begin, min(last.begin + last.period + _AFTER * last.slip_time, run.end)


def _slip(run: Run) -> tuple[DrawnSpan, float | None]:
    """Return the last slip with a stick after it and its break-away, or how the first slip begins."""
    last = run.cycles()[-1].begin if run.cycles() else math.inf
    complete = [slip for slip in complete_slips(run.events) if slip[0].time <= last]
    if complete:
        begin, end = complete[-1][0].time, complete[-1][1].time
        length = end - begin
        return (max(begin - _BEFORE * length, run.begin), min(end + _AFTER * length, run.end)), begin
    first = next((event.time for event in run.events if event.kind == EventKind.BREAKAWAY), None)
    if first is None:
        return (run.begin, run.end), None
    return (run.begin, first + _BEGINNING * (run.end - first)), first


def _orbit(run: Run) -> DrawnSpan:
    """Return as many cycles as a picture can show."""
    cycles = run.cycles()
    return run.begin, cycles[_IN_ORBIT].begin if len(cycles) > _IN_ORBIT else run.end


def _cycle(run: Run) -> DrawnSpan | None:
    if not run.cycles():
        return None
    last = run.cycles()[-1]
    return last.begin, last.begin + last.period


Watch = Callable[[RunPart], Any]

_OF_EVENTS = 'time', 'position', 'velocity', 'drive_position', 'drive_force', 'friction_force'


class RunLook(NamedTuple):
    """What a look through a run left."""

    first: dict[str, float]                    # sample, with APPLIED
    steady: SteadyInputs | None                # of all of it; None under a load, which is no part of the axis
    before: Columns                            # the state just before each event
    ranges: Mapping[str, tuple[float, float]]  # the lowest and the highest value of RANGED
    drawn: Columns                             # samples of the stretches that are drawn
    found: Mapping[str, list[Any]]             # what each watch found of each part


_LOOKS: WeakKeyDictionary[Run, RunLook] = WeakKeyDictionary()


def look_at(run: Run) -> RunLook:
    """Return what a look through a run left: the one with watches where there was one."""
    return _LOOKS[run] if run in _LOOKS else watched(run, {})


def watched(run: Run, watches: Mapping[str, Watch]) -> RunLook:
    """Look through a run with watches by their names, each for every part of it."""
    before, inputs, ranges = _BeforeEvents(run), InputsSeen(), _Ranges()
    cutter, drawn = PartCutter(run, before.columns), ReducedWindows(drawn_stretches(run).all, DRAWN)
    found: dict[str, list[Any]] = {name: [] for name in watches}
    first: dict[str, float] = {}
    mass = run.scene.axis.mass
    for columns in run.sample_blocks():
        applied = mass * columns['acceleration'] + columns['friction_force'] - columns['drive_force']
        applied += run.scene.axis.slideway_damping * columns['velocity']
        block = {name: applied if name == APPLIED else columns[name] for name in SEEN}
        first = first or {name: float(column[0]) for name, column in {**columns, APPLIED: applied}.items()}
        before.take(block)
        inputs.take(block, slice(None))
        ranges.take(block)
        drawn.take(block)
        if watches:
            for part in cutter.take(block):
                _watch(part, watches, found)
    before.finish()
    ranges.take(before.columns)
    if watches:
        _watch(cutter.under_way, watches, found)
    steady = inputs.steady if run.scene.normal_load is None else None
    _LOOKS[run] = RunLook(first, steady, before.columns, ranges.found, drawn.columns, found)
    return _LOOKS[run]


def _watch(part: RunPart, watches: Mapping[str, Watch], found: Mapping[str, list[Any]]) -> None:
    for name, watch in watches.items():
        found[name].append(watch(part))


class _Ranges:
    """Takes columns; `found` are the lowest and the highest value of RANGED in them."""

    def __init__(self) -> None:
        self.found: dict[str, tuple[float, float]] = {}

    def take(self, columns: Columns) -> None:
        for name, quantity in RANGED.items() if len(columns['time']) else ():
            values = quantity(columns)
            low, high = float(values.min()), float(values.max())
            seen = self.found.get(name, (low, high))
            self.found[name] = min(low, seen[0]), max(high, seen[1])


class _BeforeEvents:
    """The states just before the events of a run; their accelerations follow as samples are taken.

    Those are of the balance of forces: the external force is taken to be linear between samples.
    """

    def __init__(self, run: Run) -> None:
        events = run.events
        self.columns: Columns = {name: np.array([getattr(event, name) for event in events], dtype=np.float64)
                                 for name in _OF_EVENTS}
        self.columns['acceleration'] = np.full(len(events), np.nan)
        self.columns['mode'] = np.array([Mode.STICK, *(event.mode for event in events[:-1])][:len(events)],
                                        dtype=np.float64)
        self._mass, self._damping = run.scene.axis.mass, run.scene.axis.slideway_damping
        self._done = 0
        self._latest: tuple[list[float], list[float]] = [], []   # the last sample: its time and its external force

    def take(self, block: Columns) -> None:
        """Take the next samples with APPLIED."""
        time, applied = block['time'], block[APPLIED]
        if not self._latest[0]:
            self.columns['mode'][:1] = block['mode'][0]
        end = int(np.searchsorted(self.columns['time'], time[-1], 'right'))
        self._fill(end, np.concatenate([self._latest[0], time]), np.concatenate([self._latest[1], applied]))
        self._latest = [float(time[-1])], [float(applied[-1])]

    def finish(self) -> None:
        """Take what comes behind the last sample to be as there."""
        self._fill(len(self.columns['time']), *map(np.array, self._latest))

    def _fill(self, end: int, time: Numbers, applied: Numbers) -> None:
        events = slice(self._done, end)
        at_events = np.interp(self.columns['time'][events], time, applied)
        force = self.columns['drive_force'][events] + at_events - self.columns['friction_force'][events]
        force -= self._damping * self.columns['velocity'][events]
        self.columns['acceleration'][events] = force / self._mass
        self._done = end


# The motion of a run as it is drawn.

def drawn_motion(run: Run) -> DrawnMotion:
    """Return what is drawn of a run: its first cycles, its last complete slip, its last complete cycle."""
    stretches, seen = drawn_stretches(run), look_at(run)
    columns = in_order(_of_stretches(seen.before, stretches.all), seen.drawn)
    return DrawnMotion(columns, *stretches, seen.ranges)


def _of_stretches(before: Columns, stretches: Iterable[DrawnSpan]) -> Columns:
    """Return the states before events in stretches, with one more on either side."""
    time = before['time']
    chosen = np.zeros(len(time), dtype=np.bool_)
    for begin, end in stretches:
        chosen[max(int(np.searchsorted(time, begin, 'right')) - 1, 0):int(np.searchsorted(time, end)) + 1] = True
    return {name: column[chosen] for name, column in before.items()}
