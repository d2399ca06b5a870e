# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A design as files: the proposed scene, one page with picture and table, and all of it as JSON."""

import json
import textwrap
from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from ..plots.html_page import figure, html_page, html_table
from ..plots.proposed_experiment import ProposedRun, plot_experiment
from ..runs.receipt import versions
from ..runs.wording import quantity
from .experiments import CRITERIA, Design, Experiment

EXPERIMENT_SCENE, EXPERIMENT_PAGE, _VALUES, _PICTURE = 'experiment.yaml', 'report.html', 'report.json', 'experiment'
_ONE_PERCENT = 0.01


def write_design(design: Design, folder: Path) -> None:
    """Write a design into a folder that exists; raises OSError when the disk refuses."""
    (folder / EXPERIMENT_SCENE).write_text(scene_file(design), encoding='utf-8')
    best = design.best
    changes = {name: values * _ONE_PERCENT for name, values in zip(design.wishes.parameters,
                                                                   best.slopes.by_channel['position'])}
    samples = best.slopes.samples
    kinds = design.best_of_kinds
    plot_experiment(ProposedRun(best.slopes.times, samples['drive_velocity'], samples['position']), changes,
                    [one.feed.name for one in kinds], np.array([one.deviations for one in kinds]),
                    design.wishes.known, folder / f'{_PICTURE}.svg', folder / f'{_PICTURE}.png')
    (folder / _VALUES).write_text(json.dumps(as_values(design), indent=1, allow_nan=False) + '\n', encoding='utf-8')
    (folder / EXPERIMENT_PAGE).write_text(_page(design, folder), encoding='utf-8')


def scene_file(design: Design) -> str:
    """Return the proposed scene as a file that runs."""
    wishes = design.wishes
    lines = textwrap.wrap(f'{design.best.feed.name}: {wishes.duration:g} s of it would narrow '
                          f'{", ".join(wishes.parameters)} most.', 110)
    return ''.join(f'# {line}\n' for line in lines) + design.best.feed.scene(design.scene).text


def table_rows(experiments: Sequence[Experiment]) -> Iterator[list[str]]:
    """Yield a row for each experiment: feed, criterion, the deviation of each parameter, the way of the drive."""
    for one in experiments:
        yield [one.feed.name, _percent(one.score), *map(_percent, one.deviations), quantity(one.travel, 'm', 3)]


def table_heads(design: Design) -> list[str]:
    """Return the heads of these rows."""
    return ['feed', f'{design.wishes.criterion}-optimal', *design.wishes.parameters, 'travel']


def conditions(design: Design) -> Iterator[str]:
    """Yield what limits the figures."""
    wishes, best = design.wishes, design.best
    sensors = wishes.sensors
    force = '' if sensors.force_noise is None else f' and drive force to {quantity(sensors.force_noise, "N", 3)}'
    yield (f'measured {sensors.rate:g} times a second for {wishes.duration:g} s: position to '
           f'{quantity(sensors.deviations["position"], "m", 3)}{force}')
    yield (f'each parameter is known to {_percent(wishes.known)} before, and scatters by {_percent(wishes.scatter)} '
           'from slip to slip; what is left are standard deviations, and the best feed is that of the least '
           + CRITERIA[wishes.criterion])
    if best.slopes.until < wishes.duration:
        yield (f'of the best feed the first {best.slopes.until:.4g} s count: then the sequence of events changes '
               'within a step of the differences')
    for feed, reason in design.left_out:
        yield f'left out: {feed.name}: {reason}'


def as_values(design: Design) -> dict[str, Any]:
    """Return a design as JSON values."""
    wishes, sensors = design.wishes, design.wishes.sensors
    return {
        'scene': design.scene.name, 'scene_hash': design.scene.hash, 'versions': versions(),
        'parameters': list(wishes.parameters), 'duration': wishes.duration, 'speeds': list(wishes.speeds),
        'known': wishes.known, 'scatter': wishes.scatter, 'criterion': wishes.criterion,
        'sensors': {'rate': sensors.rate, 'resolution': sensors.resolution, 'noise': sensors.noise,
                    'force_noise': sensors.force_noise},
        'experiments': [{'feed': one.feed.name, 'kind': one.feed.kind, 'drive': one.feed.drive, 'score': one.score,
                         'deviations': one.deviations.tolist(), 'covariance': one.covariance.tolist(),
                         'travel': one.travel} for one in design.experiments],
        'left_out': [{'feed': feed.name, 'reason': reason} for feed, reason in design.left_out],
        'notes': list(conditions(design)),
    }


def _page(design: Design, folder: Path) -> str:
    best = design.best
    title = f'{design.scene.name}: the experiment for {", ".join(design.wishes.parameters)}'
    caption = (f'{best.feed.name}: (a) the feed, (b) the motion, (c) how far the position moves for one percent of '
               'each parameter, (d) what the best feed of each kind would leave of each deviation.')
    return html_page(title, [
        f'<h1>{escape(title)}</h1>', *(f'<p>{escape(text)}.</p>' for text in conditions(design)),
        figure(folder / f'{_PICTURE}.svg', caption),
        html_table('Feeds, the best first', table_heads(design), table_rows(design.experiments))])


def _percent(share: float) -> str:
    return f'{100.0 * share:.3g} %'
