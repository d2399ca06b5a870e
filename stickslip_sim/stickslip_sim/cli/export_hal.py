# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip export-hal`: the axis as a component of LinuxCNC."""

import click

from .arguments import SceneChanges, scene_argument, scene_changes, verb
from .files import FOLDER, new_folder, say_written


@verb(short_help='Export the axis as a LinuxCNC component.')
@scene_argument
@click.option('--out', type=FOLDER, required=True, metavar='DIR', help='New folder for the component.')
@scene_changes('Change a parameter of the scene.')
def export_hal(scene: str, out: str, changes: SceneChanges) -> None:
    """Export the axis of SCENE as stickslip.comp, for LinuxCNC's halcompile (docs/linuxcnc.md).

    The pin velocity moves the drive and replaces the scene's drive profile.
    """
    from ..plain_c.hal_files import hal_files

    texts = hal_files(changes.load(scene))
    with new_folder('--out', out) as folder:
        for name, text in texts.items():
            (folder / name).write_text(text, encoding='utf-8')
    say_written(out)
