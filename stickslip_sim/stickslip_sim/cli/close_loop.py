# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip close-loop`: a controller of the user in a loop with the axis of a scene, once or at many points."""

import shlex
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import click

from . import completion
from .arguments import Members, SceneChanges, scene_changes, verb, worker_options
from .files import FOLDER, PICTURE, STDOUT, TEXT, check_new_folder, say_written, show, whole, write_text


@verb(short_help='Let a controller of yours drive an axis.')
@click.argument('controller', metavar='FILE.py:NAME')
@click.option('--scene', required=True, metavar='SCENE', shell_complete=completion.complete_scenes,
              help='The axis and its rig: the name of a shipped scene or a file.')
@click.option('--duration', type=float, required=True, metavar='S', help='Simulated time, s.')
@click.option('--rate', type=float, metavar='HZ', help='How often it is asked: time.rate, or a whole part of it '
                                                       '[default: after each step].')
@click.option('--setpoint', metavar='FILE.csv', help='Where the slider should be: columns time and position.')
@click.option('--gain', 'gains', multiple=True, metavar='NAME=VALUE',
              help='Make the class NAME with this argument; a range LOW:HIGH[:N][:log] varies it.')
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
def close_loop(controller: str, scene: str, changes: SceneChanges, duration: float, rate: float | None,
               setpoint: str | None, gains: tuple[str, ...], limits: str | None, out: str | None, plot: str | None,
               junit: str | None, json_file: str | None, **of_many: Any) -> None:
    """Let a controller drive the axis of a scene: NAME in FILE.py, a class or a function (docs/closed_loop.md).

    It is called as controller(t, measured), and returns the velocity of the drive.  Exit code 3 when one of --limits is
    not kept.

    With --over, --with or a range of --gain it runs at many points.  FOLDER gets their table, the worst run of each
    limit as a bag, and a map; Ctrl-C keeps the finished points.
    """
    if junit is not None and limits is None:
        raise click.UsageError('--junit is of no use alone: give --limits FILE.yaml too.')
    from ..closed_loop.many import is_range
    if of_many['ranges'] or of_many['known'] or any(is_range(gain.partition('=')[2]) for gain in gains):
        if out is None or junit is not None:
            raise click.UsageError('many points need --out FOLDER, and have no --junit.')
        _many(controller, scene, changes, duration, rate, setpoint, gains, limits, out, plot, json_file, **of_many)
        return
    _check_alone(**of_many)
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
    options: dict[str, Any] = {'scene': [scene], 'duration': [duration], 'rate': [rate], 'setpoint': [setpoint],
                               'gain': gains, 'set': changes.overrides, 'meant': changes.meant}
    run.receipt['controller']['command'] = shlex.join(['stickslip', 'close-loop', controller, *(
        word for name, values in options.items() for value in values if value is not None
        for word in (f'--{name}', str(value)))])
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


def _check_alone(members: Members, **others: object) -> None:
    """Raise UsageError on options that are for many points."""
    found = [name for name, value in others.items() if value not in (None, False, ())]
    found += [] if isinstance(members, nullcontext) else ['workers']
    if found:
        raise click.UsageError(f'--{found[0]} is for many points: give --over, --with or a range of --gain too.')


def _range(text: str) -> tuple[str, str]:
    from ..core.errors import InputError

    name, equals, rest = text.partition('=')
    if not equals or not name.strip():
        raise InputError('--over', text, 'A.B=LOW:HIGH[:N][:log]', 'for example friction.scale=0.8:1.2')
    return name.strip(), rest


def _many(controller: str, scene: str, changes: SceneChanges, duration: float, rate: float | None,
          setpoint: str | None, gains: tuple[str, ...], limits: str | None, out: str, plot: str | None,
          json_file: str | None, ranges: tuple[str, ...], known: str | None, samples: int | None, seed: int | None,
          vectorized: bool, members: Members, resume: bool) -> None:
    """Run many points into a folder, and say what came of them."""
    from ..closed_loop.many import RESULT, arguments_of, loop_study, run_loops
    from ..closed_loop.report import loops_report
    from ..closed_loop.study import FOLDER_FORM
    from ..core.errors import VerdictError
    from ..report.values import json_text
    from ..study.folder import Folder
    from .progress import progress_bar

    over = dict(_range(text) for text in ranges)
    if len(over) < len(ranges):
        raise click.UsageError('--over is given twice for one parameter: drop one of the two.')
    study = loop_study(controller, changes.load(scene), duration, over, samples, known, rate, setpoint, limits,
                       arguments_of(gains), vectorized, seed)
    changes.check_ranges(one for one in study.sample.variations if not one.name.startswith('gain.'))
    with progress_bar('simulating') as progress:
        found = run_loops(study, Folder(out, FOLDER_FORM), members, resume, shlex.join(['stickslip', *sys.argv[1:]]),
                          progress)
    if plot is not None:
        with whole(plot) as temporary:
            found.plot(temporary)
    if json_file is not None:
        write_text(json_file, [json_text(found.values())])
    if json_file != STDOUT:
        show(loops_report(found))
    say_written(str(Path(out) / RESULT), plot, json_file)
    if limits is not None and (failed := study.count - found.pass_rate.passed):
        raise VerdictError(f'{failed} of {study.count} points do not pass {limits}')
