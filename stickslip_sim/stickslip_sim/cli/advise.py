# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip advise`: which parts of a scene, and which solver, a tolerance asks for, measured on this machine."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from . import completion
from .files import check_distinct, check_file, say_written, write_text
from .scene_changes import SceneChanges, scene_changes

if TYPE_CHECKING:
    from ..advise.advice import Advice

_ROUNDS = 5


@click.command(short_help='Show which parts and which solver a tolerance needs.')
@click.argument('scene', metavar='SCENE', shell_complete=completion.complete_scenes)
@click.option('--tolerance', type=float, required=True, metavar='T', help='Relative error that is allowed, as 1e-3.')
@click.option('--duration', type=float, metavar='S', help='Simulated time, s [default: 10 s, or more for 20 cycles].')
@click.option('--out', metavar='FILE.json', help='Write everything that was measured.')
@click.option('--scene-out', metavar='FILE.yaml', help='Write the least scene.')
@click.option('--rounds', type=click.IntRange(1, 1000), default=_ROUNDS, metavar='N',
              help=f'Samples of each cost [default: {_ROUNDS}].')
@scene_changes('Change a parameter of the scene.')
def advise(scene: str, tolerance: float, duration: float | None, changes: SceneChanges, out: str | None,
           scene_out: str | None, rounds: int) -> None:
    """Run SCENE without each of its parts and with each solver; print what changes, and the least that T asks for."""
    _check(out, scene_out)
    from ..advise import advice
    from ..advise.advice_report import advice_as_json, text_lines, verdict_lines
    from ..advise.duration import check_duration, default_duration
    from ..advise.trial_runs import changes_between
    from ..scene.values import overridden
    from .progress import progress_bar

    advice.check_tolerance(tolerance)
    if duration is not None:
        check_duration(duration)
    loaded = changes.load(scene)
    with progress_bar('advising') as progress:
        found = advice.advise(loaded, tolerance, duration or default_duration(loaded), rounds, progress)
    least = found.least.trial.scene or loaded
    overrides = overridden(changes.given(), changes_between(loaded, least))
    print('\n'.join([*text_lines(found), *verdict_lines(found, overrides)]))
    if out is not None:
        write_text(out, [json.dumps(advice_as_json(found, overrides), indent=1, allow_nan=False) + '\n'])
    if scene_out is not None:
        _write_scene(scene_out, found)
    say_written(out, scene_out)


def _check(out: str | None, scene_out: str | None) -> None:
    """Raise before the work begins when an output cannot be written."""
    from ..core.errors import InputError

    targets = [(option, path) for option, path in (('--out', out), ('--scene-out', scene_out)) if path is not None]
    for option, path in targets:
        check_file(option, path)
    check_distinct(targets)
    if scene_out is not None and Path(scene_out).suffix not in ('.yaml', '.yml'):
        raise InputError('--scene-out', scene_out, 'a file ending in .yaml or .yml', 'name it so')


def _write_scene(path: str, advice: 'Advice') -> None:
    from ..advise.parts import without_idle_sinusoids
    from ..scene import scene_from_values
    from ..scene.load import values_in_file
    from ..scene.text import scene_text

    least = advice.least
    scene = scene_from_values(without_idle_sinusoids((least.trial.scene or advice.reference.scene).values))
    without = f' without {", ".join(least.parts)}' if least.parts else ''
    comment = f'# {scene.name}{without}: the least for a relative error of {advice.tolerance:g}.\n'
    write_text(path, [comment, scene_text(values_in_file(scene))])
