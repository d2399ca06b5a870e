# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip plot`: the picture of a run, recorded or simulated."""

import click

from .arguments import SceneChanges, check_sources, run_of_source, scene_changes, scene_duration, sources_argument, verb
from .files import PICTURE, check_picture, progress_bar, say_written, whole


@verb(short_help='Plot one run, or several on top of each other.')
@sources_argument
@click.option('--window', metavar='A:B', help='Time span to show, in s; A may be first_command, and +B counts from A '
                                              '[default: the commanded part or the last cycles; of several runs, '
                                              'where the setpoint moves].')
@click.option('--limits', metavar='FILE.yaml', help='Also plot limits and the error to their reference.')
@click.option('--out', type=PICTURE, metavar='FILE.png|pdf|svg', help='Picture to write; the ending selects the format '
                                                                  '[default: NAME.png, of several runs.png].')
@scene_duration
@scene_changes('Change a parameter of a scene.')
def plot(sources: tuple[str, ...], window: str | None, limits: str | None, out: str | None, duration: float | None,
         changes: SceneChanges) -> None:
    """Plot RUN_OR_SCENE (a run folder, or a scene to simulate) over time.

    The picture shows the positions of slider and drive, the spring stretch, velocity and command, forces and modes,
    with faults and refused or limited commands; for a run of the node also late steps and gaps between commands.

    Several runs, or --limits, are compared by speed, error and drive force.
    """
    from ..runs.report import Window, file_stem

    asked = None if window is None else Window.of(window)
    check_sources(sources, duration, changes)
    runs = {source: run_of_source(source, duration, changes) for source in sources}
    for run in runs.values():
        for note in run.notes if run.is_recorded else ():
            print(f'note: {note}')
    first = runs[sources[0]]
    shown = None if asked is None else asked.in_run(first)
    out = ('runs.png' if len(runs) > 1 else f'{file_stem(first)}.png') if out is None else out
    check_picture('--out', out)
    with progress_bar('drawing'), whole(out) as temporary:
        if len(runs) > 1 or limits is not None:
            from ..check.report import plot_runs  # half a second more

            plot_runs(runs, temporary, limits=limits, window=shown)
        else:
            first.plot(temporary, shown)
    say_written(out)
