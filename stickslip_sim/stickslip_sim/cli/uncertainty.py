# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip uncertainty`: the spread of the motion of a scene with parameters that are known only roughly."""

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import click

from . import completion
from .files import check_picture, whole, write_text
from .scene_changes import SceneChanges
from .sweeping import carry_out, print_failed, study_options, workers_of

if TYPE_CHECKING:
    from ..study import Saltelli, Study
    from ..study.table import Columns
    from ..study.uncertainty import Index, Uncertainty

Labels = Mapping[str, str]   # how parameters are printed, by name
_RESULT = 'uncertainty.json'


@click.command(short_help='Run a scene with parameters that are known only roughly.')
@click.argument('scene', metavar='SCENE', shell_complete=completion.complete_scenes)
@click.option('--with', 'file', required=True, metavar='FILE.yaml', help='The distributions of its parameters.')
@click.option('--samples', type=int, default=1024, show_default=True, metavar='N',
              help='A power of two; N (parameters + 2) points are run.')
@click.option('--plot', metavar='FILE.png', help='Draw the spread of the figures and the indices (.png, .pdf or .svg).')
@study_options
def uncertainty(scene: str, file: str, samples: int, plot: str | None, out: str, duration: float | None,
                workers: str | None, scheduler: str | None, resume: bool, changes: SceneChanges) -> None:
    """Run SCENE with parameters drawn from distributions: percentiles, and which parameter decides.

    FOLDER gets uncertainty.json beside the table of all points.  Ctrl-C keeps the finished points.
    """
    if plot is not None:
        check_picture('--plot', plot)
    members = workers_of(workers, scheduler)
    from ..study import Saltelli, Study
    from ..study.uncertain_file import load_uncertain
    from ..study.uncertainty import uncertainty_of
    from ..study.variation import with_place

    known = load_uncertain(file)
    sample = Saltelli(known.distributions, samples, known.seed)
    loaded = changes.load(scene)
    study = Study(loaded.values, sample, duration)
    folder, swept = carry_out(study, out, members, resume)
    found = uncertainty_of(sample, swept.columns)
    result = folder.path / _RESULT
    write_text(str(result), [json.dumps(_plain(sample, found), indent=1, allow_nan=False), '\n'])
    if plot is not None:
        _draw(study, sample, swept.columns, found, plot)
    print(f'{loaded.name}: {samples} samples of {len(study.names)} parameters, {study.count} points, '
          f'{swept.ran} run now')
    print_failed(study, swept.columns)
    labels = {name: with_place(loaded.values, name) for name in study.names}
    print('\n'.join((*_laws(sample, labels), '', *_percentiles(found), '', *_indices(sample, labels, found), '',
                     str(result))))


def _draw(study: 'Study', sample: 'Saltelli', columns: 'Columns', found: 'Uncertainty', path: str) -> None:
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


def _laws(sample: 'Saltelli', labels: Labels) -> list[str]:
    """Return a line for each parameter: its distribution, and the share that was cut off."""
    from ..study.distribution import LAWS

    lines = []
    for one in sample.variations:
        numbers = ', '.join(f'{name} {number:g}' for name, number in zip(LAWS[one.law].numbers, one.numbers))
        cut = f', cut to {one.low:g} .. {one.high:g} ({1.0 - one.kept:.2g} off)' if LAWS[one.law].ends else ''
        unit = f' ({one.unit})' if one.unit else ''
        lines.append(f'  {labels[one.name]}{unit}: {one.law}, {numbers}{cut}')
    return lines


def _percentiles(found: 'Uncertainty') -> list[str]:
    from ..runs.wording import quantities
    from ..study.uncertainty import PERCENTS, SPREAD

    doubts = ((found.failed, 'failed'), (found.undecided, 'undecided'),
              (found.unsettled, 'had not settled'))
    doubt = ''.join(f', {count} {what}' for count, what in doubts if count)
    head = f'{"of those":22}' + ''.join(f'{f"{percent} %":>13}' for percent in PERCENTS)
    share = 'a share that is not known' if found.stick_slip is None else f'{found.stick_slip:.2%}'
    points = f'{found.points} independent points'
    known = points if found.known == found.points else f'those {found.known} of {points} where it is known'
    return [f'stick-slip in {share} of {known}{doubt}', head,
            *(f'{name:22}' + ''.join(f'{text:>13}' for text in quantities(values, SPREAD[name], 4))
              if values else f'{name:22}{"none":>13}' for name, values in found.percentiles.items())]


def _indices(sample: 'Saltelli', labels: Labels, found: 'Uncertainty') -> list[str]:
    """Return a table of the first-order indices, a line for each figure that has them."""
    names = [one.name for one in sample.variations]
    width = max(22, *map(len, labels.values())) + 2
    lines = ['share of the variance that one parameter explains by itself (and with its interactions)']
    for figure, of in found.indices.items():
        if of is None:
            lines.append(f'{figure:22} none: not every point has it, or all have the same')
            continue
        lines.append(figure)
        lines += [f'  {labels[name]:{width}}{_cell(of[name])}'
                  for name in sorted(names, key=lambda n: -of[n].first_order)]
    return lines


def _cell(index: 'Index') -> str:
    return f'{index.first_order:6.3f} ± {index.error:.3f}  ({index.total:.3f} ± {index.total_error:.3f})'
