# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip export-fmu`: a scene as an FMU."""

import click

from . import completion
from .arguments import SceneChanges, scene_changes, verb
from .files import FILE, say_written, whole


@verb(short_help='Write a scene as an FMU for co-simulation, FMI 3.0 or 2.0.')
@click.argument('scene', metavar='SCENE', shell_complete=completion.complete_scenes)
@click.option('--out', type=FILE, required=True, metavar='FILE.fmu', help='Write the FMU.')
@click.option('--fmi', 'version', type=click.Choice(['3', '2']), default='3', help='The version of FMI [default: 3].')
@scene_changes('Change a parameter of the scene.')
def export_fmu(scene: str, out: str, version: str, changes: SceneChanges) -> None:
    """Write SCENE as an FMU for co-simulation, with the library of this platform and its sources."""
    from ..fmu.fmu_file import fmu_bytes

    content = fmu_bytes(changes.load(scene), int(version))
    with whole(out) as temporary:
        temporary.write_bytes(content)
    say_written(out)
