# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip advise`: which parts of a scene, and which solver, a tolerance asks for, measured on this machine."""

import click

from .arguments import SceneChanges, scene_argument, scene_changes, verb
from .files import FILE, SCENE_FILE, progress_bar, say_written, show, write_json, write_text

_ROUNDS = 5


@verb(short_help='Show which parts and which solver a tolerance needs.')
@scene_argument
@click.option('--tolerance', type=float, required=True, metavar='T', help='Allowed relative error, such as 1e-3.')
@click.option('--duration', type=float, metavar='SECONDS',
              help='Simulated time [default: 10 s, or more for 20 cycles].')
@click.option('--out', type=FILE, metavar='FILE.json', help='Write all measurements.')
@click.option('--scene-out', type=SCENE_FILE, metavar='FILE.yaml', help='Write the smallest sufficient scene.')
@click.option('--rounds', type=click.IntRange(1, 1000), default=_ROUNDS, metavar='N',
              help=f'Timing samples per case [default: {_ROUNDS}].')
@scene_changes('Change a parameter of the scene.')
def advise(scene: str, tolerance: float, duration: float | None, changes: SceneChanges, out: str | None,
           scene_out: str | None, rounds: int) -> None:
    """Find the smallest model and solver that keep SCENE within a tolerance.

    Each part of the scene is left out in turn, and each solver tried; the report lists what changes.
    """
    from ..advise import advice
    from ..advise.report import advice_as_values, advice_report, least_scene_lines, verdict_report
    from ..advise.trial_runs import changes_between, check_duration, default_duration
    from ..scene.values import overridden

    advice.check_tolerance(tolerance)
    if duration is not None:
        check_duration(duration)
    loaded = changes.load(scene)
    with progress_bar('advising') as progress:
        found = advice.advise(loaded, tolerance, duration or default_duration(loaded), rounds, progress)
    overrides = overridden(changes.given(), changes_between(loaded, found.least.trial.scene or loaded))
    show([*advice_report(found), *verdict_report(found, overrides)])
    write_json(out, advice_as_values(found, overrides), 1)
    write_text(scene_out, least_scene_lines(found))
    say_written(out, scene_out)
