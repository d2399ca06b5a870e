# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip plot`: the picture of a run, recorded or simulated."""

from typing import TYPE_CHECKING

import click

from . import completion
from .files import check_picture, say_written, whole
from .run_or_scene import file_stem, is_recorded, recorded_run
from .scene_changes import SceneChanges, scene_changes

if TYPE_CHECKING:
    from ..runs import Run

_FIRST_COMMAND = 'first_command'


@click.command(short_help='Draw any run: motion, stretch, forces, modes, faults.')
@click.argument('source', metavar='RUN_OR_SCENE', shell_complete=completion.complete_scenes)
@click.option('--window', metavar='A:B', help='Show this part beside the whole, s; A may be first_command, '
                                              '+B counts from A [default: what was commanded, last cycles of a long '
                                              'run].')
@click.option('--out', metavar='FILE.png|pdf|svg', help='Write the picture there; the ending decides the '
                                                                  'format [default: NAME.png].')
@click.option('--duration', type=float, metavar='S', help='Time to simulate a scene, s.')
@scene_changes('Change a parameter of a scene.')
def plot(source: str, window: str | None, out: str | None, duration: float | None, changes: SceneChanges) -> None:
    """Draw RUN_OR_SCENE - a run folder, or a scene to simulate - over time.

    Positions of slider and drive, stretch of the spring between them, velocity and command, forces, modes; faults and
    commands that were refused or limited; of a node's run late steps, and gaps between commands.
    """
    if out is not None:
        check_picture('--out', out)
    begin, end = (None, None) if window is None else _times(window)
    run = _run(source, duration, changes)
    shown = None if end is None else _window(run, str(window), begin, end)
    out = f'{file_stem(run)}.png' if out is None else out
    check_picture('--out', out)
    from .progress import progress_bar

    with progress_bar('drawing'), whole(out) as temporary:
        run.plot(temporary, shown)
    say_written(out)


def _times(text: str) -> tuple[float | None, float]:
    """Return from when (None: the first command) to when (then in s after that) a window is; raises InputError."""
    from ..core.errors import InputError

    first, _, last = text.partition(':')
    try:
        begin = None if first == _FIRST_COMMAND else float(first)
        end = float(last) + (begin or 0.0 if last.startswith('+') else 0.0)
        is_good = end > (0.0 if begin is None else begin) and (begin is not None or last.startswith('+'))
    except ValueError:
        is_good = False
    if not is_good:
        raise InputError('--window', text, f'A:B or A:+B, times in s, A before B; or {_FIRST_COMMAND}:+B',
                         'for example 2.5:4')
    return begin, end


def _window(run: 'Run', text: str, begin: float | None, end: float) -> tuple[float, float]:
    """Return a window in times of a run; raises InputError in one without the command that it begins with."""
    from ..core.errors import InputError
    from ..runs.picture import first_command

    if begin is not None:
        return begin, end
    first = first_command(run)
    if first is None:
        raise InputError('--window', text, 'A:B in a run without commands', 'give two times of the run, in s')
    return first, first + end


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
