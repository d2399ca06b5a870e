# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip check`: recorded runs or fresh simulations against the limits in a file, and as ISO 230 has them."""

from functools import partial

import click

from . import arguments
from .arguments import SceneChanges, scene_changes, verb
from .files import PICTURE, TEXT, draw, end_with, progress_bar, say_written, show, write_json, write_text


@verb(short_help='Check runs against limits; exit with 3 if one fails.')
@arguments.sources_argument
@click.option('--limits', 'limits_file', metavar='FILE.yaml', help='Limits to check (docs/check.md).')
@click.option('--circle', is_flag=True, help='Treat the runs as axes x and y of a circle (ISO 230-4).')
@click.option('--radius', type=float, metavar='METRES',
              help='Radius of the nominal circle [default: as commanded].')
@click.option('--positioning', is_flag=True, help='Also print the figures of ISO 230-2.')
@click.option('--plot', type=PICTURE, metavar='FILE.png|pdf|svg', help='Draw the deviation from the circle.')
@arguments.scene_duration
@click.option('--junit', type=TEXT, metavar='FILE.xml',
              help='Write JUnit XML for a CI server ("-" for standard output).')
@click.option('--json', 'json_file', type=TEXT, metavar='FILE.json',
              help='Write all measurements ("-" for standard output).')
@scene_changes('Change a parameter of a scene.')
def check(sources: tuple[str, ...], limits_file: str | None, circle: bool, radius: float | None, positioning: bool,
          plot: str | None, duration: float | None, changes: SceneChanges, junit: str | None, json_file: str | None
          ) -> None:
    """Check each RUN_OR_SCENE (a run folder, or a scene to simulate) against limits; exit with 3 if one fails.

    If some of several cannot be checked, they are listed at the end and the exit code is 2.  With --circle, give the
    runs of x and y, or a bag of both, then those of the other direction.
    """
    arguments.check_sources(sources, duration, changes, once=not circle)    # x goes the same way in both senses
    arguments.check_usage((circle and positioning, '--circle and --positioning exclude each other.'),
                (not circle and (radius is not None or plot), '--radius and --plot need --circle.'),
                (limits_file is None and not (circle or positioning), "Missing option '--limits'."))
    from ..check.circle import check_circle
    from ..check.limits import Limits, load_limits
    from ..check.report import check_report, check_run, checks_as_values, complaint, draw_test, junit_text, matrix
    from ..core.errors import InputError, RecordingError

    limits = (load_limits(limits_file) if limits_file else Limits(())).with_radius(radius)
    found, refused = [], []
    groups = [sources] if circle else [(source,) for source in sources]
    for group in groups:
        try:
            runs = [(source, arguments.run_of_source(source, duration, changes, limits)) for source in group]
            run = runs[0][1]
            name = group[0] if len(groups) > 1 else run.name    # two folders may have one name
            with progress_bar('checking'):
                found.append(check_circle(limits, runs) if circle else check_run(name, run, limits, positioning))
        except (InputError, RecordingError) as error:
            if len(groups) == 1:
                raise
            refused.append(f'{group[0]} cannot be checked: {error}')    # the others can
            continue
        show(check_report(found[-1]), junit, json_file, flush=True)
    failed = list(filter(None, (complaint(checked, str(limits_file)) for checked in found)))
    if len(groups) > 1 and limits_file:
        kept = f'{len(found) - len(failed)} of {len(sources)} runs keep {limits_file}'
        show([matrix(found), kept] if len(found) > 1 else [kept], junit, json_file, flush=True)
    if refused:      # files without these runs would look like all is well
        raise RecordingError('; '.join([*refused, *failed]))
    draw(plot, partial(draw_test, found[0]))
    write_json(json_file, checks_as_values(found))
    write_text(junit, [junit_text(found)])
    say_written(plot, json_file, junit)
    end_with('; '.join(failed))
