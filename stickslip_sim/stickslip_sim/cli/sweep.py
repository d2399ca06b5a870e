# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip sweep`: a scene at many values of its parameters, and the cycle figures of each point."""

from typing import TYPE_CHECKING

import click

from . import completion
from .files import say_written
from .scene_changes import SceneChanges
from .sweeping import carry_out, print_failed, study_options, workers_of

if TYPE_CHECKING:
    from ..study import Study
    from ..study.sweep import Swept


@click.command(short_help='Run a scene at many values of its parameters.')
@click.argument('scene', metavar='SCENE', shell_complete=completion.complete_scenes)
@click.option('--over', 'ranges', multiple=True, required=True, metavar='A.B=LOW:HIGH:N[:log]',
              shell_complete=completion.complete_parameters,
              help='Vary a parameter, or an element of a list: A.B[1]. Given again: every combination.')
@click.option('--sobol', type=int, metavar='N', help='Draw N points (Sobol) instead; then --over A.B=LOW:HIGH[:log].')
@study_options
def sweep(scene: str, ranges: tuple[str, ...], sobol: int | None, out: str, duration: float | None,
          workers: str | None, scheduler: str | None, resume: bool, changes: SceneChanges) -> None:
    """Run SCENE at many values of its parameters; write motion, amplitude, period and more of each.

    Ctrl-C keeps the finished points.  `stickslip map FOLDER` draws it.
    """
    members = workers_of(workers, scheduler)
    study = _study(scene, ranges, sobol, duration, changes)
    folder, swept = carry_out(study, out, members, resume)
    _print_summary(study, swept)
    say_written(str(folder.table))


def _study(scene: str, ranges: tuple[str, ...], sobol: int | None, duration: float | None,
           changes: SceneChanges) -> 'Study':
    from ..study import EvenGrid, Sobol, Study, variation

    loaded = changes.load(scene)
    variations = tuple(variation(text, drawn=sobol is not None) for text in ranges)
    changes.check_ranges(variations)
    sample = EvenGrid(variations) if sobol is None else Sobol(variations, sobol, loaded.seed)
    return Study(loaded.values, sample, duration)


def _print_summary(study: 'Study', swept: 'Swept') -> None:
    from collections import Counter

    import numpy as np

    from ..study.point_figures import MOTIONS, Motion

    columns = swept.columns
    counts = Counter(MOTIONS[Motion(int(motion))] for motion in columns['motion'])
    motions = ', '.join(f'{count} {word}' for word, count in counts.most_common())
    named = np.isin(columns['motion'], (Motion.UNDECIDED, Motion.SWINGS_ON))
    unsettled = int(((columns['settled'] == 0.0) & ~named).sum())
    print(f'{study.scene.name}: {study.count} points, {swept.ran} of them run now: {motions}'
          + (f'; {unsettled} had not settled' if unsettled else ''))
    print_failed(study, columns)
