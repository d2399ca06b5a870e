"""`stickslip sweep`: a scene at many values of its parameters, and the cycle figures of each point."""

import os
import shlex
import sys
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from ..study import Study
    from ..study.folder import Folder

_MOST_WORKERS = 1024


@click.command()
@click.argument('scene', metavar='SCENE')
@click.option('--over', 'ranges', multiple=True, required=True, metavar='A.B=LOW:HIGH:N[:log]',
              help='Vary a parameter, or an element of a list: A.B[1]. Given again: every combination.')
@click.option('--sobol', type=int, metavar='N', help='Draw N points (Sobol) instead; then --over A.B=LOW:HIGH[:log].')
@click.option('--out', required=True, metavar='FOLDER', help='Write points.csv (with pandas .parquet too) there.')
@click.option('--duration', type=float, metavar='S', help='Simulated time, s [default: until the motion settles].')
@click.option('--workers', default='1', metavar='N|all', help='Processes to use [default: 1].')
@click.option('--resume', is_flag=True, help='Go on with a sweep that was interrupted.')
@click.option('--set', 'changes', multiple=True, metavar='A.B=VALUE', help='Change a parameter of the scene.')
def sweep(scene: str, ranges: tuple[str, ...], sobol: int | None, out: str, duration: float | None, workers: str,
          resume: bool, changes: tuple[str, ...]) -> None:
    """Run SCENE at many values of its parameters; write motion, amplitude, period and more of each.

    Ctrl-C keeps what is done.  `stickslip map FOLDER` draws it.
    """
    processes = _processes(workers)
    from ..study import sweep as work
    from ..study.folder import Folder

    study, folder = _study(scene, ranges, sobol, duration, changes), Folder(out)
    if resume:
        folder.check_same(study)
    else:
        folder.begin(study, shlex.join(['stickslip', *sys.argv[1:]]))
    from .progress import progress_bar
    try:
        with progress_bar('sweeping') as progress:
            ran = work.sweep(study, folder, processes, progress)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f'interrupted; what is done is kept in {out}, --resume goes on') from None
    _tell(study, folder, ran)


def _study(scene: str, ranges: tuple[str, ...], sobol: int | None, duration: float | None,
           changes: tuple[str, ...]) -> 'Study':
    from ..scene import load_scene, parse_override
    from ..study import Grid, Sobol, Study, variation

    loaded = load_scene(scene, dict(parse_override(change) for change in changes))
    variations = tuple(variation(text, drawn=sobol is not None) for text in ranges)
    sample = Grid(variations) if sobol is None else Sobol(variations, sobol, loaded.seed)
    return Study(loaded.values, sample, duration)


def _processes(workers: str) -> int:
    from ..errors import InputError

    if workers == 'all':
        return len(os.sched_getaffinity(0))
    if not workers.isascii() or not workers.isdigit() or not 1 <= int(workers[:5]) <= _MOST_WORKERS:
        raise InputError('--workers', workers, f'a whole number from 1 to {_MOST_WORKERS}, or all',
                         'leave it out for 1')
    return int(workers)


def _tell(study: 'Study', folder: 'Folder', ran: int) -> None:
    from collections import Counter

    from ..study.figures import MOTIONS, Motion
    from ..study.folder import TABLE
    from ..study.table import read_columns

    columns = read_columns(folder.path / TABLE, study)
    counts = Counter(MOTIONS[Motion(int(motion))] for motion in columns['motion'])
    motions = ', '.join(f'{count} {word}' for word, count in counts.most_common())
    unsettled = int((columns['settled'] == 0.0).sum())
    print(f'{study.scene.name}: {study.count} points, {ran} of them run now: {motions}'
          + (f'; {unsettled} had not settled' if unsettled else ''))
    print(f'{folder.path / TABLE}')
