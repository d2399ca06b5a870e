# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The part of a run that a limit is for, in times of the run or from its first command on."""

import math
from dataclasses import replace
from typing import NamedTuple

from ..config.strict import section
from ..core.errors import InputError
from ..scene import Parameter

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
