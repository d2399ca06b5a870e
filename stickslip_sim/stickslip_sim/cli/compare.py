# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip compare`: the paper's figures and statements, of runs or scenes; or the runs of controllers."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from . import completion
from .arguments import SceneChanges, check_each_once, check_usage, recorded_run, scene_changes, sources_argument, verb
from .files import FOLDER, end_with, new_folder, progress_bar, say_written, show

if TYPE_CHECKING:
    from ..report.model import Part
    from ..runs import Run

_MOST = 8        # runs, rows of a picture


@verb(short_help="Draw the paper's figures for a run and check its statements.")
@sources_argument
@click.option('--out', type=FOLDER, required=True, metavar='FOLDER', help='New folder for the report and the pictures.')
@click.option('--controllers', is_flag=True,
              help='Compare controllers, FILE.py:NAME, or recorded runs of controllers side by side instead.')
@click.option('--scene', metavar='SCENE', shell_complete=completion.complete_scenes,
              help='For FILE.py:NAME: axis and its rig.')
@click.option('--setpoint', metavar='FILE.csv', help='For FILE.py:NAME: columns time and position.')
@click.option('--rate', type=float, metavar='HZ', help='For FILE.py:NAME: controller rate [default: time.rate].')
@click.option('--limits', metavar='FILE.yaml', help='With --controllers: also check these limits (docs/check.md).')
@click.option('--window', metavar='A:B',
              help='With --controllers: this time span in s [default: where the setpoint moves].')
@click.option('--duration', type=float, metavar='SECONDS',
              help='Simulated time of a scene [default: 10 s, or more for 20 cycles].')
@scene_changes('Change a parameter of every scene.')
def compare(sources: tuple[str, ...], out: str, controllers: bool, limits: str | None, window: str | None,
            duration: float | None, changes: SceneChanges, **of_loop: str | float | None) -> None:
    """Draw runs like the paper's figures 4, 6, 7 and 8, and check which of its statements hold for each.

    Give run folders, or scenes to simulate.  The exit code is 3 if a statement that applies to a run does not hold.
    With a measured run (see import), the other runs are drawn over it and compared cycle by cycle; scenes start at its
    initial state and are driven by its measured drive and force.

    With --controllers, each run has a column with speed, error, drive force and its control figures.  A controller,
    FILE.py:NAME, drives --scene for --duration, like close-loop.  The exit code is 3 if one of --limits fails.
    """
    own = [source for source in sources if controllers and source.rpartition(':')[0].endswith('.py')]
    _check([source for source in sources if source not in own], len(sources), own, duration, changes, of_loop)
    check_usage((not controllers and (limits or window), '--limits and --window need --controllers.'))
    if controllers:
        loop = {**of_loop, 'duration': duration, 'changes': changes}
        report, complaint = _side_by_side(sources, own, limits, window, out, loop)
    else:
        from ..compare.report import write_comparison
        from ..inputs.sources import is_recorded

        with progress_bar('comparing') as progress:
            given = [recorded_run(source) if is_recorded(source) else changes.load(source) for source in sources]
            with new_folder('--out', out) as folder:
                report, failed = write_comparison(given, sources, duration, folder, progress)
        complaint = f'{len(failed)} of the statements that apply do not hold ({"; ".join(failed)})' if failed else ''
    show(report)
    say_written(str(Path(out) / 'report.html'))
    end_with(complaint)


def _side_by_side(sources: tuple[str, ...], own: list[str], limits: str | None, window: str | None, out: str,
                  of_loop: dict[str, Any]) -> 'tuple[list[Part], str]':
    """Write the report of runs of controllers; return it for people, and which limits are not kept."""
    from ..compare.report import write_controllers
    from ..runs.report import Window

    check_each_once(sources)
    loops = _closed(own, **of_loop) if own else {}
    runs = {source: loops.get(source) or recorded_run(source) for source in sources}
    shown = None if window is None else Window.of(window).in_run(runs[sources[0]])
    with progress_bar('comparing'), new_folder('--out', out) as folder:
        return write_controllers(runs, limits, shown, folder)


def _closed(places: list[str], scene: str, changes: SceneChanges, **of_loop: Any) -> 'dict[str, Run]':
    """Return the runs of controllers at the axis of a scene."""
    from ..closed_loop import close_loop
    from ..controllers.own_controller import load_controller

    own, loaded = {place: load_controller(place) for place in places}, changes.load(scene)
    with progress_bar('simulating') as progress:
        return {place: close_loop(one, loaded, progress=progress, **of_loop) for place, one in own.items()}


def _check(runs: list[str], count: int, own: list[str], duration: float | None, changes: SceneChanges,
           of_loop: dict[str, str | float | None]) -> None:
    """Raise before the work begins when there are too many runs or an option has no effect."""
    from ..core.errors import InputError
    from ..inputs.sources import is_recorded

    if count > _MOST:
        raise InputError('RUN_OR_SCENE', f'{count} runs', f'at most {_MOST} at once', 'compare fewer')
    are_recorded = all(map(is_recorded, runs)) and not own
    check_usage(
        *((are_recorded and given is not None, f'{option} applies to scenes, but these are all recorded runs.')
          for option, given in (('--duration', duration), ('--set', changes.overrides or None))),
        *((not own and given is not None, f'--{option} needs --controllers FILE.py:NAME.')
          for option, given in of_loop.items()),
        (own and None in (of_loop['scene'], duration), 'A controller needs --scene SCENE and --duration SECONDS.'))
