# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip compare`: the paper's figures and statements, of runs or scenes; or the runs of controllers."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .arguments import SceneChanges, check_each_once, is_recorded, recorded_run, scene_changes, sources_argument, verb
from .files import FOLDER, new_folder, progress_bar, say_written, show

if TYPE_CHECKING:
    from ..runs import Run
    from ..scene import Scene

_MOST = 8        # runs, rows of a picture


@verb(short_help="Draw the paper's figures for a run and check its statements.")
@sources_argument
@click.option('--out', type=FOLDER, required=True, metavar='FOLDER', help='New folder for the report and the pictures.')
@click.option('--controllers', is_flag=True, help='Compare recorded runs of controllers side by side instead.')
@click.option('--limits', metavar='FILE.yaml', help='With --controllers: also check these limits (docs/check.md).')
@click.option('--window', metavar='A:B',
              help='With --controllers: this time span in s [default: where the setpoint moves].')
@click.option('--duration', type=float, metavar='SECONDS',
              help='Simulated time of a scene [default: 10 s, or more for 20 cycles].')
@scene_changes('Change a parameter of every scene.')
def compare(sources: tuple[str, ...], out: str, controllers: bool, limits: str | None, window: str | None,
            duration: float | None, changes: SceneChanges) -> None:
    """Draw runs like the paper's figures 4, 6, 7 and 8, and check which of its statements hold for each.

    Give run folders, or scenes to simulate.  The exit code is 3 if a statement that applies to a run does not hold.
    With a measured run (see import), the other runs are drawn over it and compared cycle by cycle; scenes start at its
    initial state and are driven by its measured drive and force.

    With --controllers, each run has a column with speed, error, drive force and its control figures.  The exit code is
    3 if one of --limits fails.
    """
    _check(sources, duration, changes)
    if controllers:
        _side_by_side(sources, limits, window, out)
        return
    if limits or window:
        raise click.UsageError('--limits and --window need --controllers.')
    from ..compare.report import write_comparison
    from ..core.errors import VerdictError

    with progress_bar('comparing') as progress:
        given = [_given(source, changes) for source in sources]
        with new_folder('--out', out) as folder:
            report, failed = write_comparison(given, sources, duration, folder, progress)
    show(report)
    say_written(str(Path(out) / 'report.html'))
    if failed:
        raise VerdictError(f'{len(failed)} of the statements that apply do not hold ({"; ".join(failed)})')


def _side_by_side(sources: tuple[str, ...], limits: str | None, window: str | None, out: str) -> None:
    from ..compare.report import write_controllers
    from ..core.errors import VerdictError
    from ..runs.report import Window

    check_each_once(sources)
    runs = {source: recorded_run(source) for source in sources}
    shown = None if window is None else Window.of(window).in_run(runs[sources[0]])
    with progress_bar('comparing'), new_folder('--out', out) as folder:
        report, failed = write_controllers(runs, limits, shown, folder)
    show(report)
    say_written(str(Path(out) / 'report.html'))
    if failed:
        raise VerdictError(failed)


def _check(runs: tuple[str, ...], duration: float | None, changes: SceneChanges) -> None:
    """Raise before the work begins when there are too many runs or an option has no effect."""
    from ..core.errors import InputError

    if len(runs) > _MOST:
        raise InputError('RUN_OR_SCENE', f'{len(runs)} runs', f'at most {_MOST} at once', 'compare fewer')
    if all(map(is_recorded, runs)):
        for option, given in (('--duration', duration), ('--set', changes.overrides or None)):
            if given is not None:
                raise click.UsageError(f'{option} applies to scenes, but these are all recorded runs.')


def _given(source: str, changes: SceneChanges) -> 'Run | Scene':
    """Return a recorded run, refused before the work begins, or a scene."""
    from ..recording import MeasuredRun

    if not is_recorded(source):
        return changes.load(source)
    run = recorded_run(source)
    _ = run.begin, run.events, isinstance(run, MeasuredRun) or run.scene
    return run
