# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip predict`: a scene driven by the measured input of runs that it was not identified from."""

from pathlib import Path

import click

from . import completion
from .arguments import SceneChanges, recorded_run, scene_argument, scene_changes, verb
from .files import FOLDER, new_folder, progress_bar, say_written, show


@verb(short_help='Test a scene on measured runs it has not seen.')
@scene_argument
@click.argument('runs', nargs=-1, required=True, metavar='RUN...', shell_complete=completion.complete_folders)
@click.option('--out', type=FOLDER, metavar='FOLDER', help='New folder for the report and pictures.')
@scene_changes('Change a parameter of the scene.')
def predict(scene: str, runs: tuple[str, ...], out: str | None, changes: SceneChanges) -> None:
    """Drive SCENE with the measured drive and force of each RUN, and report the prediction error.

    Sensor offsets, delays and the initial state are fitted; the physics is not.  The report lists RMS error, fit in %
    (100 (1 − |error| / |measured − mean|)) and largest error.  For an identified.yaml, the sensors are known from the
    report.json in its folder.
    """
    from ..identification.prediction import known_sensors, predicted
    from ..identification.readings import check_distinct
    from ..identification.report import prediction_parts, write_predictions
    from ..runs.report import named_apart
    from ..scene.load import named

    made, known = changes.load(scene), known_sensors(scene)
    given = [recorded_run(run) for run in runs]
    check_distinct(given)
    found = {}
    with progress_bar('predicting') as progress:
        for name, run in named_apart(given).items():
            with named(name):
                found[name] = predicted(made, scene, known, run)
            if progress:
                progress(len(found) / len(given))
    show([part for name, one in found.items() for part in prediction_parts(one, name)])
    if out is not None:
        with new_folder('--out', out) as folder:
            write_predictions(found, folder)
        say_written(str(Path(out) / 'report.html'))
