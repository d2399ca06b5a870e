# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A design for people, and as files: the proposed scene, one page with picture and table, and all of it as JSON."""

import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..report.html import write_page
from ..report.model import Part, Picture, Table
from ..report.quantity import quantity
from ..report.values import versions
from .experiments import CRITERIA, Design

EXPERIMENT_SCENE, EXPERIMENT_PAGE, _PICTURE = 'experiment.yaml', 'report.html', 'experiment'
_SHOWN = 10   # feeds, on a terminal
_ONE_PERCENT = 0.01


def design_report(design: Design) -> Iterator[Part]:
    """Yield the best feeds, and what limits the figures."""
    feeds, more = feed_table(design), len(design.experiments) - _SHOWN
    yield feeds._replace(rows=feeds.rows[:_SHOWN])
    if more > 0:
        yield f'and {more} more'
    yield from conditions(design)


def write_design(design: Design, folder: Path) -> None:
    """Write a design into a folder that exists; raises OSError when the disk refuses."""
    from ..plots.proposed_experiment import ProposedRun, plot_experiment  # matplotlib takes half a second

    (folder / EXPERIMENT_SCENE).write_text(scene_file(design), encoding='utf-8')
    best, kinds, parameters = design.best, design.best_of_kinds, design.wishes.parameters
    changes = {name: values * _ONE_PERCENT for name, values in zip(parameters, best.slopes.by_channel['position'])}
    samples, picture = best.slopes.samples, folder / f'{_PICTURE}.svg'
    plot_experiment(ProposedRun(best.slopes.times, samples['drive_velocity'], samples['position']), changes,
                    [one.feed.name for one in kinds], np.array([one.deviations for one in kinds]),
                    design.wishes.known, picture, folder / f'{_PICTURE}.png')
    caption = (f'{best.feed.name}: (a) the feed, (b) the motion, (c) how far the position moves for one percent of '
               'each parameter, (d) what the best feed of each kind would leave of each deviation.')
    write_page(folder, f'{design.scene.name}: the experiment for {", ".join(parameters)}', [
        *(f'{text}.' for text in conditions(design)), Picture(picture, caption),
        feed_table(design)._replace(caption='Feeds, the best first')], as_values(design))


def scene_file(design: Design) -> str:
    """Return the proposed scene as a file that runs."""
    wishes = design.wishes
    lines = textwrap.wrap(f'{design.best.feed.name}: {wishes.duration:g} s of it would narrow '
                          f'{", ".join(wishes.parameters)} most.', 110)
    return ''.join(f'# {line}\n' for line in lines) + design.best.feed.scene(design.scene).text


def feed_table(design: Design) -> Table:
    """Return the feeds: the criterion, the deviation of each parameter, the way of the drive."""
    return Table(('feed', f'{design.wishes.criterion}-optimal', *design.wishes.parameters, 'travel'), [
        (one.feed.name, _percent(one.score), *map(_percent, one.deviations), quantity(one.travel, 'm', 3))
        for one in design.experiments])


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
    """Return all of a design."""
    wishes = design.wishes
    return {
        'scene': design.scene.name, 'scene_hash': design.scene.hash, 'versions': versions(),
        'parameters': wishes.parameters, 'duration': wishes.duration, 'speeds': wishes.speeds,
        'known': wishes.known, 'scatter': wishes.scatter, 'criterion': wishes.criterion, 'sensors': wishes.sensors,
        'experiments': [{'feed': one.feed.name, 'kind': one.feed.kind, 'drive': one.feed.drive, 'score': one.score,
                         'deviations': one.deviations, 'covariance': one.covariance, 'travel': one.travel}
                        for one in design.experiments],
        'left_out': [{'feed': feed.name, 'reason': reason} for feed, reason in design.left_out],
        'notes': [*conditions(design)],
    }


def _percent(share: float) -> str:
    return f'{100.0 * share:.3g} %'
