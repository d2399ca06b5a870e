# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip compare`: the paper's figures and statements, from recorded runs or from scenes."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from . import completion
from .files import check_new_folder, new_folder, say_written
from .run_or_scene import file_stem, is_recorded, recorded_run
from .scene_changes import SceneChanges, scene_changes

if TYPE_CHECKING:
    from ..compare.as_measured import AsMeasured
    from ..compare.report_folder import Compared
    from ..recording import MeasuredRun
    from ..runs import Run
    from ..scene import Scene

_MOST = 8        # runs, rows of a picture
_OF_RUNS = 0.2   # of the time, about


@click.command(short_help="Draw the paper's figures for a run, and check its statements.")
@click.argument('runs', nargs=-1, required=True, metavar='RUN_OR_SCENE...', shell_complete=completion.complete_scenes)
@click.option('--out', required=True, metavar='FOLDER', help='New folder for the report and the pictures.')
@click.option('--duration', type=float, metavar='S',
              help='Simulated time of a scene, s [default: 10 s, or more for 20 cycles].')
@scene_changes('Change a parameter of every scene.')
def compare(runs: tuple[str, ...], out: str, duration: float | None, changes: SceneChanges) -> None:
    """Draw runs as the paper's figures 4, 6, 7 and 8, and say which statements of the paper hold on each.

    A run is the folder of a recorded one, or a scene, which is simulated.  Exit with 3 when a statement that applies
    to a run does not hold.  With a measured run (see import) the others are drawn over it, and differences of their
    cycles listed; a scene then starts where that run does, and what was measured of its drive and force moves it.
    """
    _check(runs, out, duration, changes)
    from ..compare.report_folder import write_report
    from ..core.errors import VerdictError
    from .progress import progress_bar

    sources: list[Run] = []
    with progress_bar('comparing') as progress:
        given = [_given(run, changes) for run in runs]
        measured = _first_measured(given)
        if measured is None:
            for k, one in enumerate(given):
                sources.append(_run(one, duration))
                if progress:
                    progress(_OF_RUNS * (k + 1) / len(runs))
            with new_folder('--out', out) as folder:
                compared = write_report(named_apart(sources), folder, progress and (
                    lambda share: progress(_OF_RUNS + (1.0 - _OF_RUNS) * share)))
    if measured is not None:
        _print_beside([_beside(one, source, measured, duration) for one, source in zip(given, runs)], out)
        return
    for each in compared:
        _print_compared(each)
    say_written(str(Path(out) / 'report.html'))
    failed = [f'{found.name}: {name}' for found in compared for name in found.failed]
    if failed:
        raise VerdictError(f'{len(failed)} of the statements that apply do not hold ({"; ".join(failed)})')


def _check(runs: tuple[str, ...], out: str, duration: float | None, changes: SceneChanges) -> None:
    """Raise before the work begins when the output cannot be written or an option has no effect."""
    from ..core.errors import InputError

    check_new_folder('--out', out)
    if len(runs) > _MOST:
        raise InputError('RUN_OR_SCENE', f'{len(runs)} runs', f'at most {_MOST} at once', 'compare fewer')
    if all(map(is_recorded, runs)):
        for option, given in (('--duration', duration), ('--set', changes.overrides or None)):
            if given is not None:
                raise click.UsageError(f'{option} is for scenes, and all of these are recorded runs.')


def _given(source: str, changes: SceneChanges) -> 'Run | Scene':
    """Return a recorded run, refused before the work begins, or a scene."""
    if not is_recorded(source):
        return changes.load(source)
    run = recorded_run(source)
    _ = run.begin, run.events, _first_measured([run]) or run.scene
    return run


def _run(given: 'Run | Scene', duration: float | None) -> 'Run':
    from ..advise.duration import default_duration
    from ..compare.fresh import simulate_densely
    from ..scene import Scene

    if not isinstance(given, Scene):
        return given
    return simulate_densely(given, default_duration(given) if duration is None else duration)


def _beside(given: 'Run | Scene', source: str, measured: 'MeasuredRun', duration: float | None) -> 'Run | AsMeasured':
    from ..compare.as_measured import as_measured
    from ..scene import Scene

    return as_measured(given, source, measured, duration) if isinstance(given, Scene) else given


def named_apart(runs: list['Run']) -> dict[str, 'Run']:
    """Give each run a name of its own that is good for a file, too."""
    named: dict[str, Run] = {}
    for run in runs:
        stem = file_stem(run)
        name = next(name for name in (stem, *(f'{stem}_{k}' for k in range(2, _MOST + 1))) if name not in named)
        named[name] = run
    return named


def _first_measured(given: 'Sequence[Run | Scene]') -> 'MeasuredRun | None':
    from ..recording import MeasuredRun

    return next((one for one in given if isinstance(one, MeasuredRun)), None)


def _print_beside(given: 'list[Run | AsMeasured]', out: str) -> None:
    """Compare runs with a measured one; raises InputError without any beside it."""
    from ..compare.as_measured import AsMeasured
    from ..compare.beside_measured import write_beside
    from ..core.errors import InputError

    runs = [one.run if isinstance(one, AsMeasured) else one for one in given]
    if len(runs) < 2:
        raise InputError('RUN_OR_SCENE', runs[0].name, 'two runs or more with a measured one',
                         'add a scene, or the run of one')
    named = named_apart(runs)
    followed = {name: one for name, one in zip(named, given) if isinstance(one, AsMeasured)}
    with new_folder('--out', out) as folder:
        measured, beside = write_beside(named, followed, folder)
    for note in named[measured].notes:
        print(f'{measured}: {note}')
    for one in beside:
        print(f'{one.name} beside {measured}{", means of the last ten cycles" if one.differences else ""}:')
        for line in one.lines:
            print(f'  {line}')
        for each in one.differences:
            print(f'  {each.name:25} {each.text}')
    say_written(str(Path(out) / 'report.html'))


def _print_compared(compared: 'Compared') -> None:
    from ..runs.wording import headline

    print(f'{compared.name}: {headline(compared.run.summary)}')
    for note in compared.run.notes:
        print(f'  note: {note}')
    for statement, finding in compared.findings:
        print(f'  {finding.outcome.value:15} {statement.name}: {finding.text}')
