# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip simulate`: run a scene as fast as possible and write the outputs that are asked for."""

import json
import shutil
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import click

from . import completion
from .files import STDOUT, check_distinct, check_file, check_new_folder, check_picture, say_written, whole, write_text
from .scene_changes import SceneChanges, scene_changes

if TYPE_CHECKING:
    from ..runs import SimulatedRun
    from ..scene import Scene



class _Wishes(NamedTuple):
    """The options of the user."""

    duration: float
    events: str | None
    knots: bool
    samples: str | None
    sample_period: float | None
    bag: str | None
    receipt: str | None
    plot: str | None


@click.command(short_help='Simulate a scene: figures, tables, picture, bag.')
@click.argument('scene', metavar='SCENE', shell_complete=completion.complete_scenes)
@click.option('--duration', type=float, required=True, metavar='S', help='Simulated time, s.')
@click.option('--events', metavar='FILE.csv', help='Write the events ("-": to standard output).')
@click.option('--knots', is_flag=True, help='List the crossings of breakpoints of friction tables among the events.')
@click.option('--samples', metavar='FILE.csv', help='Write the state over time ("-": to standard output).')
@click.option('--sample-period', type=float, metavar='S', help="Time between samples [default: a step of the scene].")
@click.option('--bag', metavar='FOLDER', help='Record the run as a ROS 2 bag, one state a step.')
@click.option('--receipt', metavar='FILE.json', help='Write versions, figures, energy, error and cost.')
@click.option('--plot', metavar='FILE.png', help='Draw the run, as `stickslip plot` does (.png, .pdf or .svg).')
@scene_changes('Change a parameter of the scene.')
def simulate(scene: str, changes: SceneChanges, **options: object) -> None:
    """Simulate SCENE, the name of a shipped scene or a file.

    A summary is printed, unless something else is written to standard output ("-").
    """
    wishes = _Wishes(**options)  # type: ignore[arg-type]
    _check(wishes)
    from ..runs import simulate, simulate_events
    from ..runs.simulated import check_run_times
    from .progress import progress_bar

    check_run_times(wishes.duration, wishes.sample_period)
    loaded = changes.load(scene)
    period = _sample_period(wishes, loaded)
    with progress_bar('simulating') as progress:
        if period is None:
            run = simulate_events(loaded, wishes.duration, progress)
        else:
            run = simulate(loaded, wishes.duration, period, progress)
    if wishes.receipt or wishes.bag:
        run = _with_estimate(run)
    _write(wishes, run)


def _check(wishes: _Wishes) -> None:
    """Raise before the work begins when an output cannot be written or an option has no effect."""
    if wishes.knots and wishes.events is None:
        raise click.UsageError('--knots chooses what --events lists: give --events FILE.csv too.')
    if wishes.sample_period is not None and wishes.samples is None:
        raise click.UsageError('--sample-period is of no use alone: give --samples FILE.csv too.')
    files = {'--events': wishes.events, '--samples': wishes.samples, '--receipt': wishes.receipt, '--plot': wishes.plot}
    targets = [(option, path) for option, path in files.items() if path is not None]
    for option, path in targets:
        if option == '--plot':
            check_picture(option, path)
        elif path != STDOUT:
            check_file(option, path)
    if wishes.bag is not None:
        check_new_folder('--bag', wishes.bag)
        targets.append(('--bag', wishes.bag))
    check_distinct(targets)


def _sample_period(wishes: _Wishes, scene: 'Scene') -> Fraction | float | None:
    if wishes.sample_period is not None:
        return wishes.sample_period
    return scene.time.step if wishes.samples or wishes.bag else None


def _with_estimate(run: 'SimulatedRun') -> 'SimulatedRun':
    """Return the run with an estimate of its error in the receipt; that takes a few more runs."""
    from ..runs.error_estimate import error_estimate

    return replace(run, receipt={**run.receipt, 'error_estimate': error_estimate(run)._asdict()})


def _write(wishes: _Wishes, run: 'SimulatedRun') -> None:
    """Write the outputs, standard output last: its reader may leave early."""
    from .csv_tables import event_lines, sample_lines

    if wishes.bag is not None:
        _write_bag(wishes.bag, run)
    if wishes.plot is not None:
        _draw(wishes.plot, run)
    receipt = json.dumps(run.receipt, indent=2, allow_nan=False) + '\n'
    texts = [(wishes.receipt, [receipt]), (wishes.events, event_lines(run.events, wishes.knots)),
             (wishes.samples, sample_lines(run.sample_blocks()))]
    for path, lines in sorted(texts, key=lambda text: text[0] == STDOUT):
        if path is not None:
            write_text(path, lines)
    if STDOUT not in (wishes.receipt, wishes.events, wishes.samples):
        _print_figures(run)
    say_written(wishes.events, wishes.samples, wishes.bag, wishes.receipt, wishes.plot)


def _write_bag(folder: str, run: 'SimulatedRun') -> None:
    """Record the run step by step; a folder that was begun vanishes on any error."""
    from ..recording.offline_bag import write_blocks
    from ..recording.run import RunFacts

    run = _sampled(run, run.scene.time.step)
    facts = RunFacts.of(run.scene, run.duration, run.sample_period)
    check_new_folder('--bag', folder)
    try:
        write_blocks(folder, facts, run.sample_blocks(), run.events, run.receipt)
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        raise


def _draw(path: str, run: 'SimulatedRun') -> None:
    with whole(path) as temporary:
        run.plot(temporary)


def _sampled(run: 'SimulatedRun', period: Fraction) -> 'SimulatedRun':
    """Return the same run with other samples."""
    from ..runs import simulate

    if run.sample_period == period:
        return run
    again = simulate(run.scene, run.duration, period)
    return replace(again, receipt={**run.receipt, **again.receipt})


def _print_figures(run: 'SimulatedRun') -> None:
    from ..runs.wording import miss_note, quantity
    from .format import summary_lines

    cost, energy, note = run.receipt['cost'], run.receipt['energy'], miss_note(run.scene)
    print(f'{run.scene.name}: {run.duration:g} s with the {run.scene.solver.name} solver')
    if note:
        print(f'{"note":22} {note}')
    print('\n'.join(summary_lines(run.summary)))
    if energy is not None:
        print(f'{"energy":22} {quantity(energy["drive_work"], "J")} from the drive, '
              f'{quantity(energy["friction_loss"], "J")} to friction; '
              f'the balance closes to {energy["relative_residual"]:.1g} of the throughput')
    print(f'{"cost":22} {quantity(cost["cpu_time_s"], "s")} CPU, '
          f'{quantity(cost["cpu_time_per_simulated_second"], "s")} per simulated second')
