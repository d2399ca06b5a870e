# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip close-loop`: a controller of the user in a loop with the axis of a scene, once or at many points."""

from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from . import arguments, completion
from .arguments import Members, SceneChanges, check_usage, command_line, scene_changes, verb
from .files import FOLDER, PICTURE, TEXT, draw, end_with, progress_bar, say_written, show, write_json, write_text

if TYPE_CHECKING:
    from ..closed_loop.report import LoopOutcome


@verb(short_help='Drive an axis with your own controller.')
@arguments.controller_options('Argument of the class NAME; a range LOW:HIGH[:N][:log] varies it.')
@click.option('--duration', type=float, required=True, metavar='SECONDS', help='Simulated time.')
@click.option('--setpoint', metavar='FILE.csv', help='Setpoint of the slider: columns time and position.')
@click.option('--over', 'ranges', multiple=True, metavar='A.B=LOW:HIGH[:N][:log]',
              shell_complete=completion.complete_parameters,
              help='Vary a parameter of the axis or its rig; runs every combination of N values.')
@click.option('--samples', type=int, metavar='N', help='Draw N Sobol points instead; omit N in the ranges.')
@click.option('--with', 'known', metavar='FILE.yaml', help='Also draw parameters from the distributions in a file.')
@click.option('--seed', type=int, metavar='SEED',
              help="Seed of the sample; noise keeps the scene's [default: that of the file or the scene].")
@click.option('--vectorized', is_flag=True, help='Call the controller with arrays, one entry per axis.')
@click.option('--limits', metavar='FILE.yaml', help='Check the run against these limits (docs/check.md).')
@click.option('--out', type=FOLDER, metavar='FOLDER', help='Record the run as a ROS 2 bag.')
@click.option('--plot', type=PICTURE, metavar='FILE.png', help='Plot the run (.png, .pdf or .svg).')
@click.option('--junit', type=TEXT, metavar='FILE.xml',
              help='With --limits: write JUnit XML ("-" for standard output).')
@click.option('--json', 'json_file', type=TEXT, metavar='FILE.json',
              help='Write the receipt, with --limits also the measurements ("-" for standard output).')
@arguments.worker_options
@scene_changes('Change a parameter of the scene.')
def close_loop(gains: tuple[str, ...], out: str | None, plot: str | None, junit: str | None, json_file: str | None,
               **given: Any) -> None:
    """Drive the axis of a scene with NAME in FILE.py, a controller class or function (docs/closed_loop.md).

    It is called as controller(t, measured) and returns the drive velocity.  The exit code is 3 if one of --limits
    fails.

    With --over, --with or a range of --gain, many points are run.  FOLDER receives their table, the worst run of each
    limit as a bag, and a map; Ctrl-C keeps the finished points.
    """
    check_usage((junit and given['limits'] is None, '--junit needs --limits FILE.yaml.'))
    from ..closed_loop.many import is_range

    is_many = given['ranges'] or given['known'] or any(is_range(gain.partition('=')[2]) for gain in gains)
    check_usage((is_many and (out is None or junit), 'Many points need --out FOLDER and do not take --junit.'))
    found, written = _many(gains, out, **given) if is_many and out is not None else _once(gains, out, **given)
    write_text(junit, [found.junit])
    draw(plot, found.draw)
    show(found.report, junit, json_file)
    write_json(json_file, found.values)
    say_written(written, plot, json_file, junit)
    end_with(found.complaint)


def _once(gains: tuple[str, ...], out: str | None, members: Members, controller: str, scene: str,
          changes: SceneChanges, duration: float, rate: float | None, setpoint: str | None, limits: str | None,
          **of_many: object) -> 'tuple[LoopOutcome, str | None]':
    """Run one loop, record it, and check it; return what it came to, and where it was recorded."""
    of_many['workers'] = not isinstance(members, nullcontext)
    check_usage(*((value not in (None, False, ()), f'--{name} needs --over, --with or a range of --gain.')
                  for name, value in of_many.items()))
    from ..check.limits import load_limits
    from ..closed_loop import close_loop as closed_loop
    from ..closed_loop.report import outcome_of_run
    from ..controllers.own_controller import load_controller, parse_gain

    loaded = None if limits is None else load_limits(limits)
    own = load_controller(controller, dict(map(parse_gain, gains)))
    with progress_bar('simulating') as progress:
        run = closed_loop(own, changes.load(scene), duration, rate, setpoint, progress)
    run.receipt['controller']['command'] = command_line(
        'close-loop', controller, scene=[scene], duration=[duration], rate=[rate], setpoint=[setpoint], gain=gains,
        set=changes.overrides, meant=changes.meant)
    found = outcome_of_run(run, loaded, str(limits))
    if out is not None:
        run.save(out)
    return found, out


def _many(gains: tuple[str, ...], out: str, members: Members, resume: bool, scene: str, changes: SceneChanges,
          ranges: tuple[str, ...], limits: str | None, **of_study: Any) -> 'tuple[LoopOutcome, str | None]':
    """Run many points into a folder; return the same of them."""
    from ..closed_loop.many import RESULT, arguments_of, loop_study, ranges_of, run_loops
    from ..closed_loop.report import outcome_of_loops

    study = loop_study(scene=changes.load(scene), over=ranges_of(ranges), limits=limits, gains=arguments_of(gains),
                       **of_study)
    changes.check_ranges(one for one in study.sample.variations if not one.name.startswith('gain.'))
    with progress_bar('simulating') as progress:
        return outcome_of_loops(run_loops(study, out, members, resume, command_line(), progress), limits), str(
            Path(out) / RESULT)
