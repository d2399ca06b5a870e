# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of any run: the whole of it, and beside it a window, or the last cycles of a run that is long."""

import math
from pathlib import Path

from ..core.errors import InputError
from ..plots import plot_run
from ..plots.drawn_run import TimeWindow, drawn_run
from .normal_force import LOAD_COLUMN
from .picture_samples import sampled
from .reduced import reduced
from .run import Columns, Run
from .simulated import SimulatedRun
from .wording import headline

_READABLE = 40   # cycles of the latest period, in all of a run
_SHOWN = 5       # cycles at the end of a longer one
_MOST_OF = 0.8   # of a run: commanded for less, that part is shown
_MARGIN = 0.25   # of a period, before and after them
_DRAWN = ('position', 'velocity', 'drive_position', 'drive_velocity', 'drive_force', 'friction_force',
          'external_force', LOAD_COLUMN, 'mode')


def draw_run(run: Run, window: tuple[float, float] | None, *paths: Path | str) -> None:
    """Draw a run into each path; raises InputError for a window (s) that is not in it."""
    commands_at = _commanded(run)
    windows = windows_of(run, window, commands_at)
    samples = _samples_for(run, windows)
    commands = reduced(run.command_blocks(), windows, ['velocity'])
    plot_run(drawn_run(_title(run), samples, run.events, commands, run.marks), windows, *paths)


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


def _samples_for(run: Run, windows: list[TimeWindow]) -> Columns:
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
