# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip verify`: run a recorded run again and compare, as it was or with changes (what if)."""

import click

from .arguments import SceneChanges, check_usage, recorded_run, run_argument, scene_changes, verb
from .files import FOLDER, end_with, new_folder, progress_bar, say_written, show


@verb(short_help='Repeat a recorded run bit by bit, or ask "what if".')
@run_argument
@click.option('--out', type=FOLDER, metavar='FOLDER',
              help='With --set: new folder for the figures, picture and scene.')
@scene_changes('Repeat with another value of this parameter.')
def verify(run: str, changes: SceneChanges, out: str | None) -> None:
    """Simulate the recorded RUN again from its scene and commands, without ROS, and compare every bit.

    Prints "identical", or the first difference with exit code 3.  With --set, the same commands drive a changed scene,
    and both runs are compared.
    """
    check_usage((out and not changes.overrides, '--out needs --set A.B=VALUE.'))
    from ..check import verification
    from ..check.remake import doubts_about, feedback_note, other_run, other_scene
    from ..check.report import beside_table, verdict_report, write_what_if
    from ..report.model import NOTE, Sentence

    recorded = recorded_run(run)
    doubts = [Sentence(doubt, NOTE) for doubt in doubts_about(recorded)]
    given = changes.given()
    scene = other_scene(recorded, given)
    changes.check_changed(scene)
    with progress_bar('verifying') as progress:
        verdict = verification.verify(recorded, progress)
    show([*doubts, *verdict_report(recorded, verdict)], flush=True)
    if given:
        _ = recorded.summary   # what cannot be read is refused before the work begins
        with progress_bar('what if') as progress:
            other = other_run(recorded, scene, given, progress)
        note = feedback_note(recorded, given)
        show([beside_table(recorded, other), *([Sentence(note, NOTE)] if note else [])], flush=True)
        if out is not None:
            with new_folder('--out', out) as folder:
                write_what_if(folder, given, recorded, other)
            say_written(out)
    end_with(f'{run} differs from its re-simulation at {verdict.difference}' if verdict.difference else '')
