# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the demonstration prints about its recorded run: read back from the bag, with nothing else to go by."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..check.observed_run import Timing, timing_of
from ..recording import read_run
from ..simulation.cycles import Summary

_PICTURE = 'run.png'
_FIGURES = (
    ('period', 'period', 1.0, 's'), ('stick time', 'stick_time', 1.0, 's'), ('slip time', 'slip_time', 1.0, 's'),
    ('jump', 'jump', 1e3, 'mm'), ('peak speed', 'peak_speed', 1e3, 'mm/s'),
    ('break-away force', 'break_away_force', 1.0, 'N'),
)


def report(folder: Path) -> list[str]:
    """Draw the picture of a run into its folder; return the lines to print about it."""
    run = read_run(folder)
    run.plot(folder / _PICTURE)
    return [f'bag      {folder} ({sum(run.bag.counts.values())} messages)', f'picture  {folder / _PICTURE}',
            *cycle_lines(run.summary), *timing_lines(run.bag.columns('/timing')),
            *(real_time_lines(timing) if (timing := timing_of(run)) and run.is_complete else [])]


def real_time_lines(timing: Timing) -> list[str]:
    """Return whether the run kept real time, and what that means where it did not."""
    late = ['the motion is right, the timing was late, as the machine had other work; where that matters,',
            'lock-step is the way (-p time.mode:=lockstep, docs/hil.md): time waits for steps and controller']
    return [f'verdict  {timing.verdict}', *(f'         {line}' for line in late if timing.valid is False)]


def cycle_lines(figures: Summary) -> list[str]:
    """Return the cycle figures."""
    if figures.last is None:
        return [f'cycles   none: {figures.motion}']
    lines = [f'{name:17} {getattr(figures.last, field) * scale:9.4g} {unit}' for name, field, scale, unit in _FIGURES]
    return [f'cycles   {figures.cycles}; of the last one:', *(f'         {line}' for line in lines)]


def timing_lines(windows: dict[str, NDArray[Any]]) -> list[str]:
    """Return how the steps kept their time, from the seconds recorded."""
    if not len(windows['steps']):
        return ['timing   no second was completed']
    micro = 1e6
    return [
        f'timing   {windows["steps"].sum()} steps of {windows["period"][0] * 1e3:g} ms; lateness'
        f' p50 {np.nanmedian(windows["lateness_p50"]) * micro:.0f} µs,'
        f' p99 {np.nanmedian(windows["lateness_p99"]) * micro:.0f} µs (median of the seconds),'
        f' max {np.nanmax(windows["lateness_max"]) * micro:.0f} µs',
        f'         cost p50 {np.nanmedian(windows["cost_p50"]) * micro:.0f} µs,'
        f' p99 {np.nanmedian(windows["cost_p99"]) * micro:.0f} µs;'
        f' {windows["total_overruns"][-1]} overruns, {windows["total_caught_up"][-1]} steps caught up',
    ]
