# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip tune`: margins of a controller of the user about stick and slip, and why its loop swings."""

import click

from .arguments import SceneChanges, controller_options, scene_changes, verb
from .files import PICTURE, TEXT, draw, progress_bar, say_written, show, write_json


@verb(short_help='Show the stability margins of your controller.')
@controller_options('Argument of the class NAME.')
@click.option('--feed', type=float, metavar='SPEED', help="Slip speed in m/s [default: the scene's largest].")
@click.option('--duration', type=float, default=20.0, show_default=True, metavar='SECONDS',
              help='Simulated time of the closed loop, half at the feed and half holding.')
@click.option('--plot', type=PICTURE, metavar='FILE.png', help='Plot Bode diagrams, step response and oscillation.')
@click.option('--json', 'json_file', type=TEXT, metavar='FILE.json',
              help='Write all numbers ("-" for standard output).')
@scene_changes('Change a parameter of the scene.')
def tune(controller: str, scene: str, changes: SceneChanges, feed: float | None, rate: float | None,
         gains: tuple[str, ...], duration: float, plot: str | None, json_file: str | None) -> None:
    """Show the stability margins of NAME in FILE.py, a controller class or function, and why its loop oscillates.

    The controller is probed with small signals around stick and steady slip (docs/closed_loop.md).
    """
    from ..closed_loop.report import tuning_report, tuning_values
    from ..closed_loop.tuning import tune as tuned
    from ..controllers.own_controller import load_controller, parse_gain

    own = load_controller(controller, dict(map(parse_gain, gains)))
    with progress_bar('simulating') as progress:
        found = tuned(own, changes.load(scene), feed, rate, duration, progress)
    draw(plot, found.plot)
    show(tuning_report(found), json_file)
    write_json(json_file, tuning_values(found))
    say_written(plot, json_file)
