# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip check`: recorded runs or fresh simulations against the limits in a file."""

import json
from typing import TYPE_CHECKING

import click

from . import completion
from .files import STDOUT, check_distinct, check_file, say_written, write_text
from .run_or_scene import is_recorded, recorded_run
from .scene_changes import SceneChanges, scene_changes

if TYPE_CHECKING:
    from ..check.limits import Limits
    from ..runs import Run


@click.command(short_help='Check runs against limits: pass or fail.')
@click.argument('sources', nargs=-1, required=True, metavar='RUN_OR_SCENE...',
                shell_complete=completion.complete_scenes)
@click.option('--limits', 'limits_file', required=True, metavar='FILE.yaml', help='The limits (docs/check.md).')
@click.option('--duration', type=float, metavar='S', help='Time to simulate a scene, s.')
@click.option('--junit', metavar='FILE.xml', help='Write JUnit XML for a CI server ("-": to standard output).')
@click.option('--json', 'json_file', metavar='FILE.json', help='Write everything measured ("-": to standard output).')
@scene_changes('Change a parameter of a scene.')
def check(sources: tuple[str, ...], limits_file: str, duration: float | None, changes: SceneChanges,
          junit: str | None, json_file: str | None) -> None:
    """Check each RUN_OR_SCENE - a run folder, or a scene to simulate - against limits; exit with 3 when one fails.

    Of several, those that cannot be checked are named in the end, and the exit code is 2.
    """
    _check_outputs(junit, json_file)
    _check_sources(sources, duration, changes)
    from ..check.check_report import Checked, checks_as_json, complaint, verdict_line
    from ..check.junit import junit_text
    from ..check.limits import load_limits
    from ..check.outcomes import outcomes_of
    from ..core.errors import InputError, RecordingError, VerdictError
    from .check_table import table_lines
    from .progress import progress_bar

    limits = load_limits(limits_file)
    is_printed = STDOUT not in (junit, json_file)
    found, refused = [], []
    for source in sources:
        try:
            run = _run(source, limits, duration, changes)
            name = run.name if len(sources) == 1 else source   # two folders may have one name
            with progress_bar('checking'):
                found.append(Checked(name, run, outcomes_of(limits, run)))
        except (InputError, RecordingError) as error:
            if len(sources) == 1:
                raise
            refused.append(f'{source} cannot be checked: {error}')    # the others can
            continue
        if is_printed:
            print('\n'.join([*table_lines(found[-1]), verdict_line(found[-1])]), flush=True)
    failed = list(filter(None, (complaint(checked, limits_file) for checked in found)))
    if is_printed and len(sources) > 1:
        print(f'{len(found) - len(failed)} of {len(sources)} runs keep {limits_file}', flush=True)
    if refused:      # files without these runs would look like all is well
        raise RecordingError('; '.join([*refused, *failed]))
    if json_file is not None:
        write_text(json_file, [json.dumps(checks_as_json(found), indent=2, allow_nan=False) + '\n'])
    if junit is not None:
        write_text(junit, [junit_text(found)])
    say_written(json_file, junit)
    if failed:
        raise VerdictError('; '.join(failed))


def _check_outputs(junit: str | None, json_file: str | None) -> None:
    """Raise before the work begins when an output cannot be written."""
    targets = [(option, path) for option, path in (('--junit', junit), ('--json', json_file)) if path is not None]
    for option, path in targets:
        if path != STDOUT:
            check_file(option, path)
    check_distinct(targets)


def _check_sources(sources: tuple[str, ...], duration: float | None, changes: SceneChanges) -> None:
    """Raise before the work begins when an option has no effect or one is missing, or a source comes twice."""
    recorded = [is_recorded(source) for source in sources]
    if all(recorded) and (duration is not None or changes.overrides):
        raise click.UsageError('--duration and --set are for a scene; a run stays as it was recorded.')
    if not all(recorded) and duration is None:
        raise click.UsageError('--duration S is needed to simulate a scene.')
    if len(set(sources)) < len(sources):
        raise click.UsageError('RUN_OR_SCENE: give each once.')


def _run(source: str, limits: 'Limits', duration: float | None, changes: SceneChanges) -> 'Run':
    if is_recorded(source) or duration is None:   # a scene has one
        return recorded_run(source)
    return _simulated(source, limits, duration, changes)


def _simulated(source: str, limits: 'Limits', duration: float, changes: SceneChanges) -> 'Run':
    """Return the run of a scene with a sample each step, as its node would record it."""
    from ..check.limits import check_fit
    from ..runs import simulate
    from ..runs.simulated import check_run_times
    from .progress import progress_bar

    check_run_times(duration, None)
    check_fit(limits, 0.0, duration, has_timing=False, commands=None)
    scene = changes.load(source)
    with progress_bar('simulating') as progress:
        return simulate(scene, duration, progress=progress)
