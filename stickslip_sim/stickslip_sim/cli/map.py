# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip map`: a sweep as a picture - a map of two parameters, or a bifurcation diagram of one."""

from contextlib import ExitStack

import click

from . import completion
from .arguments import check_usage, verb
from .files import PICTURE, progress_bar, say_written, show, whole

_MOST_PICKS = 6
_SHOWN = 'amplitude'


@verb('map', short_help='Plot a sweep as a map or a bifurcation diagram.')
@click.argument('folder', metavar='FOLDER', shell_complete=completion.complete_folders)
@click.option('--out', 'pictures', multiple=True, required=True, type=PICTURE,
              metavar='FILE.png|pdf|svg', help='Picture to write; repeatable.')
@click.option('--show', 'shown', default=_SHOWN, metavar='FIGURE',
              help=f'Figure to colour a map by [default: {_SHOWN}].')
@click.option('--pick', 'picks', multiple=True, metavar='A,B',
              help='Also plot the phase plane at these values of the two parameters.')
def map_(folder: str, pictures: tuple[str, ...], shown: str, picks: tuple[str, ...]) -> None:
    """Plot the sweep in FOLDER as a map of two parameters or a bifurcation diagram of one."""
    from ..compare.pictures import picked
    from ..core.errors import InputError
    from ..study.diagrams import check_drawable, draw_bifurcation, draw_map
    from ..study.folder import Folder
    from ..study.report import failed_report
    from ..study.study import study_of
    from ..study.table import read_columns

    swept = Folder(folder)
    study = study_of(swept.described())
    check_drawable(study, shown)
    check_usage((picks and len(study.names) != 2, '--pick needs a map of two parameters.'))
    if len(picks) > _MOST_PICKS:
        raise InputError('--pick', f'{len(picks)} times', f'given at most {_MOST_PICKS} times', 'pick fewer points')
    if not swept.is_complete:
        raise InputError('folder', str(swept.path), 'that of a complete sweep', 'run the sweep again with --resume')
    columns = read_columns(swept.table, study)
    with progress_bar('drawing') as progress, ExitStack() as files:
        motions = [picked(study, columns, text) for text in picks]
        paths = [str(files.enter_context(whole(path))) for path in pictures]
        if len(study.names) == 1:
            draw_bifurcation(study, columns, paths, progress)
        else:
            draw_map(study, columns, shown, motions, paths)
    show(failed_report(study, columns))
    say_written(*pictures)
