# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Runs of controllers side by side: a picture with a column for each, their figures of control, their limits."""

from collections.abc import Mapping
from pathlib import Path

from ..check.limits import load_limits
from ..check.report import check_run, checks_as_values, complaint, control_figures, matrix, plot_runs
from ..report.html import write_page
from ..report.model import Part, Picture
from ..report.values import versions
from ..runs import Run
from .pictures import PICTURE_KINDS

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
