# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip plot`: the picture of a run, recorded or simulated."""

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click

from . import completion
from .files import check_picture, say_written, whole
from .run_or_scene import is_recorded, recorded_run
from .scene_changes import SceneChanges, scene_changes

if TYPE_CHECKING:
    from ..runs import Run


@click.command(short_help='Draw any run: motion, error, forces, modes, faults.')
@click.argument('source', metavar='RUN_OR_SCENE', shell_complete=completion.complete_scenes)
@click.option('--window', metavar='A:B', help='Show this part beside the whole, s [default: the last cycles of a run '
                                              'that is long].')
@click.option('--out', metavar='FILE.png|pdf|svg', help='Write the picture there; the ending decides the '
                                                                  'format [default: NAME.png].')
@click.option('--duration', type=float, metavar='S', help='Time to simulate a scene, s.')
@scene_changes('Change a parameter of a scene.')
def plot(source: str, window: str | None, out: str | None, duration: float | None, changes: SceneChanges) -> None:
    """Draw RUN_OR_SCENE - a run folder, or a scene to simulate - over time.

    Setpoint, position, error, velocity and command, forces, modes; faults and commands that were refused or limited.
    """
    if out is not None:
        check_picture('--out', out)
    shown = None if window is None else _times(window)
    run = _run(source, duration, changes)
    out = _picture_of(run) if out is None else out
    check_picture('--out', out)
    from .progress import progress_bar

    with progress_bar('drawing'), whole(out) as temporary:
        run.plot(temporary, shown)
    say_written(out)


def _times(text: str) -> tuple[float, float]:
    from ..core.errors import InputError

    try:
        begin, end = map(float, text.split(':'))
    except ValueError:
        begin = end = math.nan
    if not begin < end:
        raise InputError('--window', text, 'A:B, two times in s, the first before the second', 'for example 2.5:4')
    return begin, end


def _run(source: str, duration: float | None, changes: SceneChanges) -> 'Run':
    if is_recorded(source):
        if duration is not None or changes.overrides:
            raise click.UsageError('--duration and --set are for a scene; a run stays as it was recorded.')
        run = recorded_run(source)
        for note in run.notes:
            print(f'note: {note}')
        return run
    if duration is None:
        raise click.UsageError('--duration S is needed to simulate a scene.')
    return _simulated(source, duration, changes)


def _simulated(source: str, duration: float, changes: SceneChanges) -> 'Run':
    from ..runs import simulate_events
    from ..runs.simulated import check_run_times
    from .progress import progress_bar

    check_run_times(duration, None)
    scene = changes.load(source)
    with progress_bar('simulating') as progress:
        return simulate_events(scene, duration, progress)


def _picture_of(run: 'Run') -> str:
    """Return the name of the picture where none is given."""
    from ..scene.text import file_name

    return f'{file_name(Path(run.name).stem if run.is_recorded else run.name)}.png'
