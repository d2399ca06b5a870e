# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip export-c`: the engine as plain C."""

from pathlib import Path

import click

from . import completion
from .arguments import SceneChanges, scene_changes, verb
from .files import say_written


@verb(short_help='Export the engine as C source, with a header and an example.')
@click.argument('folder', metavar='DIR', type=click.Path())
@click.option('--scene', default='paper_fig8', metavar='SCENE', shell_complete=completion.complete_scenes,
              help='Scene of the example [default: paper_fig8].')
@click.option('--duration', type=float, default=10.0, metavar='SECONDS',
              help='Simulated time of the example [default: 10].')
@scene_changes('Change a parameter of the scene.')
def export_c(folder: str, scene: str, duration: float, changes: SceneChanges) -> None:
    """Write stickslip_axis.c, stickslip_axis.h and example.c into DIR, creating it if necessary."""
    from ..core.errors import InputError
    from ..plain_c.c_files import NAMES, written

    if not 0.0 < duration < float('inf'):
        raise InputError('--duration', duration, 'finite and > 0 s', 'give the seconds to simulate')
    place = Path(folder)
    if place.exists() and not place.is_dir():
        raise InputError('DIR', folder, 'a folder', 'this is a file: name a folder')
    for name in NAMES:
        if (place / name).exists():
            raise InputError('DIR', folder, f'a folder without {name}', 'nothing is overwritten: name another folder')
    loaded = changes.load(scene)
    place.mkdir(parents=True, exist_ok=True)
    say_written(*map(str, written(place, loaded, duration)))
