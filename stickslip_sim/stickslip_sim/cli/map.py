# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip map`: a sweep as a picture - a map of two parameters, or a bifurcation diagram of one."""

from contextlib import ExitStack
from typing import TYPE_CHECKING

import click

from . import completion
from .files import check_distinct, check_picture, say_written, whole
from .sweeping import print_failed

if TYPE_CHECKING:
    from ..plots.stability_map import Pick
    from ..study import Study
    from ..study.folder import Folder
    from ..study.picks import Ending
    from ..study.table import TableColumns

_MOST_PICKS = 6
_MOST_EVENTS = 10_000   # that a phase plane shows
_SWINGS_ON = 16.0        # times as long as it took to know that
_SHOWN = 'amplitude'


@click.command('map', short_help='Draw a sweep: a map, or a bifurcation diagram.')
@click.argument('folder', metavar='FOLDER', shell_complete=completion.complete_folders)
@click.option('--out', 'pictures', multiple=True, required=True, metavar='FILE.png|pdf|svg',
              help='Write the picture; may be given again.')
@click.option('--show', default=_SHOWN, metavar='FIGURE', help=f'What a map has in colours [default: {_SHOWN}].')
@click.option('--pick', 'picks', multiple=True, metavar='A,B',
              help='Draw the phase plane at these values of the two parameters, too.')
def map_(folder: str, pictures: tuple[str, ...], show: str, picks: tuple[str, ...]) -> None:
    """Draw the sweep in FOLDER: a map of two parameters, or a bifurcation diagram of one."""
    _check_pictures(pictures)
    from ..study.description import study_of
    from ..study.folder import Folder
    from ..study.pictures import check_drawable, draw_bifurcation, draw_map
    from ..study.table import read_columns
    from .progress import progress_bar

    swept = Folder(folder)
    study = study_of(swept.described())
    check_drawable(study, show)
    _check_picks(study, picks)
    _check_complete(swept)
    columns = read_columns(swept.table, study)
    with progress_bar('drawing') as progress, ExitStack() as files:
        motions = [_pick(study, columns, text) for text in picks]
        paths = [str(files.enter_context(whole(path))) for path in pictures]
        if len(study.names) == 1:
            draw_bifurcation(study, columns, paths, progress)
        else:
            draw_map(study, columns, show, motions, paths)
    print_failed(study, columns)
    say_written(*pictures)


def _check_pictures(pictures: tuple[str, ...]) -> None:
    for path in pictures:
        check_picture('--out', path)
    check_distinct([('--out', path) for path in pictures])


def _check_picks(study: 'Study', picks: tuple[str, ...]) -> None:
    from ..core.errors import InputError

    if picks and len(study.names) != 2:
        raise click.UsageError('--pick is for a map of two parameters.')
    if len(picks) > _MOST_PICKS:
        raise InputError('--pick', f'{len(picks)} times', f'given at most {_MOST_PICKS} times', 'pick fewer points')


def _check_complete(sweep: 'Folder') -> None:
    from ..core.errors import InputError

    if not sweep.is_complete:
        raise InputError('folder', str(sweep.path), 'that of a complete sweep', 'run the sweep again with --resume')


def _pick(study: 'Study', columns: 'TableColumns', text: str) -> 'Pick':
    """Return a point of the map with its motion."""
    from ..compare.drawn_motion import drawn_motion
    from ..compare.fresh import densely_sampled, simulate_densely
    from ..plots.stability_map import Pick
    from ..study.picks import ending_at, place_in_map, point_of
    from ..study.point_figures import Motion

    point = point_of(study, text)
    ending = ending_at(study, columns, point)
    shown = _time_shown(ending)
    is_known = shown == ending.run.duration
    motion = drawn_motion(densely_sampled(ending.run) if is_known else simulate_densely(ending.run.scene, shown))
    sticks = ending.motion == Motion.STICK_SLIP
    return Pick(*place_in_map(study, point), motion if sticks else motion._replace(cycle=None))


def _time_shown(ending: 'Ending') -> float:
    """Return how much of a motion a phase plane shows, s: all, longer where it swings on, less with many events."""
    run = ending.run
    return run.duration * min(_SWINGS_ON if ending.swings_on else 1.0, _MOST_EVENTS / max(len(run.events), 1))
