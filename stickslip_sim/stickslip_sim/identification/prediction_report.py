# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Predictions of runs as they are said: a table and a picture for each, and values for JSON."""

import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ..figures.catalogue import in_words
from ..plots.identified_motion import PredictedChannel, plot_prediction
from ..report.html import write_page
from ..report.model import NOTE, OTHER, Part, Picture, Section, Sentence, Table
from ..report.quantity import quantity
from ..report.values import versions
from .identified import ChannelFit, Prediction
from .identified_scene import number_words

CAPTION = ('To the left the predicted motion (thin) over the measured one (thick, grey), to the right measured less '
           'predicted.')
_WHAT = 'RMSE', 'fit', 'largest error', 'RMSE / σ'


def prediction_parts(prediction: Prediction, name: str) -> list[Part]:
    """Return a prediction for people, under the name of its run."""
    rows = [(in_words(one.name), quantity(one.rmse, one.unit, 4), _percent(one.fit_percent),
             quantity(one.largest, one.unit, 4), _noises(one)) for one in prediction.channels]
    if not math.isnan(prediction.stretch_fit):
        rows.append(('stretch of the spring', '', _percent(prediction.stretch_fit), '', ''))
    found = ', '.join(f'{one.name} {number_words(one.value, one.unit)}' for one in prediction.found)
    return [Section(f'{prediction.scene.name} predicts {name}:', [
        Table(('', *_WHAT), rows), f'found on it, and nothing else: {found}',
        *(Sentence(note, NOTE) for note in prediction.notes)])]


def write_predictions(predictions: Mapping[str, Prediction], folder: Path) -> None:
    """Write report.html and report.json of predictions, by the names of runs, and a picture of each, into a folder."""
    scene = next(iter(predictions.values())).scene
    parts: list[Part] = []
    for name, one in predictions.items():
        draw_prediction(one, folder / f'{name}.svg')
        parts += [*prediction_parts(one, name), Picture(folder / f'{name}.svg', CAPTION)]
    own = versions()
    parts.append(Sentence(', '.join(f'{name} {version}' for name, version in own.items()), OTHER))
    write_page(folder, f'{scene.name} predicts {", ".join(predictions)}', parts,
               {'versions': own, 'scene': scene.name, 'scene_hash': scene.hash,
                'predictions': prediction_values(predictions.values())})


def draw_prediction(prediction: Prediction, path: Path) -> None:
    """Draw the channels of a prediction, measured and predicted, and what is left."""
    plot_prediction([PredictedChannel(one.name, one.unit, one.times, one.measured, one.fitted)
                     for one in prediction.channels], path)


def prediction_values(predictions: Iterable[Prediction]) -> list[dict[str, Any]]:
    """Return predictions as values for JSON, SI."""
    return [{'run': one.run, 'channels': [_values(channel) for channel in one.channels],
             'stretch_fit_percent': _number(one.stretch_fit), 'found': one.found, 'notes': one.notes}
            for one in predictions]


def _values(channel: ChannelFit) -> dict[str, Any]:
    return {'name': channel.name, 'unit': channel.unit, 'readings': len(channel.times),
            'begin': float(channel.times[0]), 'end': float(channel.times[-1]), 'rmse': channel.rmse,
            'fit_percent': _number(channel.fit_percent), 'largest': channel.largest,
            'resolution': _number(channel.resolution)}


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _percent(value: float) -> str:
    return 'undefined' if math.isnan(value) else f'{value:.4g} %'


def _noises(channel: ChannelFit) -> str:
    return f'{channel.rmse / channel.resolution:.3g}' if math.isfinite(channel.resolution) else '–'
