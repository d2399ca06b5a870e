# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip uncertainty`: the spread of the motion of a scene with parameters that are known only roughly."""

from pathlib import Path

import click

from .arguments import Members, SceneChanges, check_usage, command_line, scene_argument, study_options, verb
from .critical import range_given
from .files import PICTURE, check_new_folder, new_folder, progress_bar, say_written, show, whole, write_json, write_text

_RESULT = 'uncertainty.json'


@verb(short_help='Propagate uncertain parameters through a scene.')
@scene_argument
@click.option('--with', 'file', required=True, metavar='FILE.yaml', help='Distributions of the parameters.')
@click.option('--of', 'critical', metavar='A.B', help='Find the spread of the critical value of this parameter.')
@click.option('--between', metavar='LOW:HIGH', help='With --of: search range [default: 1/100 to 100 times its value].')
@click.option('--samples', type=int, default=1024, show_default=True, metavar='N',
              help='A power of two; runs N (parameters + 2) points, or 2 N if they are correlated.')
@click.option('--plot', type=PICTURE, metavar='FILE.png',
              help='Plot the spread of the figures and the indices (.png, .pdf or .svg).')
@study_options
def uncertainty(scene: str, file: str, critical: str | None, between: str | None, samples: int, plot: str | None,
                out: str, duration: float | None, members: Members, resume: bool, changes: SceneChanges) -> None:
    """Run SCENE with parameters drawn from distributions; report percentiles and sensitivity indices.

    FOLDER receives uncertainty.json and a table of all points.  Ctrl-C keeps the finished points.  With --of, the
    result is the spread of a critical value, such as the critical feed; such a study cannot be resumed.
    """
    check_usage((critical is None and between is not None, '--between needs --of A.B.'),
                (critical is not None and (duration is not None or resume),
                 '--of does not take --duration or --resume: each point runs until its motion settles.'))
    from ..scene.load import named
    from ..study import Saltelli, Study, report
    from ..study import critical as values_of
    from ..study.folder import Folder
    from ..study.sweep import carry_out
    from ..study.uncertainty import load_uncertain, uncertainty_of

    known = load_uncertain(file)
    with named(file):
        changes.check_ranges(known.distributions)
    sample = Saltelli(known.distributions, samples, known.seed, known.correlations)
    loaded = changes.load(scene)
    study = Study(loaded.values, sample, duration)
    result = str(Path(out) / _RESULT)
    if critical is None:
        with progress_bar('sweeping') as progress:
            swept = carry_out(study, Folder(out), members, resume, command_line(), progress)
        found = uncertainty_of(sample, swept.columns)
        write_json(result, report.uncertainty_values(sample, found), 1)
        said = report.uncertainty_report(study, sample, swept, found)
    else:
        spread = values_of.CriticalStudy(study, range_given(loaded, critical, between, changes))
        check_new_folder('--out', out)
        with members as workers, progress_bar('narrowing') as progress:
            values = values_of.critical_values(spread, workers, progress)
        spreads = values_of.spreads_of(sample, values)
        with new_folder('--out', out) as folder:
            write_text(str(folder / 'critical.csv'), report.critical_lines(spread, values))
            write_json(str(folder / _RESULT), report.spread_values(spread, sample, spreads), 1)
        said = report.spread_report(spread, sample, spreads)
    if plot is not None:
        from ..study.diagrams import draw_critical_spread, draw_uncertainty  # matplotlib takes half a second
        with whole(plot) as temporary:
            if critical is None:
                draw_uncertainty(study, sample, swept.columns, found, str(temporary))
            else:
                draw_critical_spread(spread, spreads, str(temporary))
    show(said)
    say_written(result, plot)
