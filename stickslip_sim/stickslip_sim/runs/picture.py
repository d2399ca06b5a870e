# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of any run: the whole of it, and beside it a window, or its last cycles; and of runs over each other."""

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Columns, Numbers
from ..core.errors import InputError
from ..core.time_grid import Instants
from ..core.types import Event, EventKind
from ..figures.cycles import headline
from ..plots import plot_run
from ..plots.overlay import Bound, plot_over_each_other
from ..plots.run import DrawnRun, TimeWindow, drawn_run
from ..scene import Scene
from .run import LOAD_COLUMN, STANDS, Run, normal_force_of
from .samples import reduced
from .simulated import SimulatedRun, columns_at

# When to sample a simulated run for its picture: so that no line shows the rate, however long the run is.
#
# Where a picture has room for every slip, each stretch between two events is sampled densest after its start, where a
# compliant contact rings.  Where it has not, it is made of bands: one cycle in each part of it is sampled so.

_IN_STRETCH = 32     # samples between two events
_IN_BAND = 20        # where only the least and the most of a cycle are seen
_MOST = 6000         # stretches that are all sampled
_PARTS = 480         # of a window with more: two for each place that a picture has
_EVEN = 6000         # samples of a window beside those
_IN_PERIOD = 16      # of them at least in a period of a sinusoid, or none is met at the same phases throughout
_GOLDEN = 0.618033988749895   # its multiples are nowhere even


def sampled(scene: Scene, events: Sequence[Event], windows: Iterable[tuple[float, float]]) -> Columns:
    """Return samples of a run of a scene, whose events are known, for a picture of some windows (s) of it."""
    times = np.array([event.time for event in events], dtype=np.float64)
    breaks = np.array([event.time for event in events if event.kind == EventKind.BREAKAWAY], dtype=np.float64)
    fastest = max((one.frequency for profile in scene.inputs for one in profile.sinusoids), default=0.0)
    instants = np.unique(np.concatenate([part for begin, end in windows for part in (
        _evenly(fastest, begin, end), _by_events(times, breaks, begin, end))]))
    seconds = np.floor(instants)
    return {**columns_at(scene.make_rig(), Instants(seconds, instants - seconds)), **normal_force_of(scene, instants)}


def _evenly(fastest: float, begin: float, end: float) -> Numbers:
    """Return times in a window, s, even ones where they resolve the fastest sinusoid (Hz)."""
    places = np.arange(_EVEN, dtype=np.float64)
    if fastest * (end - begin) * _IN_PERIOD > _EVEN:
        places += _GOLDEN * places % 1.0
    return np.append(begin + places * ((end - begin) / _EVEN), end)


def _by_events(events: Numbers, breaks: Numbers, begin: float, end: float) -> Numbers:
    """Return times in a window, s, that show what happens between its events."""
    inside = events[(events > begin) & (events < end)]
    starts, ends = np.append(begin, inside), np.append(inside, end)
    count = _IN_STRETCH
    if len(inside) > _MOST:
        chosen = _one_cycle_in_each(breaks, starts, begin, end)
        starts, ends, count = starts[chosen], ends[chosen], _IN_BAND
    share = np.linspace(0.0, 1.0, count, endpoint=False) ** 2
    return np.asarray((starts[:, None] + (ends - starts)[:, None] * share).ravel(), dtype=np.float64)


def _one_cycle_in_each(breaks: Numbers, starts: Numbers, begin: float, end: float) -> NDArray[np.bool_]:
    """Return which stretches, by their starts, belong to the first whole cycle in one of the parts of a window."""
    edges = np.linspace(begin, end, _PARTS + 1)
    chosen = np.zeros(len(starts), dtype=np.bool_)
    first = np.searchsorted(breaks, edges[:-1])
    for k, last in zip(first.tolist(), np.searchsorted(breaks, edges[1:]).tolist()):
        if last - k > 1:
            chosen[np.searchsorted(starts, breaks[k]):np.searchsorted(starts, breaks[k + 1])] = True
    return chosen


_READABLE = 40   # cycles of the latest period, in all of a run
_SHOWN = 5       # cycles at the end of a longer one
_MOST_OF = 0.8   # of a run: commanded for less, that part is shown
_MARGIN = 0.25   # of a period, before and after them
_BESIDE_A_MOVE = 0.1   # of its length, before and behind it
_DRAWN = ('position', 'velocity', 'drive_position', 'drive_velocity', 'drive_force', 'friction_force',
          'external_force', LOAD_COLUMN, 'mode')


def draw_run(run: Run, window: tuple[float, float] | None, *paths: Path | str) -> Any:
    """Draw a run into each path; return the figure.  Raises InputError for a window (s) that is not in it."""
    windows = windows_of(run, window, _commanded(run))
    return plot_run(_drawn(run, _title(run), windows, run.setpoint), windows, *paths)


class RunBeside(NamedTuple):
    """A run to be drawn beside others, the setpoint that its error is one to (empty: none), and limits on it."""

    run: Run
    setpoint: Columns
    bounds: Sequence[Bound] = ()


def draw_runs(runs: Mapping[str, RunBeside], window: tuple[float, float] | None, are_apart: bool, *paths: Path | str
              ) -> TimeWindow:
    """Draw runs by their names over each other, or a column for each, into each path.

    Without a window (s) that of their moves; returns it.  Raises InputError for one that is not in each of them.
    """
    parts = [windows_of(one.run, window)[-1] if window else _move_of(*one[:2]) for one in runs.values()]
    shown = TimeWindow(min(part.begin for part in parts), max(part.end for part in parts))
    drawn = [_drawn(one.run, name, [shown], one.setpoint) for name, one in runs.items()]
    plot_over_each_other(drawn, shown, [one.bounds for one in runs.values()], are_apart, *paths)
    return shown


def _move_of(run: Run, setpoint: Columns) -> TimeWindow:
    """Return from when to when the setpoint moves, and some more; without one the part that its own picture shows."""
    moves = setpoint['time'][1:][np.abs(np.diff(setpoint['position'])) > STANDS] if setpoint else np.empty(0)
    if not len(moves):
        return windows_of(run, None, _commanded(run))[-1]
    margin = _BESIDE_A_MOVE * (moves[-1] - moves[0])
    return TimeWindow(max(float(moves[0] - margin), run.begin), min(float(moves[-1] + margin), run.end))


def _drawn(run: Run, title: str, windows: Sequence[TimeWindow], setpoint: Columns) -> DrawnRun:
    commands = reduced(run.command_blocks(), windows, ['velocity'])
    drawn = drawn_run(title, _samples_for(run, windows), run.events, commands, run.marks)
    if not setpoint:
        return drawn
    return drawn._replace(setpoint=reduced([setpoint], windows, [name for name in setpoint if name != 'time']))


def first_command(run: Run) -> float | None:
    """Return when the first drive velocity was taken, s; None of a run without any."""
    span = _commanded(run)
    return None if span is None else span.begin


def _commanded(run: Run) -> TimeWindow | None:
    """Return from the first command to the last."""
    ends = [float(time) for block in run.command_blocks() if len(block['time']) for time in block['time'][[0, -1]]]
    return TimeWindow(max(ends[0], run.begin), min(ends[-1], run.end)) if ends else None


def windows_of(run: Run, window: tuple[float, float] | None, commanded: TimeWindow | None = None) -> list[TimeWindow]:
    """Return what is drawn side by side: the whole run, and a part of it that is asked for or needed.

    Of a run that was `commanded` in a part of it alone that part is needed, as far as it can be read.
    """
    whole = TimeWindow(run.begin, run.end)
    if window is not None:
        begin, end = window
        if not whole.begin <= begin < end <= whole.end:
            raise InputError('window', f'{begin:g}:{end:g}', f'A:B with {whole.begin:g} <= A < B <= {whole.end:g} s, '
                             'the time of the run', 'give two times of the run, in s')
        return [whole] if TimeWindow(begin, end) == whole else [whole, TimeWindow(begin, end)]
    cycles = run.cycles()
    if commanded is not None and commanded.end - commanded.begin < _MOST_OF * run.duration:
        within = [cycle.period for cycle in cycles if commanded.begin <= cycle.begin <= commanded.end]
        longest = _READABLE * sum(within) / len(within) if within else math.inf
        part = TimeWindow(commanded.begin, min(commanded.end, commanded.begin + longest))
        return [whole, part] if part.end > part.begin else [whole]
    last = cycles[-_SHOWN:]
    if not last:
        return [whole]
    period = sum(cycle.period for cycle in last) / len(last)
    if run.duration <= _READABLE * period:
        return [whole]
    begin, end = last[0].begin - _MARGIN * period, last[-1].begin + last[-1].period + _MARGIN * period
    return [whole, TimeWindow(max(begin, whole.begin), min(end, whole.end))]


def _samples_for(run: Run, windows: Sequence[TimeWindow]) -> Columns:
    """Return samples that a picture needs: of a run that its scene alone decides, taken for it."""
    if isinstance(run, SimulatedRun) and (run.sample_period is not None or not len(run.samples['time'])):
        return sampled(run.scene, run.events, windows)
    return reduced(run.sample_blocks(), windows, _DRAWN)


def _title(run: Run) -> str:
    """Return the heading, the figures of the last cycle below it, and in a line of its own what is missing."""
    gaps = [] if run.is_complete else ['no end: cut off, or still being written']
    gaps += [f'{run.missing_steps} steps are missing'] if run.missing_steps else []
    lines = [f'{run.title}, {run.duration:.6g} s', headline(run.summary), ' · '.join(gaps)]
    return '\n'.join(filter(None, lines))
