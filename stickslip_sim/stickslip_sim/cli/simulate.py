# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip simulate`: run a scene as fast as possible and write the outputs that are asked for."""

from dataclasses import replace

import click

from .arguments import SceneChanges, check_usage, scene_argument, scene_changes, verb
from .files import FOLDER, PICTURE, STDOUT, TEXT, draw, progress_bar, say_written, show, write_text


@verb(short_help='Simulate a scene and write tables, a picture or a bag.')
@scene_argument
@click.option('--duration', type=float, required=True, metavar='SECONDS', help='Simulated time.')
@click.option('--events', type=TEXT, metavar='FILE.csv', help='Write the events ("-" for standard output).')
@click.option('--knots', is_flag=True, help='Also list where the speed crosses breakpoints of friction tables.')
@click.option('--samples', type=TEXT, metavar='FILE.csv', help='Write the state over time ("-" for standard output).')
@click.option('--sample-period', type=float, metavar='SECONDS',
              help='Time between samples [default: a step of the scene].')
@click.option('--bag', type=FOLDER, metavar='FOLDER', help='Record the run as a ROS 2 bag, one state per step.')
@click.option('--receipt', type=TEXT, metavar='FILE.json', help='Write versions, figures, energy, error and cost.')
@click.option('--plot', type=PICTURE, metavar='FILE.png',
              help='Plot the run, like `stickslip plot` (.png, .pdf or .svg).')
@click.option('--seed', type=int, metavar='SEED', help='Seed of all random numbers [default: `seed` of the scene].')
@scene_changes('Change a parameter of the scene.')
def simulate(scene: str, changes: SceneChanges, duration: float, seed: int | None, events: str | None, knots: bool,
             samples: str | None, sample_period: float | None, bag: str | None, receipt: str | None, plot: str | None
             ) -> None:
    """Simulate SCENE, a shipped scene or a file, and print a summary.

    The summary is omitted if something else is written to standard output ("-").
    """
    check_usage((knots and events is None, '--knots needs --events FILE.csv.'),
                (sample_period is not None and samples is None, '--sample-period needs --samples FILE.csv.'))
    from ..report.values import json_text
    from ..runs import simulate as simulate_sampled
    from ..runs import simulate_events
    from ..runs.error_estimate import error_estimate
    from ..runs.report import run_report
    from ..runs.simulated import check_run_times
    from .csv_tables import event_lines, sample_lines

    check_run_times(duration, sample_period)
    loaded = (changes if seed is None else changes.also(f'seed={seed}')).load(scene)
    with progress_bar('simulating') as progress:
        if samples or bag:
            run = simulate_sampled(loaded, duration, sample_period or loaded.time.step, progress)
        else:
            run = simulate_events(loaded, duration, progress)
    if receipt or bag:
        run = replace(run, receipt={**run.receipt, 'error_estimate': error_estimate(run)._asdict()})
    if bag is not None:
        from ..recording.offline_bag import write_run

        write_run(bag, run)
    draw(plot, run.plot)
    texts = [(receipt, [json_text(run.receipt, 2)]), (events, event_lines(run.events, knots)),
             (samples, sample_lines(run.sample_blocks()))]
    for path, lines in sorted(texts, key=lambda text: text[0] == STDOUT):    # its reader may leave early
        write_text(path, lines)
    show(run_report(run), receipt, events, samples)
    say_written(events, samples, bag, receipt, plot)
