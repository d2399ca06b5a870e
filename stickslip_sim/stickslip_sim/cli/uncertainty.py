# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip uncertainty`: the spread of the motion of a scene with parameters that are known only roughly."""

import json
from typing import TYPE_CHECKING, Any

import click

from . import completion
from .count_words import counted
from .files import check_picture, say_written, whole, write_text
from .scene_changes import SceneChanges
from .sweeping import carry_out, print_failed, study_options, workers_of
from .uncertainty_lines import index_lines, law_lines, percent_head

if TYPE_CHECKING:
    from ..study import Saltelli, Study
    from ..study.table import TableColumns
    from ..study.uncertainty import Uncertainty

_RESULT = 'uncertainty.json'


@click.command(short_help='Run a scene with parameters that are known only roughly.')
@click.argument('scene', metavar='SCENE', shell_complete=completion.complete_scenes)
@click.option('--with', 'file', required=True, metavar='FILE.yaml', help='The distributions of its parameters.')
@click.option('--of', 'critical', metavar='A.B', help='Find how the critical value of this parameter spreads.')
@click.option('--between', metavar='LOW:HIGH', help='With --of: where to look [default: 1/100 to 100 times its value].')
@click.option('--samples', type=int, default=1024, show_default=True, metavar='N',
              help='A power of two; N (parameters + 2) points are run, 2 N of correlated ones.')
@click.option('--plot', metavar='FILE.png', help='Draw the spread of the figures and the indices (.png, .pdf or .svg).')
@study_options
def uncertainty(scene: str, file: str, critical: str | None, between: str | None, samples: int, plot: str | None,
                out: str, duration: float | None, workers: str | None, scheduler: str | None, resume: bool,
                changes: SceneChanges) -> None:
    """Run SCENE with parameters drawn from distributions: percentiles, and which parameter decides.

    FOLDER gets uncertainty.json beside the table of all points.  Ctrl-C keeps the finished points.  With --of it is the
    critical value of a parameter that spreads, as of the feed; then it is done in one go.
    """
    _check_options(critical, between, duration, resume)
    if plot is not None:
        check_picture('--plot', plot)
    members = workers_of(workers, scheduler)
    from ..scene.load import named
    from ..study import Saltelli, Study
    from ..study.critical_sample import CriticalStudy
    from ..study.uncertain_file import load_uncertain
    from ..study.uncertainty import uncertainty_of
    from ..study.variation import with_place
    from .critical import range_given
    from .critical_spread import spread_critical

    known = load_uncertain(file)
    with named(file):
        changes.check_ranges(known.distributions)
    sample = Saltelli(known.distributions, samples, known.seed, known.correlations)
    loaded = changes.load(scene)
    study = Study(loaded.values, sample, duration)
    labels = {name: with_place(loaded.values, name) for name in study.names}
    if critical is not None:
        over = range_given(loaded, critical, between, changes)
        spread_critical(CriticalStudy(study, over), sample, labels, out, plot, members)
        return
    folder, swept = carry_out(study, out, members, resume)
    found = uncertainty_of(sample, swept.columns)
    result = folder.path / _RESULT
    write_text(str(result), [json.dumps(_plain(sample, found), indent=1, allow_nan=False), '\n'])
    if plot is not None:
        _draw(study, sample, swept.columns, found, plot)
    print(f'{loaded.name}: {samples} samples of {counted(len(study.names), "parameter")}, {study.count} points, '
          f'{swept.ran} run now')
    print_failed(study, swept.columns)
    print('\n'.join((*law_lines(sample, labels), '', *_percentiles(found), '',
                     *index_lines(sample, labels, found.indices), '')))
    say_written(str(result), plot)


def _check_options(critical: str | None, between: str | None, duration: float | None, resume: bool) -> None:
    """Raise UsageError on options that do not go together."""
    if critical is None and between is not None:
        raise click.UsageError('--between is where to look for a critical value: give --of A.B too.')
    if critical is not None and (duration is not None or resume):
        raise click.UsageError('--of runs each point until its motion settles, in one go: no --duration, no --resume.')


def _draw(study: 'Study', sample: 'Saltelli', columns: 'TableColumns', found: 'Uncertainty', path: str) -> None:
    from ..study.pictures import draw_uncertainty

    with whole(path) as temporary:
        draw_uncertainty(study, sample, columns, found, str(temporary))


def _plain(sample: 'Saltelli', found: 'Uncertainty') -> dict[str, Any]:
    """Return all that was found as JSON values."""
    from ..study.uncertainty import PERCENTS

    return {
        'samples': sample.samples, 'seed': sample.seed, 'points': found.points, 'known': found.known,
        'failed': found.failed, 'undecided': found.undecided, 'unsettled': found.unsettled,
        'kept_of_distributions': {one.name: one.kept for one in sample.variations},
        'stick_slip': found.stick_slip,
        'percentiles': {name: values and {str(percent): value for percent, value in zip(PERCENTS, values)}
                        for name, values in found.percentiles.items()},
        'indices': {name: of and {key: index._asdict() for key, index in of.items()}
                    for name, of in found.indices.items()},
    }


def _percentiles(found: 'Uncertainty') -> list[str]:
    from ..runs.wording import quantities
    from ..study.uncertainty import SPREAD

    doubts = ((found.failed, 'failed'), (found.undecided, 'undecided'),
              (found.unsettled, 'had not settled'))
    doubt = ''.join(f', {count} {what}' for count, what in doubts if count)
    head = percent_head('of those')
    share = 'a share that is not known' if found.stick_slip is None else f'{found.stick_slip:.2%}'
    points = f'{found.points} independent points'
    known = points if found.known == found.points else f'those {found.known} of {points} where it is known'
    return [f'stick-slip in {share} of {known}{doubt}', head,
            *(f'{name:22}' + ''.join(f'{text:>13}' for text in quantities(values, SPREAD[name], 4))
              if values else f'{name:22}{"none":>13}' for name, values in found.percentiles.items())]
