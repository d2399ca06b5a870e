# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip close-loop`: a controller of the user in a loop with the axis of a scene, once or at many points."""

from contextlib import nullcontext
from pathlib import Path
from typing import Any

import click

from . import completion
from .arguments import Members, SceneChanges, command_line, controller_options, scene_changes, verb, worker_options
from .files import FOLDER, PICTURE, STDOUT, TEXT, draw, progress_bar, say_written, show, write_json, write_text


@verb(short_help='Drive an axis with your own controller.')
@controller_options('Argument of the class NAME; a range LOW:HIGH[:N][:log] varies it.')
@click.option('--duration', type=float, required=True, metavar='SECONDS', help='Simulated time.')
@click.option('--setpoint', metavar='FILE.csv', help='Setpoint of the slider: columns time and position.')
@click.option('--over', 'ranges', multiple=True, metavar='A.B=LOW:HIGH[:N][:log]',
              shell_complete=completion.complete_parameters,
              help='Vary a parameter of the axis or its rig; runs every combination of N values.')
@click.option('--samples', type=int, metavar='N', help='Draw N Sobol points instead; omit N in the ranges.')
@click.option('--with', 'known', metavar='FILE.yaml', help='Also draw parameters from the distributions in a file.')
@click.option('--seed', type=int, metavar='SEED', help='Seed of the sample [default: that of the file or the scene].')
@click.option('--vectorized', is_flag=True, help='Call the controller with arrays, one entry per axis.')
@click.option('--limits', metavar='FILE.yaml', help='Check the run against these limits (docs/check.md).')
@click.option('--out', type=FOLDER, metavar='FOLDER', help='Record the run as a ROS 2 bag.')
@click.option('--plot', type=PICTURE, metavar='FILE.png', help='Plot the run (.png, .pdf or .svg).')
@click.option('--junit', type=TEXT, metavar='FILE.xml',
              help='With --limits: write JUnit XML ("-" for standard output).')
@click.option('--json', 'json_file', type=TEXT, metavar='FILE.json',
              help='Write the receipt, with --limits also the measurements ("-" for standard output).')
@worker_options
@scene_changes('Change a parameter of the scene.')
def close_loop(gains: tuple[str, ...], out: str | None, plot: str | None, junit: str | None, json_file: str | None,
               **given: Any) -> None:
    """Drive the axis of a scene with NAME in FILE.py, a controller class or function (docs/closed_loop.md).

    It is called as controller(t, measured) and returns the drive velocity.  The exit code is 3 if one of --limits
    fails.

    With --over, --with or a range of --gain, many points are run.  FOLDER receives their table, the worst run of each
    limit as a bag, and a map; Ctrl-C keeps the finished points.
    """
    if junit is not None and given['limits'] is None:
        raise click.UsageError('--junit needs --limits FILE.yaml.')
    from ..closed_loop.many import is_range
    from ..core.errors import VerdictError

    is_many = given['ranges'] or given['known'] or any(is_range(gain.partition('=')[2]) for gain in gains)
    if is_many and (out is None or junit is not None):
        raise click.UsageError('Many points need --out FOLDER and do not take --junit.')
    drawing, report, values, written, complaint = (
        _many(gains, out, **given) if is_many and out is not None else _once(gains, out, junit, **given))
    draw(plot, drawing)
    if STDOUT not in (junit, json_file):
        show(report)
    write_json(json_file, values)
    say_written(written, plot, json_file, junit)
    if complaint:
        raise VerdictError(complaint)


def _once(gains: tuple[str, ...], out: str | None, junit: str | None, members: Members, controller: str, scene: str,
          changes: SceneChanges, duration: float, rate: float | None, setpoint: str | None, limits: str | None,
          **of_many: object) -> tuple[Any, ...]:
    """Run one loop, record it, and check it; return how it is drawn, report, values, folder, and what it misses."""
    of_many['workers'] = not isinstance(members, nullcontext)
    if given := [name for name, value in of_many.items() if value not in (None, False, ())]:
        raise click.UsageError(f'--{given[0]} needs --over, --with or a range of --gain.')
    from ..check.limits import load_limits
    from ..check.report import check_report, checks_as_values, complaint, junit_text
    from ..closed_loop import close_loop as closed_loop
    from ..controllers.own_controller import load_controller, parse_gain
    from ..runs.report import run_report

    loaded = None if limits is None else load_limits(limits)
    own = load_controller(controller, dict(map(parse_gain, gains)))
    with progress_bar('simulating') as progress:
        run = closed_loop(own, changes.load(scene), duration, rate, setpoint, progress)
    run.receipt['controller']['command'] = command_line(
        'close-loop', controller, scene=[scene], duration=[duration], rate=[rate], setpoint=[setpoint], gain=gains,
        set=changes.overrides, meant=changes.meant)
    checks = [] if loaded is None else [run.check(loaded)]
    if out is not None:
        run.save(out)
    if junit is not None:
        write_text(junit, [junit_text(checks)])
    return (run.plot, [*run_report(run), *(part for one in checks for part in check_report(one))],
            {'receipt': run.receipt, **(checks_as_values(checks) if checks else {})}, out,
            complaint(checks[0], limits) if checks and limits else '')


def _many(gains: tuple[str, ...], out: str, members: Members, resume: bool, scene: str, changes: SceneChanges,
          ranges: tuple[str, ...], limits: str | None, **of_study: Any) -> tuple[Any, ...]:
    """Run many points into a folder; return the same of them."""
    from ..closed_loop.many import RESULT, arguments_of, loop_study, ranges_of, run_loops
    from ..closed_loop.report import loops_report

    study = loop_study(scene=changes.load(scene), over=ranges_of(ranges), limits=limits, gains=arguments_of(gains),
                       **of_study)
    changes.check_ranges(one for one in study.sample.variations if not one.name.startswith('gain.'))
    with progress_bar('simulating') as progress:
        found = run_loops(study, out, members, resume, command_line(), progress)
    failed = study.count - found.pass_rate.passed if limits else 0
    return (found.plot, loops_report(found), found.values(), str(Path(out) / RESULT),
            f'{failed} of {study.count} points do not pass {limits}' if failed else '')
