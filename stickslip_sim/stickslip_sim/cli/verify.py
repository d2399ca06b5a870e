# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip verify`: run a recorded run again and compare, as it was or with changes (what if)."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .files import check_new_folder, new_folder

if TYPE_CHECKING:
    from ..scene import Scene
    from ..verify.original import Original
    from ..verify.verification import Verdict
    from ..verify.what_if import Side


@click.command(short_help='Run a recorded run again; with --set, what would have been.')
@click.argument('run', metavar='RUN')
@click.option('--set', 'changes', multiple=True, metavar='A.B=VALUE', help='What if this parameter had been another?')
@click.option('--out', metavar='FOLDER', help='With --set: new folder for figures, picture and scene of what if.')
def verify(run: str, changes: tuple[str, ...], out: str | None) -> None:
    """Simulate the recorded RUN again from its scene and its orders, without ROS, and compare every bit.

    "identical", or exit code 3 and the first difference.  With --set, the same orders under another scene are set
    beside it.
    """
    _check(changes, out)
    from ..core.errors import VerdictError
    from ..scene import parse_override
    from ..verify.original import open_original
    from ..verify.verification import verify as judge
    from ..verify.what_if import other_scene
    from .progress import progress_bar

    original = open_original(run)
    given = dict(parse_override(change) for change in changes)
    scene = other_scene(original, given)
    for note in original.notes:
        print(f'note: {note}')
    with progress_bar('verifying') as progress:
        verdict = judge(original, progress)
    _tell(original, verdict)
    if given:
        _what_if(original, scene, given, out)
    if verdict.difference:
        raise VerdictError(f'{run} differs from its re-simulation at {verdict.difference}')


def _check(changes: tuple[str, ...], out: str | None) -> None:
    """Raise before the work begins when the output cannot be written or an option has no effect."""
    if out is None:
        return
    if not changes:
        raise click.UsageError('--out is of no use alone: give --set A.B=VALUE too.')
    check_new_folder('--out', out)


def _tell(original: 'Original', verdict: 'Verdict') -> None:
    from ..verify.original import made_with

    if verdict.missing:
        print(f'note: {verdict.missing} steps have no recorded state')
    if verdict.difference:
        print(f'differs after {_amount(verdict)} that are identical')
        print(f'      recorded with {made_with(original)}')
        return
    extent = 'identical' if original.run.is_complete else 'identical as far as it goes'
    print(f'{extent}, {_amount(verdict)}, up to t = {verdict.end:.9g} s', flush=True)


def _amount(verdict: 'Verdict') -> str:
    return f'{verdict.steps} steps, {verdict.events} events'


def _what_if(original: 'Original', scene: 'Scene', changes: dict[str, object], out: str | None) -> None:
    from ..verify.what_if import other_side, recorded_side
    from .format import beside_lines
    from .progress import progress_bar

    recorded = recorded_side(original)
    with progress_bar('what if') as progress:
        other = other_side(original, scene, changes, progress)
    print('\n'.join(beside_lines(recorded.figures, other.figures)), flush=True)
    if out is not None:
        with new_folder('--out', out) as folder:
            _write(folder, scene, changes, recorded, other)
        print(f'written: {out}')


def _write(folder: Path, scene: 'Scene', changes: dict[str, object], recorded: 'Side', other: 'Side') -> None:
    from ..plots import plot_beside
    from ..runs.receipt import plain

    changed = ', '.join(f'{name} = {value}' for name, value in changes.items())
    plot_beside(recorded.columns, other.columns, f'{scene.name}\nwhat if {changed}', folder / 'what_if.png')
    figures = {'scene': scene.name, 'changes': changes, 'recorded': recorded.figures, 'what_if': other.figures}
    text = json.dumps(plain(figures), indent=2, allow_nan=False) + '\n'
    (folder / 'what_if.json').write_text(text, encoding='utf-8')
    (folder / 'scene.yaml').write_text(scene.text, encoding='utf-8')
