# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip close-loop`: a controller of the user in a loop with the axis of a scene."""

import click

from . import completion
from .arguments import SceneChanges, scene_changes, verb
from .files import FOLDER, PICTURE, STDOUT, TEXT, check_new_folder, say_written, show, whole, write_text


@verb(short_help='Let a controller of yours drive an axis.')
@click.argument('controller', metavar='FILE.py:NAME')
@click.option('--scene', required=True, metavar='SCENE', shell_complete=completion.complete_scenes,
              help='The axis and its rig: the name of a shipped scene or a file.')
@click.option('--duration', type=float, required=True, metavar='S', help='Simulated time, s.')
@click.option('--rate', type=float, metavar='HZ', help='How often it is asked: time.rate, or a whole part of it '
                                                       '[default: after each step].')
@click.option('--setpoint', metavar='FILE.csv', help='Where the slider should be: columns time and position.')
@click.option('--gain', 'gains', multiple=True, metavar='NAME=VALUE', help='Make the class NAME with this argument.')
@click.option('--limits', metavar='FILE.yaml', help='Check the run against these limits (docs/check.md).')
@click.option('--out', type=FOLDER, metavar='FOLDER', help='Record the run as a ROS 2 bag.')
@click.option('--plot', type=PICTURE, metavar='FILE.png', help='Draw the run (.png, .pdf or .svg).')
@click.option('--junit', type=TEXT, metavar='FILE.xml', help='With --limits: JUnit XML ("-": to standard output).')
@click.option('--json', 'json_file', type=TEXT, metavar='FILE.json',
              help='Write the receipt, and with --limits what was measured ("-": to standard output).')
@scene_changes('Change a parameter of the scene.')
def close_loop(controller: str, scene: str, changes: SceneChanges, duration: float, rate: float | None,
               setpoint: str | None, gains: tuple[str, ...], limits: str | None, out: str | None, plot: str | None,
               junit: str | None, json_file: str | None) -> None:
    """Let a controller drive the axis of a scene: NAME in FILE.py, a class or a function (docs/closed_loop.md).

    It is called as controller(t, measured), and returns the velocity of the drive.  Exit code 3 when one of --limits is
    not kept.
    """
    if junit is not None and limits is None:
        raise click.UsageError('--junit is of no use alone: give --limits FILE.yaml too.')
    from ..check.limits import load_limits
    from ..check.report import check_report, checks_as_values, complaint, junit_text
    from ..closed_loop import close_loop as closed_loop
    from ..controllers.own_controller import load_controller, parse_gain
    from ..core.errors import VerdictError
    from ..report.values import json_text
    from ..runs.report import run_report
    from .progress import progress_bar

    loaded = None if limits is None else load_limits(limits)
    own = load_controller(controller, dict(map(parse_gain, gains)))
    with progress_bar('simulating') as progress:
        run = closed_loop(own, changes.load(scene), duration, rate, setpoint, progress)
    checked = None if loaded is None else run.check(loaded)
    if out is not None:
        check_new_folder('--out', out)    # nobody has made it meanwhile
        run.save(out)
    if plot is not None:
        with whole(plot) as temporary:
            run.plot(temporary)
    if STDOUT not in (junit, json_file):
        show(run_report(run))
        show(check_report(checked) if checked else [])
    if json_file is not None:
        found = checks_as_values([checked]) if checked else {}
        write_text(json_file, [json_text({'receipt': run.receipt, **found}, 2)])
    if junit is not None and checked:
        write_text(junit, [junit_text([checked])])
    say_written(out, plot, json_file, junit)
    if checked and limits and (failed := complaint(checked, limits)):
        raise VerdictError(failed)
