# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip identify`: from a measured run to the scene that reproduces it, and how well that is known."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from . import completion
from .arguments import SceneChanges, recorded_run, scene_changes
from .files import check_new_folder, end_with, milestones, new_folder, progress_bar

if TYPE_CHECKING:
    from ..identification.many_fits import WorkFolder


@click.command(short_help='Find the parameters of an axis from a measured run.')
@click.argument('runs', nargs=-1, required=True, metavar='RUN...', shell_complete=completion.complete_folders)
@click.option('--scene', required=True, metavar='SCENE', shell_complete=completion.complete_scenes,
              help='Scene to start from: a file or a shipped one.')
@click.option('--free', required=True, metavar='FILE.yaml', help='Free parameters and their ranges.')
@click.option('--out', required=True, metavar='FOLDER', help='New folder for the results.')
@click.option('--laws', is_flag=True, help='Also fit other friction laws and name the best.')
@click.option('--test', 'tests', multiple=True, metavar='RUN', help='Predict this run with the identified scene.')
@click.option('--each', multiple=True, metavar='A.B', help='Fit this free parameter separately for each run.')
@click.option('--workers', metavar='N|all', help='Number of processes [default: 1].')
@click.option('--resume', is_flag=True, help='Continue an interrupted search.')
@scene_changes('Change a parameter of the initial scene.')
def identify(runs: tuple[str, ...], scene: str, free: str, out: str, laws: bool, tests: tuple[str, ...],
             each: tuple[str, ...], workers: str | None, resume: bool, changes: SceneChanges) -> None:
    """Find the scene that reproduces one or more measured runs, with confidence intervals.

    FOLDER receives the scene identified.yaml, its remaining uncertainty in posterior.yaml (for uncertainty --with),
    report.html and report.json.  The exit code is 3 if the model does not fit; the report shows where.  Ctrl-C keeps
    the finished fits.
    """
    from ..study.folder import process_count

    if not resume:
        check_new_folder('--out', out)
    count = process_count('1' if workers is None else workers)
    from ..identification.identify import identify as find
    from ..identification.many_fits import WorkFolder, facts_of
    from ..identification.report import IDENTIFIED_PAGE, result_lines, write_results
    from ..scene.load import read_text

    start = changes.load(scene)
    measured, given = [*map(recorded_run, runs)], [*map(recorded_run, tests)]
    names = ' and '.join(one.name for one in measured)
    sought = read_text(Path(free), 'file of distributions') + ' '.join(each)
    work = WorkFolder(out, facts_of(measured, start, sought), resume)
    with _going_on(work), progress_bar('identifying') as progress:
        found = find(measured, start, free, workers=count, laws=laws, keeper=work, test=given, each=each,
                     progress=milestones('identifying') if progress is None else lambda _, share: progress(share))
    with new_folder('--out', work.results) as folder:
        write_results(measured[0], found, scene, folder, names)
    work.finish()
    print('\n'.join(result_lines(found, names)))
    print(f'written: {Path(out) / IDENTIFIED_PAGE}')
    end_with('' if found.fits else f'the model does not fit {names}: {found.misfits[0].statement}; '
                                   f'{Path(out) / IDENTIFIED_PAGE} shows where')


@contextmanager
def _going_on(work: 'WorkFolder') -> Iterator[None]:
    """Say how an interrupted identification goes on."""
    try:
        yield
    except KeyboardInterrupt:
        if not work.exists:
            raise
        raise KeyboardInterrupt(f'interrupted; what is done is kept in {work.path}, --resume goes on') from None
