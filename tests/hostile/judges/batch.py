# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A batch of one against the simulator: the same bits."""

import math

from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.figures.cycles import summary
from stickslip_sim.runs.batch import run_batch

from ..case import Find, Run

_LAST = ('rest_time', 'slip_time', 'stick_time', 'period', 'slip_travel', 'jump', 'peak_speed', 'break_away_force',
         'static_coefficient')


def judge(run: Run) -> None:
    """Run an axis under constant inputs in a batch; raises Find where a figure differs."""
    parts = run.parts
    if parts.load is not None:
        return
    inputs = [profile.values[0] for profile in (parts.drive, parts.force)
              if len(profile.starts) == 1 and profile.rates == (0.0,) and not profile.sinusoids
              and profile.period == math.inf]
    if len(inputs) < 2:
        return
    figures = run_batch(parts.axis, parts.duration, drive_velocity=inputs[0], external_force=inputs[1],
                        initial=parts.initial, threads=1)
    events = run.events
    start = run.start.mode if parts.initial.velocity != 0.0 else Mode.STICK
    known = summary(events, parts.duration, start)
    slips = [e.time for e in events if e.kind == EventKind.REVERSE or
             (e.kind == EventKind.BREAKAWAY and e.mode != Mode.STICK)]
    wanted = {'events': float(len(events)), 'cycles': float(known.cycles), 'complete': 1.0,
              'final_mode': float(run.stretches[-1][1].mode), 'first_break_away': slips[0] if slips else math.nan}
    for name in _LAST:
        wanted[name] = float(getattr(known.last, name)) if known.last is not None else math.nan
    for name, value in wanted.items():
        got = float(getattr(figures, name)[0])
        if not (got == value or (math.isnan(got) and math.isnan(value))):
            raise Find(f'{name} is {got!r} in a batch and {value!r} in a simulator')
