# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip design`: the experiment that would narrow chosen parameters of a scene most."""

import math
from pathlib import Path
from typing import Any

import click

from . import completion
from .arguments import SceneChanges, scene_argument, scene_changes, verb
from .files import FOLDER, new_folder, progress_bar, say_written, show


@verb(short_help='Propose the feed that narrows parameters most.')
@scene_argument
@click.option('--for', 'parameters', required=True, metavar='A.B,...', shell_complete=completion.complete_parameters,
              help='Parameters to narrow, such as axis.mass,friction.static.limit.')
@click.option('--duration', type=float, default=10.0, show_default=True, metavar='SECONDS',
              help='Duration of the run.')
@click.option('--speeds', metavar='LOW:HIGH', help="Range of feeds in m/s [default: 1/10 to 10 times the scene's].")
@click.option('--travel', type=float, default=math.inf, metavar='METRES',
              help='Longest travel of the drive.')
@click.option('--rate', type=float, default=1000.0, show_default=True, metavar='HZ', help='Sampling rate.')
@click.option('--resolution', type=float, default=1e-6, show_default=True, metavar='METRES',
              help='Resolution of the position.')
@click.option('--noise', type=float, default=0.0, show_default=True, metavar='METRES',
              help='RMS noise of the position.')
@click.option('--force-noise', type=float, metavar='NEWTONS',
              help='Measure the drive force too, with this RMS noise.')
@click.option('--known', type=float, default=0.3, show_default=True, metavar='SHARE',
              help='Prior relative standard deviation of each parameter.')
@click.option('--scatter', type=float, default=0.01, show_default=True, metavar='SHARE',
              help='Relative scatter of each parameter from slip to slip.')
@click.option('--criterion', type=click.Choice(('D', 'A')), default='D', show_default=True,
              help='Minimise the volume of the confidence region (D) or the sum of variances (A).')
@click.option('--out', type=FOLDER, metavar='FOLDER',
              help='New folder for the scene that runs it and a one-page report.')
@scene_changes('Change a parameter of the scene.')
def design(scene: str, parameters: str, speeds: str | None, out: str | None, changes: SceneChanges, **wishes: Any
           ) -> None:
    """Propose the feed whose run narrows the parameters of SCENE most: constant, steps, ramps, start-stop, sine, ...

    See docs/sensitivities.md for the ranking.
    """
    from ..sensitivity import experiments
    from ..sensitivity.report import EXPERIMENT_PAGE, EXPERIMENT_SCENE, design_report, write_design

    loaded = changes.load(scene)
    between = None if speeds is None else experiments.speeds_of(speeds)
    with progress_bar('designing') as progress:
        found = experiments.design(loaded, [name.strip() for name in parameters.split(',')], speeds=between,
                                   progress=progress, **wishes)
    show(design_report(found))
    if out is not None:
        with new_folder('--out', out) as folder:
            write_design(found, folder)
        say_written(str(Path(out) / EXPERIMENT_SCENE), str(Path(out) / EXPERIMENT_PAGE))
