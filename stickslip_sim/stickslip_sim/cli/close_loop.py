# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip close-loop`: a controller of the user in a loop with the axis of a scene, once or at many points."""

import shlex
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Any, NamedTuple

import click

from . import completion
from .arguments import Members, SceneChanges, controller_options, scene_changes, verb, worker_options
from .files import FOLDER, PICTURE, STDOUT, TEXT, check_new_folder, say_written, show, whole, write_text


@verb(short_help='Let a controller of yours drive an axis.')
@controller_options('Make the class NAME with this argument; a range LOW:HIGH[:N][:log] varies it.')
@click.option('--duration', type=float, required=True, metavar='S', help='Simulated time, s.')
@click.option('--setpoint', metavar='FILE.csv', help='Where the slider should be: columns time and position.')
@click.option('--over', 'ranges', multiple=True, metavar='A.B=LOW:HIGH[:N][:log]',
              shell_complete=completion.complete_parameters,
              help='Vary a parameter of the axis or its rig: every combination of N values.')
@click.option('--samples', type=int, metavar='N', help='Draw N points (Sobol) instead; then ranges without N.')
@click.option('--with', 'known', metavar='FILE.yaml', help='Draw parameters from the distributions of a file, too.')
@click.option('--seed', type=int, metavar='SEED', help='Of the sample [default: that of the file or the scene].')
@click.option('--vectorized', is_flag=True, help='The controller gets and answers arrays, one entry an axis.')
@click.option('--limits', metavar='FILE.yaml', help='Check the run against these limits (docs/check.md).')
@click.option('--out', type=FOLDER, metavar='FOLDER', help='Record the run as a ROS 2 bag.')
@click.option('--plot', type=PICTURE, metavar='FILE.png', help='Draw the run (.png, .pdf or .svg).')
@click.option('--junit', type=TEXT, metavar='FILE.xml', help='With --limits: JUnit XML ("-": to standard output).')
@click.option('--json', 'json_file', type=TEXT, metavar='FILE.json',
              help='Write the receipt, and with --limits what was measured ("-": to standard output).')
@worker_options
@scene_changes('Change a parameter of the scene.')
def close_loop(scene: str, changes: SceneChanges, gains: tuple[str, ...], out: str | None, plot: str | None,
               junit: str | None, json_file: str | None, members: Members, resume: bool, **given: Any) -> None:
    """Let a controller drive the axis of a scene: NAME in FILE.py, a class or a function (docs/closed_loop.md).

    It is called as controller(t, measured), and returns the velocity of the drive.  Exit code 3 when one of --limits is
    not kept.

    With --over, --with or a range of --gain it runs at many points.  FOLDER gets their table, the worst run of each
    limit as a bag, and a map; Ctrl-C keeps the finished points.
    """
    if junit is not None and given['limits'] is None:
        raise click.UsageError('--junit is of no use alone: give --limits FILE.yaml too.')
    from ..closed_loop.many import is_range
    from ..core.errors import VerdictError
    from ..report.values import json_text
    if given['ranges'] or given['known'] or any(is_range(gain.partition('=')[2]) for gain in gains):
        if out is None or junit is not None:
            raise click.UsageError('many points need --out FOLDER, and have no --junit.')
        found = _many(scene, changes, gains, out, members, resume, **given)
    else:
        found = _once(scene, changes, gains, out, junit, members, resume, **given)
    if plot is not None:
        with whole(plot) as temporary:
            found.of.plot(temporary)
    if STDOUT not in (junit, json_file):
        show(found.report)
    if json_file is not None:
        write_text(json_file, [json_text(found.values, 2)])
    say_written(found.written, plot, json_file, junit)
    if found.complaint:
        raise VerdictError(found.complaint)


class _Found(NamedTuple):
    """What can be drawn, its report and values; where it was written, and what is not as it should be."""

    of: Any
    report: Any
    values: dict[str, Any]
    written: str | None
    complaint: str


def _once(scene: str, changes: SceneChanges, gains: tuple[str, ...], out: str | None, junit: str | None,
          members: Members, resume: bool, controller: str, duration: float, rate: float | None, setpoint: str | None,
          limits: str | None, **of_many: object) -> _Found:
    """Run one loop, record it, and check it."""
    given = [name for name, value in {**of_many, 'resume': resume}.items() if value not in (None, False, ())]
    given += [] if isinstance(members, nullcontext) else ['workers']
    if given:
        raise click.UsageError(f'--{given[0]} is for many points: give --over, --with or a range of --gain too.')
    from ..check.limits import load_limits
    from ..check.report import check_report, checks_as_values, complaint, junit_text
    from ..closed_loop import close_loop as closed_loop
    from ..controllers.own_controller import load_controller, parse_gain
    from ..runs.report import run_report
    from .progress import progress_bar

    loaded = None if limits is None else load_limits(limits)
    own = load_controller(controller, dict(map(parse_gain, gains)))
    with progress_bar('simulating') as progress:
        run = closed_loop(own, changes.load(scene), duration, rate, setpoint, progress)
    options: dict[str, Any] = {'scene': [scene], 'duration': [duration], 'rate': [rate], 'setpoint': [setpoint],
                               'gain': gains, 'set': changes.overrides, 'meant': changes.meant}
    run.receipt['controller']['command'] = shlex.join(['stickslip', 'close-loop', controller, *(
        word for name, values in options.items() for value in values if value is not None
        for word in (f'--{name}', str(value)))])
    checks = [] if loaded is None else [run.check(loaded)]
    if out is not None:
        check_new_folder('--out', out)    # nobody has made it meanwhile
        run.save(out)
    if junit is not None:
        write_text(junit, [junit_text(checks)])
    return _Found(run, [*run_report(run), *(part for one in checks for part in check_report(one))],
                  {'receipt': run.receipt, **(checks_as_values(checks) if checks else {})}, out,
                  (complaint(checks[0], limits) or '') if checks and limits else '')


def _many(scene: str, changes: SceneChanges, gains: tuple[str, ...], out: str, members: Members, resume: bool,
          controller: str, duration: float, rate: float | None, setpoint: str | None, limits: str | None,
          ranges: tuple[str, ...], known: str | None, samples: int | None, seed: int | None, vectorized: bool
          ) -> _Found:
    """Run many points into a folder."""
    from ..closed_loop.many import RESULT, arguments_of, loop_study, ranges_of, run_loops
    from ..closed_loop.report import loops_report
    from ..closed_loop.study import FOLDER_FORM
    from ..study.folder import Folder
    from .progress import progress_bar

    study = loop_study(controller, changes.load(scene), duration, ranges_of(ranges), samples, known, rate, setpoint,
                       limits, arguments_of(gains), vectorized, seed)
    changes.check_ranges(one for one in study.sample.variations if not one.name.startswith('gain.'))
    with progress_bar('simulating') as progress:
        found = run_loops(study, Folder(out, FOLDER_FORM), members, resume, shlex.join(['stickslip', *sys.argv[1:]]),
                          progress)
    failed = study.count - found.pass_rate.passed if limits else 0
    return _Found(found, loops_report(found), found.values(), str(Path(out) / RESULT),
                  f'{failed} of {study.count} points do not pass {limits}' if failed else '')
