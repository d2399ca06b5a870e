# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of a run, from its events alone: the cycles of stick-slip, and what they amount to.

A cycle reaches from one break-away to the next.  Between two events the speed has no maximum of its own, so that the
figures are as exact as the events.
"""

import math
from collections import deque
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..core.types import Event, EventKind, Mode
from ..friction import StaticLawKind
from ..report.html import parts_as_html
from ..report.model import Part, Table, facts
from ..report.quantity import counted, quantity
from ..scene import Scene
from ..solvers.exact.many_axes import LEAST_STICK, SETTLED
from .catalogue import OF_A_CYCLE, head_of, unit_of
from .rounds import period_repeats
from .slips import begins_slip, elapsed

AVERAGED = 10    # cycles at the end of the run that the means are taken over
_LOOKED_AT = 20        # speeds of a slip, at the latest transitions and those before: some swings
_SAME_SWING = 0.999    # of the speeds before: what swings less calms down
_CALM = 1e-4           # of the highest speed: what swings less is smooth
_NO_SLIP = Mode.STICK, Mode.YIELDING


SWINGS_ON = 'sliding that swings on'   # a limit cycle without stick


class Cycle(NamedTuple):
    """One slip and the stick after it, up to the next break-away.

    A reversal at once ends one slip and begins another; its force is the friction at standstill.
    """

    begin: float                   # s, the break-away
    direction: int                 # of the slip
    rest_time: float               # s, before the break-away
    slip_time: float               # s
    stick_time: float              # s, from standstill to the next break-away; a contact may yield in between
    period: float                  # s
    slip_travel: float             # m, from break-away to standstill
    jump: float                    # m, from break-away to break-away; differs by the give of a compliant contact
    peak_speed: float              # m/s
    break_away_force: float        # N, |friction| at the break-away
    break_away_drive_force: float  # N
    arrest_drive_force: float      # N, drive force when the slip ends
    static_coefficient: float      # at the break-away


class Round(NamedTuple):
    """The figures of a round; names and meanings are those of a study (docs/maps.md)."""

    period: float             # s
    amplitude: float          # m, travel of its longest slip
    stick_share: float
    peak_speed: float         # m/s
    break_away_force: float   # N


class ModeSpan(NamedTuple):
    """A stretch of time in one mode."""

    begin: float  # s
    end: float    # s
    mode: Mode


class Summary(NamedTuple):
    """What a run amounts to."""

    motion: str                  # 'at rest', 'smooth sliding', SWINGS_ON, 'single slip' or 'stick-slip'
    events: dict[EventKind, int]
    cycles: int                  # complete ones
    settled: bool                # the last two periods differ by less than SETTLED
    stick_share: float           # share of the time in stick
    last: Cycle | None
    mean: Cycle | None           # over the last `averaged` cycles
    averaged: int
    touches: int                 # cycles that only touch rest: see `_touches`

    def __repr__(self) -> str:
        return f'<Summary of {self.motion}: {headline(self)}>'

    def _repr_html_(self) -> str:
        return parts_as_html(summary_report(self))


def cycle_figures(events: Sequence[Event]) -> list[Cycle]:
    """Return the complete cycles of a run, in the order of time; smooth sliding has none."""
    finder = _CycleFinder()
    return [cycle for event in events if (cycle := finder.take(event)) is not None]


def round_figures(events: Sequence[Event]) -> Round:
    """Return the figures of the events of one round, both break-aways among them."""
    cycles = cycle_figures(events)
    first, last = events[0], events[-1]
    period = elapsed(first, last)
    return Round(period, max(cycle.slip_travel for cycle in cycles), cycles[-1].stick_time / period,
                 max(cycle.peak_speed for cycle in cycles), abs(first.friction_force))


def mode_spans(events: Sequence[Event], begin: float, end: float, mode: Mode) -> list[ModeSpan]:
    """Return which mode held when, from `begin` to `end` (s); `mode` holds until the first event."""
    spans = []
    for event in events:
        if event.mode != mode and begin < event.time < end:
            spans.append(ModeSpan(begin, event.time, mode))
            begin = event.time
        if event.time < end:
            mode = event.mode
    return [*spans, ModeSpan(begin, end, mode)]


def summary(events: Sequence[Event], duration: float, start: Mode = Mode.STICK, begin: float = 0.0) -> Summary:
    """Sum up a run of `duration` seconds that began in the mode `start` at the time `begin` (s)."""
    tally = EventTally(start, begin, begin + duration)
    for event in events:
        tally.add(event)
    return tally.summary(duration)


class EventTally:
    """Sums up a run event by event, in memory that does not grow.

    It began in the mode `start` at the time `begin` (s); time after `end` (s) does not count.
    """

    def __init__(self, start: Mode = Mode.STICK, begin: float = 0.0, end: float = math.inf) -> None:
        self.latest_time: float | None = None    # s, of the latest event
        self._has_moved = start != Mode.STICK
        self._begin, self._end = begin, end
        self._mode, self._since = start, begin   # of the stretch of time at hand
        self._stick = 0.0, 0.0                   # s: the time in stick before it, and what that number cannot hold
        self._counts = [0] * len(EventKind)
        self._finder = _CycleFinder()
        self._cycle_count = self._touches = 0
        self._latest_cycles: deque[Cycle] = deque(maxlen=AVERAGED)
        self._speeds: deque[float] = deque(maxlen=2 * _LOOKED_AT)   # m/s, of the slip at hand, at its transitions

    def add(self, event: Event) -> None:
        """Take the next event."""
        self.latest_time = event.time
        self._has_moved = True
        self._counts[event.kind] += 1
        if event.mode != self._mode:
            self._enter(event.mode, min(max(self.latest_time, self._since), self._end))
        if event.mode in _NO_SLIP:
            self._speeds.clear()
        elif event.kind != EventKind.KNOT:
            self._speeds.append(event.velocity)
        cycle = self._finder.take(event)
        if cycle is not None:
            self._cycle_count += 1
            self._touches += _touches(cycle, event, self._latest_cycles)
            self._latest_cycles.append(cycle)

    def summary(self, duration: float) -> Summary:
        """Return what it all amounts to, `duration` seconds after the start."""
        cycles = list(self._latest_cycles)
        under_way = self._begin + duration - self._since if self._mode == Mode.STICK else 0.0
        return Summary(
            motion=self._motion,
            events={kind: self._counts[kind] for kind in EventKind},
            cycles=self._cycle_count,
            settled=_is_settled(cycles),
            stick_share=math.fsum((*self._stick, under_way)) / duration,
            last=cycles[-1] if cycles else None,
            mean=mean_cycle(cycles) if cycles else None,
            averaged=len(cycles),
            touches=self._touches)

    def _enter(self, mode: Mode, time: float) -> None:
        if self._mode == Mode.STICK:
            terms = (*self._stick, time - self._since)
            total = math.fsum(terms)
            self._stick = total, math.fsum((*terms, -total))
        self._mode, self._since = mode, time

    @property
    def _motion(self) -> str:
        if self._cycle_count:
            return 'stick-slip'
        if self._mode not in _NO_SLIP:
            return SWINGS_ON if self._swings_on else 'smooth sliding'
        return 'single slip' if self._has_moved else 'at rest'


    @property
    def _swings_on(self) -> bool:
        """Whether the speed of the slip at hand swings as much as it did before."""
        speeds = list(self._speeds)
        if len(speeds) < 2 * _LOOKED_AT:
            return False
        before, now = (max(part) - min(part) for part in (speeds[:_LOOKED_AT], speeds[_LOOKED_AT:]))
        return now > _CALM * max(map(abs, speeds)) and now >= _SAME_SWING * before


class _Slip:
    """A slip, from the event that begins it to the one that ends it, or to the latest one."""

    def __init__(self, first: Event) -> None:
        self.first = self.last = first
        self.peak_speed = abs(first.velocity)

    @property
    def is_over(self) -> bool:
        """Whether the slider came to a stop."""
        return self.last is not self.first and self.last.kind in (EventKind.STICK, EventKind.REVERSE)

    def go_on(self, event: Event) -> None:
        """Take the next event of it."""
        self.last = event
        self.peak_speed = max(self.peak_speed, abs(event.velocity))


class _CycleFinder:
    """Makes a cycle of a slip that is over when the next one begins."""

    def __init__(self) -> None:
        self._slip: _Slip | None = None    # the latest one
        self._is_open = False

    def take(self, event: Event) -> Cycle | None:
        """Take the next event of a run; return the cycle that it completes."""
        slip = self._slip
        if slip is not None and self._is_open:
            slip.go_on(event)
            self._is_open = event.mode != Mode.STICK
        if not begins_slip(event):
            return None
        self._slip, self._is_open = _Slip(event), True
        return _cycle(slip, event) if slip is not None and slip.is_over else None


def _cycle(slip: _Slip, following: Event) -> Cycle:
    first, last = slip.first, slip.last
    return Cycle(
        begin=first.time,
        direction=first.direction,
        rest_time=first.rest_time,
        slip_time=elapsed(first, last),
        stick_time=elapsed(last, following),
        period=elapsed(first, following),
        slip_travel=first.direction * (last.position - first.position),
        jump=first.direction * (following.position - first.position),
        peak_speed=slip.peak_speed,
        break_away_force=abs(first.friction_force),
        break_away_drive_force=first.drive_force,
        arrest_drive_force=last.drive_force,
        static_coefficient=first.static_coefficient)


def _touches(cycle: Cycle, following: Event, before: Sequence[Cycle]) -> bool:
    """Whether a cycle only touches rest: it slips on the same way at once, or is a turn for no time.

    That is so where no force is left at standstill, as without friction and damping.  Rounding chooses what is listed.
    """
    if following.direction == cycle.direction:
        return cycle.stick_time <= LEAST_STICK * cycle.period
    return bool(before) and cycle.period <= LEAST_STICK * before[-1].period


def mean_cycle(cycles: Sequence[Cycle]) -> Cycle:
    """Return the means of the figures of cycles; the first begin.

    Where directions differ, direction is 0 and the drive forces are those along each slip, which would cancel.
    """
    count = len(cycles)
    directions = {cycle.direction for cycle in cycles}
    if len(directions) > 1:
        cycles = [cycle._replace(break_away_drive_force=cycle.direction * cycle.break_away_drive_force,
                                 arrest_drive_force=cycle.direction * cycle.arrest_drive_force) for cycle in cycles]
    _, _, *means = (math.fsum(column) / count for column in zip(*cycles, strict=True))
    return Cycle(cycles[0].begin, directions.pop() if len(directions) == 1 else 0, *means)


def _is_settled(cycles: Sequence[Cycle]) -> bool:
    if len(cycles) < 2:
        return False
    before, last = cycles[-2:]
    return before.direction == last.direction and bool(period_repeats(before.period, last.period, SETTLED))


# Figures of a run in words: numbers with their units, and a run in one line.

_IN_A_LINE = 6   # of OF_A_CYCLE
LABEL, _NUMBER = 21, 13    # columns


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


def summary_report(figures: Summary) -> Iterator[Part]:
    """Yield the events by kind and the kind of motion, then the figures of the cycles, if there are any."""
    counts = ', '.join(f'{n} {kind.name.lower()}' for kind, n in figures.events.items() if n and kind != EventKind.KNOT)
    said = [('events', counts or 'none'), ('motion', _motion(figures)), ('note', touch_note(figures))]
    yield facts([(label, text) for label, text in said if text], LABEL)
    if figures.last is not None and figures.mean is not None:
        yield Table(('', 'last cycle', f'mean of {figures.averaged}'),
                    [(head_of(name), *(quantity(getattr(cycle, name), unit_of(name))
                                       for cycle in (figures.last, figures.mean)))
                     for name in OF_A_CYCLE], least=(LABEL + 1, _NUMBER, _NUMBER))


def _motion(figures: Summary) -> str:
    text = f'{figures.motion}, {100.0 * figures.stick_share:.4g} % of the time in stick'
    if figures.cycles:
        text += f'; {counted(figures.cycles, "cycle")}, {"settled" if figures.settled else "not settled"}'
    return text


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
