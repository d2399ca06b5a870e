# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip compare`: the paper's figures and statements, from recorded runs or from scenes."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from .files import check_new_folder, new_folder
from .run_or_scene import is_recorded

if TYPE_CHECKING:
    from ..compare.history import History
    from ..compare.report_folder import Judged

_MOST = 8   # runs, rows of a picture


@click.command(short_help="Draw the paper's figures for a run, and judge its statements.")
@click.argument('runs', nargs=-1, required=True, metavar='RUN_OR_SCENE...')
@click.option('--out', required=True, metavar='FOLDER', help='New folder for the report and the pictures.')
@click.option('--duration', type=float, metavar='S',
              help='Simulated time of a scene, s [default: 10 s, or more for 20 cycles].')
@click.option('--set', 'changes', multiple=True, metavar='A.B=VALUE', help='Change a parameter of every scene.')
def compare(runs: tuple[str, ...], out: str, duration: float | None, changes: tuple[str, ...]) -> None:
    """Draw runs as the paper's figures 4, 6, 7 and 8, and judge what the paper says on each.

    A run is the folder of a recorded one, or a scene, which is simulated.  Exit with 3 when a statement that applies
    to a run does not hold.
    """
    _check(runs, out, duration, changes)
    from ..compare.report_folder import write_report
    from ..core.errors import VerdictError
    from .progress import progress_bar

    histories = []
    with progress_bar('comparing') as progress:
        for k, run in enumerate(runs):
            histories.append(_history(run, duration, changes))
            if progress:
                progress((k + 1) / (2 * len(runs)))
        with new_folder('--out', out) as folder:
            judged = write_report(_named_apart(histories), folder)
    for run_judged in judged:
        _tell(run_judged)
    print(f'written: {Path(out) / "report.html"}')
    failed = [f'{found.history.name}: {name}' for found in judged for name in found.failed]
    if failed:
        raise VerdictError(f'{len(failed)} of the statements that apply do not hold ({"; ".join(failed)})')


def _check(runs: tuple[str, ...], out: str, duration: float | None, changes: tuple[str, ...]) -> None:
    """Raise before the work begins when the output cannot be written or an option has no effect."""
    from ..core.errors import InputError

    check_new_folder('--out', out)
    if len(runs) > _MOST:
        raise InputError('RUN_OR_SCENE', f'{len(runs)} runs', f'at most {_MOST} at once', 'compare fewer')
    if all(map(is_recorded, runs)):
        for option, given in (('--duration', duration), ('--set', changes or None)):
            if given is not None:
                raise click.UsageError(f'{option} is for scenes, and all of these are recorded runs.')


def _history(run: str, duration: float | None, changes: tuple[str, ...]) -> 'History':
    from ..advise.duration import default_duration
    from ..compare.fresh import simulate
    from ..compare.recorded import history_of_run
    from ..scene import load_scene, parse_override

    if is_recorded(run):
        return history_of_run(run)
    scene = load_scene(run, dict(parse_override(change) for change in changes))
    return simulate(scene, default_duration(scene) if duration is None else duration)


def _named_apart(histories: list['History']) -> list['History']:
    """Give each run a name of its own that is good for a file, too."""
    from dataclasses import replace

    from ..scene.text import file_name

    named: dict[str, History] = {}
    for history in histories:
        stem = file_name(history.name)
        name = next(name for name in (stem, *(f'{stem}_{k}' for k in range(2, _MOST + 1))) if name not in named)
        named[name] = replace(history, name=name)
    return list(named.values())


def _tell(run: 'Judged') -> None:
    from .format import headline

    print(f'{run.history.name}: {headline(run.history.summary)}')
    for note in run.history.notes:
        print(f'  note: {note}')
    for statement, finding in run.findings:
        print(f'  {finding.outcome.value:15} {statement.name}: {finding.text}')
