# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip export-fmu`: a scene as an FMU."""

import click

from .arguments import SceneChanges, scene_argument, scene_changes, verb
from .files import FILE, say_written, whole


@verb(short_help='Export a scene as an FMU for co-simulation.')
@scene_argument
@click.option('--out', type=FILE, required=True, metavar='FILE.fmu', help='FMU to write.')
@click.option('--fmi', 'version', type=click.Choice(['3', '2']), default='3', help='FMI version [default: 3].')
@scene_changes('Change a parameter of the scene.')
def export_fmu(scene: str, out: str, version: str, changes: SceneChanges) -> None:
    """Export SCENE as an FMU for co-simulation (FMI 3.0 or 2.0), with its sources and the library for this platform."""
    from ..fmu.fmu_file import fmu_bytes

    content = fmu_bytes(changes.load(scene), int(version))
    with whole(out) as temporary:
        temporary.write_bytes(content)
    say_written(out)
