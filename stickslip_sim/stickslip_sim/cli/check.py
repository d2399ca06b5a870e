# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip check`: recorded runs or fresh simulations against the limits in a file."""

from typing import TYPE_CHECKING

import click

from . import completion
from .arguments import SceneChanges, check_sources, is_recorded, recorded_run, scene_changes, simulated, verb
from .files import STDOUT, TEXT, say_written, show, write_text

if TYPE_CHECKING:
    from ..check.limits import Limits
    from ..runs import Run


@verb(short_help='Check runs against limits: pass or fail.')
@click.argument('sources', nargs=-1, required=True, metavar='RUN_OR_SCENE...',
                shell_complete=completion.complete_scenes)
@click.option('--limits', 'limits_file', required=True, metavar='FILE.yaml', help='The limits (docs/check.md).')
@click.option('--duration', type=float, metavar='S', help='Time to simulate a scene, s.')
@click.option('--junit', type=TEXT, metavar='FILE.xml',
              help='Write JUnit XML for a CI server ("-": to standard output).')
@click.option('--json', 'json_file', type=TEXT, metavar='FILE.json',
              help='Write everything measured ("-": to standard output).')
@scene_changes('Change a parameter of a scene.')
def check(sources: tuple[str, ...], limits_file: str, duration: float | None, changes: SceneChanges,
          junit: str | None, json_file: str | None) -> None:
    """Check each RUN_OR_SCENE - a run folder, or a scene to simulate - against limits; exit with 3 when one fails.

    Of several, those that cannot be checked are named in the end, and the exit code is 2.
    """
    check_sources(sources, duration, changes)
    if len(set(sources)) < len(sources):
        raise click.UsageError('RUN_OR_SCENE: give each once.')
    from ..check.limits import load_limits, outcomes_of
    from ..check.report import Checked, check_report, checks_as_values, complaint, junit_text
    from ..core.errors import InputError, RecordingError, VerdictError
    from ..report.values import json_text
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
            show(check_report(found[-1]), flush=True)
    failed = list(filter(None, (complaint(checked, limits_file) for checked in found)))
    if is_printed and len(sources) > 1:
        show([f'{len(found) - len(failed)} of {len(sources)} runs keep {limits_file}'], flush=True)
    if refused:      # files without these runs would look like all is well
        raise RecordingError('; '.join([*refused, *failed]))
    if json_file is not None:
        write_text(json_file, [json_text(checks_as_values(found), 2)])
    if junit is not None:
        write_text(junit, [junit_text(found)])
    say_written(json_file, junit)
    if failed:
        raise VerdictError('; '.join(failed))


def _run(source: str, limits: 'Limits', duration: float | None, changes: SceneChanges) -> 'Run':
    from ..check.limits import check_fit

    if is_recorded(source) or duration is None:   # a scene has one
        return recorded_run(source)
    check_fit(limits, 0.0, duration, has_timing=False, commands=None)
    return simulated(source, duration, changes, each_step=True)
