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


@verb(short_help='Propose the feed that would narrow parameters most.')
@scene_argument
@click.option('--for', 'parameters', required=True, metavar='A.B,...', shell_complete=completion.complete_parameters,
              help='The parameters to narrow, as friction.static.time_constant,friction.static.limit.')
@click.option('--duration', type=float, default=10.0, show_default=True, metavar='S', help='Of the run, s.')
@click.option('--speeds', metavar='LOW:HIGH', help="Of the feeds, m/s [default: 1/10 to 10 times the scene's].")
@click.option('--travel', type=float, default=math.inf, metavar='M', help='How far the drive may go, m.')
@click.option('--rate', type=float, default=1000.0, show_default=True, metavar='HZ', help='Readings a second.')
@click.option('--resolution', type=float, default=1e-6, show_default=True, metavar='M', help='Of the position, m.')
@click.option('--noise', type=float, default=0.0, show_default=True, metavar='M', help='Of the position, m rms.')
@click.option('--force-noise', type=float, metavar='N', help='The drive force is measured, with this noise, N rms.')
@click.option('--known', type=float, default=0.3, show_default=True, metavar='SHARE',
              help='Standard deviation of each parameter before, a share.')
@click.option('--scatter', type=float, default=0.01, show_default=True, metavar='SHARE',
              help='How far each parameter scatters from slip to slip, a share.')
@click.option('--criterion', type=click.Choice(('D', 'A')), default='D', show_default=True,
              help='What is least: the volume that is left to the parameters, or the sum of their variances.')
@click.option('--out', type=FOLDER, metavar='FOLDER',
              help='New folder for the scene that runs it, and one page.')
@scene_changes('Change a parameter of the scene.')
def design(scene: str, parameters: str, speeds: str | None, out: str | None, changes: SceneChanges, **wishes: Any
           ) -> None:
    """Propose the feed whose run would narrow parameters of a scene most: constant, steps, ramps, start-stop, sine, ...

    docs/sensitivities.md says how they are ranked.
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
