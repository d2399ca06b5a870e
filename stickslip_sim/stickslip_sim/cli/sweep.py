# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip sweep`: a scene at many values of its parameters, and the cycle figures of each point."""


import click

from . import completion
from .arguments import Members, SceneChanges, command_line, scene_argument, study_options, verb
from .files import progress_bar, say_written, show


@verb(short_help='Run a scene over ranges of its parameters.')
@scene_argument
@click.option('--over', 'ranges', multiple=True, required=True, metavar='A.B=LOW:HIGH:N[:log]',
              shell_complete=completion.complete_parameters,
              help='Vary a parameter, or an element of a list: A.B[1]. Repeatable: runs every combination.')
@click.option('--sobol', type=int, metavar='N', help='Draw N Sobol points instead, with --over A.B=LOW:HIGH[:log].')
@study_options
def sweep(scene: str, ranges: tuple[str, ...], sobol: int | None, out: str, duration: float | None,
          members: Members, resume: bool, changes: SceneChanges) -> None:
    """Run SCENE over ranges of its parameters and write the motion, amplitude, period and more of each run.

    Ctrl-C keeps the finished points.  Plot the result with `stickslip map FOLDER`.
    """
    from ..study import EvenGrid, Sobol, Study, variation
    from ..study.folder import Folder
    from ..study.report import sweep_report
    from ..study.sweep import carry_out

    loaded = changes.load(scene)
    variations = tuple(variation(text, drawn=sobol is not None) for text in ranges)
    changes.check_ranges(variations)
    sample = EvenGrid(variations) if sobol is None else Sobol(variations, sobol, loaded.seed)
    study = Study(loaded.values, sample, duration)
    folder = Folder(out)
    with progress_bar('sweeping') as progress:
        swept = carry_out(study, folder, members, resume, command_line(), progress)
    show(sweep_report(study, swept))
    say_written(str(folder.table))
