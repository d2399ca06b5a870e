# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip verify`: run a recorded run again and compare, as it was or with changes (what if)."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from . import completion
from .files import check_new_folder, new_folder, say_written
from .run_or_scene import recorded_run
from .scene_changes import SceneChanges, scene_changes

if TYPE_CHECKING:
    from ..recording import RecordedRun
    from ..runs import Run
    from ..scene import Scene
    from ..verify.verification import Verdict


_DRAWN = 'position', 'velocity', 'friction_force'


@click.command(short_help='Run a recorded run again; with --set, what would have been.')
@click.argument('run', metavar='RUN', shell_complete=completion.complete_folders)
@click.option('--out', metavar='FOLDER', help='With --set: new folder for figures, picture and scene of what if.')
@scene_changes('What if this parameter had been another?')
def verify(run: str, changes: SceneChanges, out: str | None) -> None:
    """Simulate the recorded RUN again from its scene and its orders, without ROS, and compare every bit.

    "identical", or exit code 3 and the first difference.  With --set, the same orders under another scene are set
    beside it.
    """
    _check(changes, out)
    from ..core.errors import VerdictError
    from ..verify import verification
    from ..verify.origin import doubts_about
    from ..verify.what_if import other_scene
    from .progress import progress_bar

    recorded = recorded_run(run)
    doubts = doubts_about(recorded)
    given = changes.given()
    scene = other_scene(recorded, given)
    changes.check_changed(scene)
    for doubt in doubts:
        print(f'note: {doubt}')
    with progress_bar('verifying') as progress:
        verdict = verification.verify(recorded, progress)
    _print_verdict(recorded, verdict)
    if given:
        _what_if(recorded, scene, given, out)
    if verdict.difference:
        raise VerdictError(f'{run} differs from its re-simulation at {verdict.difference}')


def _check(changes: SceneChanges, out: str | None) -> None:
    """Raise before the work begins when the output cannot be written or an option has no effect."""
    if out is None:
        return
    if not changes.overrides:
        raise click.UsageError('--out is of no use alone: give --set A.B=VALUE too.')
    check_new_folder('--out', out)


def _print_verdict(run: 'RecordedRun', verdict: 'Verdict') -> None:
    from ..verify.origin import made_with

    if verdict.missing:
        print(f'note: {verdict.missing} steps have no recorded state')
    if verdict.difference:
        print(f'differs after {_amount(verdict)} that are identical')
        print(f'      recorded with {made_with(run)}')
        return
    extent = 'identical' if run.is_complete else 'identical as far as it goes'
    print(f'{extent}, {_amount(verdict)}, up to t = {verdict.end:.9g} s', flush=True)


def _amount(verdict: 'Verdict') -> str:
    return f'{verdict.steps} steps, {verdict.events} events'


def _what_if(run: 'RecordedRun', scene: 'Scene', changes: dict[str, object], out: str | None) -> None:
    from ..verify.what_if import other_run
    from .format import beside_lines
    from .progress import progress_bar

    _ = run.summary   # what cannot be read is refused before the work begins
    with progress_bar('what if') as progress:
        other = other_run(run, scene, changes, progress)
    print('\n'.join(beside_lines(run.summary, other.summary)), flush=True)
    if out is not None:
        with new_folder('--out', out) as folder:
            _write(folder, changes, run, other)
        say_written(out)


def _write(folder: Path, changes: dict[str, object], recorded: 'Run', other: 'Run') -> None:
    from ..plots import plot_beside
    from ..runs.receipt import plain
    from ..runs.reduced import reduced
    from ..scene.load import values_in_file
    from ..scene.text import scene_text

    scene = other.scene
    changed = ', '.join(f'{name} = {value}' for name, value in changes.items())
    was, would_be = (reduced(run.sample_blocks(), [(run.begin, run.end)], _DRAWN) for run in (recorded, other))
    plot_beside(was, would_be, f'{recorded.title}\nwhat if {changed}', folder / 'what_if.png')
    figures = {'scene': scene.name, 'changes': changes, 'recorded': recorded.summary, 'what_if': other.summary}
    text = json.dumps(plain(figures), indent=2, allow_nan=False) + '\n'
    (folder / 'what_if.json').write_text(text, encoding='utf-8')
    (folder / 'scene.yaml').write_text(scene_text(values_in_file(scene)), encoding='utf-8')
