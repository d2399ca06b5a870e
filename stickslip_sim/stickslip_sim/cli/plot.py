# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip plot`: the picture of a run, recorded or simulated."""

from typing import TYPE_CHECKING

import click

from . import completion
from .arguments import SceneChanges, check_sources, is_recorded, recorded_run, scene_changes, simulated, verb
from .files import PICTURE, check_picture, say_written, whole

if TYPE_CHECKING:
    from ..runs import Run


@verb(short_help='Draw any run: motion, stretch, forces, modes, faults.')
@click.argument('source', metavar='RUN_OR_SCENE', shell_complete=completion.complete_scenes)
@click.option('--window', metavar='A:B', help='Show this part beside the whole, s; A may be first_command, '
                                              '+B counts from A [default: what was commanded, last cycles of a long '
                                              'run].')
@click.option('--out', type=PICTURE, metavar='FILE.png|pdf|svg', help='Write the picture there; the ending decides the '
                                                                  'format [default: NAME.png].')
@click.option('--duration', type=float, metavar='S', help='Time to simulate a scene, s.')
@scene_changes('Change a parameter of a scene.')
def plot(source: str, window: str | None, out: str | None, duration: float | None, changes: SceneChanges) -> None:
    """Draw RUN_OR_SCENE - a run folder, or a scene to simulate - over time.

    Positions of slider and drive, stretch of the spring between them, velocity and command, forces, modes; faults and
    commands that were refused or limited; of a node's run late steps, and gaps between commands.
    """
    from ..runs.report import Window, file_stem
    from .progress import progress_bar

    asked = None if window is None else Window.of(window)
    run = _run(source, duration, changes)
    shown = None if asked is None else asked.in_run(run)
    out = f'{file_stem(run)}.png' if out is None else out
    check_picture('--out', out)
    with progress_bar('drawing'), whole(out) as temporary:
        run.plot(temporary, shown)
    say_written(out)


def _run(source: str, duration: float | None, changes: SceneChanges) -> 'Run':
    check_sources([source], duration, changes)
    if not is_recorded(source) and duration is not None:    # a scene has one
        return simulated(source, duration, changes)
    run = recorded_run(source)
    for note in run.notes:
        print(f'note: {note}')
    return run
