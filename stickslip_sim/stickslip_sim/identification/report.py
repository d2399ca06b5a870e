# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What an identification found, or a scene predicts, as it is said: lines, one HTML page, values, and a folder."""

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..figures.catalogue import in_words
from ..plots.characteristics import Band, KnownFriction, plot_known_friction
from ..plots.identified_motion import (
    FittedChannel,
    PredictedChannel,
    plot_correlations,
    plot_fit,
    plot_prediction,
    plot_residuals,
)
from ..report.html import figure, folded, html_of, html_page, html_table, write_page
from ..report.model import NOTE, OTHER, Part, Picture, Section, Sentence, Table
from ..report.quantity import quantity
from ..report.text import text_lines
from ..report.values import plain, versions
from ..runs import Run
from .identified import FOUND, LEVEL, VOID, ChannelFit, Estimate, Identification, LawFit, Misfit, Prediction, StartEnd
from .identified_scene import (
    IDENTIFIED_SCENE,
    OF_SENSORS,
    identified_text,
    input_texts,
    interval_words,
    number_words,
    posterior_text,
)
from .measured_friction import known_friction, phases, slip_share, usual_cycles

_CAPTIONS = {
    'fit': 'Fitted motion (thin) over the measured one (thick, grey): the whole run, and two cycles of it (shaded).  '
           'Where single slips were fitted, or a force drives the slider by itself, each motion starts at a measured '
           'arrest, marked below, and predicts only that one.  The free run (dashed) is the model on its own from the '
           'start.',
    'residuals': 'Residuals in standard deviations of the sensor, over time and over the phase of the cycle between '
                 'break-aways.  A pattern shows a deficiency of the model.  Red: a test rejects the model there.',
    'friction': 'Identified friction with its 95 % band, and the friction measured within slips: force on the slider '
                'minus inertia, (a) over speed, (b) over rest time.  Friction that depends on the direction has one '
                'row per direction.',
    'correlations': 'Correlations of the errors: near 1 or −1 the run determines only a combination of two numbers.',
}
_SHOWN = 3   # misfits, above the fold
_ORDER = ('fit', 'residuals', 'friction')
_NAME, _NUMBER = 36, 14   # columns of the terminal
_BETTER = 10.0      # of the criterion: laws so far below are better (Kass and Raftery 1995: very strong evidence)
_ELSEWHERE = 1.01   # times the least sum of squares: a search that ended above it ended elsewhere
IDENTIFIED_VALUES = 'report.json'


class _Pairs(NamedTuple):
    """A figure of the slips that both motions have, (n, 2): measured and fitted."""

    words: str
    unit: str
    both: Numbers


def result_lines(found: Identification, run: str) -> Iterator[str]:
    """Yield what was found: the parameters, what they cannot tell, laws and starts."""
    channels = ' and '.join(one.name for one in found.channels)
    yield (f'{run}: {found.scene.name} from {channels}, {found.n_residuals} residuals, {found.runs} simulations in '
           f'{found.seconds:.3g} s')
    yield from (f'  note: {note}' for note in found.notes)
    yield f'{"":{_NAME}}{"start":>{_NUMBER}}{"found":>{_NUMBER}}   95 % interval'
    for one in found.estimates:
        start, value = _ends(one)
        kind = '' if one.kind in (FOUND, VOID) else f', {one.kind}'
        yield f'{one.name:{_NAME}}{start:>{_NUMBER}}{value:>{_NUMBER}}   {interval_words(one)}{kind}'
    yield from (f'not separated: {together.statement}' for together in found.combinations)
    yield from found.disagreements
    yield from _own_lines(found)
    yield from _slip_lines(found)
    yield from _law_lines(found)
    yield from text_lines(part for one in found.predictions for part in prediction_parts(one, one.run))
    elsewhere = sum(one.cost > _ELSEWHERE * _starts(found)[0].cost for one in found.starts)
    if elsewhere:
        yield (f'{elsewhere} of {len(found.starts)} starts ended elsewhere, with a larger sum of squares: report.html '
               'has them')
    yield 'the model fits: no test of the residuals rejects it' if found.fits else 'THE MODEL DOES NOT FIT this run:'
    firsts = _firsts(found.misfits)
    yield from (f'  {one.statement}' for one in firsts)
    if len(found.misfits) > len(firsts):
        yield f'  and {len(found.misfits) - len(firsts)} more, in report.html'


def _slip_lines(found: Identification) -> Iterator[str]:
    """Yield how far slips are apart, in the median and at most, as shares of what was measured."""
    apart = []
    for words, _, both in _paired(found, ('break_away_force', 'stick_time')):
        both = both[both[:, 0] != 0.0]
        if len(both):
            off = 100.0 * np.abs(both[:, 1] / both[:, 0] - 1.0)
            apart.append(f'{words} {np.median(off):.2g} and {off.max():.2g} %')
    if apart:
        yield f'{len(found.slips)} slips, fitted beside measured, apart in the median and at most: {", ".join(apart)}'


def _law_lines(found: Identification) -> Iterator[str]:
    """Yield which laws are better by far than those of the scene; that none is, where others were tried."""
    if len(found.laws) < 2:
        return
    taken = next(one for one in found.laws if one.is_chosen)
    better = [one for one in _laws(found) if taken.criterion - one.criterion > _BETTER]
    for one in better:
        yield (f'better laws: {one.static} with {one.kinetic}, {found.criterion} '
               f'{taken.criterion - one.criterion:.4g} below {taken.static} with {taken.kinetic}')
    if not better:
        yield (f'none of {len(found.laws) - 1} other laws is better by more than {_BETTER:g} of {found.criterion} than '
               f'{taken.static} with {taken.kinetic}')


def report_page(found: Identification, run: str, start: str, pictures: Mapping[str, str], versions: Mapping[str, str]
                ) -> str:
    """Return the page; `pictures` are parts of HTML by the names that `caption` takes."""
    title = f'{found.scene.name}, identified from {run}'
    body = [f'<h1>{escape(title)}</h1>', _verdict(found), *_facts(found, run, start), _estimate_table(found.estimates),
            *_alone(found), *_open(found), *(pictures[name] for name in _ORDER), _channel_table(found),
            _slip_table(found),
            *(html_of(part) + pictures[f'prediction_{k}'] for k, one in enumerate(found.predictions)
              for part in prediction_parts(one, one.run)),
            pictures['correlations'], *_law_table(found), *_start_table(found)]
    body.append(f'<p class="other">{escape(", ".join(f"{name} {version}" for name, version in versions.items()))}</p>')
    return html_page(title, body)


def caption(name: str) -> str:
    """Return the text below a picture."""
    return _CAPTIONS.get(name, PREDICTED)


def _verdict(found: Identification) -> str:
    if found.fits:
        return '<p class="holds">✓ The model fits: no test of the residuals rejects it.</p>'
    rows = ''.join(f'<li>{escape(one.statement)}</li>' for one in _foremost(found.misfits))
    return ('<p class="fails">✗ The model does not fit this run.  Its numbers are the best it can do; their '
            f'intervals are void.</p><ul>{rows}</ul>{_all_tests(found.misfits)}')


def _all_tests(misfits: Sequence[Misfit]) -> str:
    rows = [[one.statement, one.test, f'{one.statistic:.4g}', f'{one.limit:.4g}', f'{one.from_time:.6g}',
             f'{one.to_time:.6g}'] for one in misfits]
    table = html_table('Tests of the residuals that reject the model', [
        '', 'test', 'statistic', 'limit', 'from / s', 'to / s'], rows)
    return folded(f'all tests that reject the model: {len(misfits)}', table)


def _facts(found: Identification, run: str, start: str) -> Iterator[str]:
    channels = ' and '.join(one.name.replace('_', ' ') for one in found.channels)
    yield (f'<p>From {escape(channels)} of {escape(run)}, with {escape(start)} to begin with: '
           f'{len(found.estimates)} parameters, {found.n_residuals} residuals with a sum of squares of '
           f'{found.cost:.6g}, {found.runs} simulations in {found.seconds:.3g} s.</p>')
    for note in found.notes:
        yield f'<p class="note">{escape(note)}</p>'


def _estimate_table(estimates: Sequence[Estimate]) -> str:
    rows = [[one.name, *_ends(one), f'{100.0 * (one.value / one.start - 1.0):+.2f} %' if one.start else '–',
             interval_words(one), 'profile' if one.profile else 'covariance', one.kind, one.derivation]
            for one in estimates]
    return html_table('Parameters: initial value, result and 95 % interval', [
        '', 'start', 'value', 'change', 'interval', 'interval by', 'kind', 'from'], rows)


def _alone(found: Identification) -> Iterator[str]:
    """Yield what each of several runs says by itself, and where they disagree."""
    if found.alone:
        names = [one.name for one in found.alone[0].estimates if one.name in found.values]
        by_name = [{one.name: one for one in run.estimates} for run in found.alone]
        rows = [[name, *(f'{number_words(own[name].value, own[name].unit)} ({interval_words(own[name])})'
                         if name in own else '–' for own in by_name)] for name in names]
        rows.append(['fits alone', *('yes' if run.fits else 'no' for run in found.alone)])
        yield html_table('Each run on its own', ['', *(run.run for run in found.alone)], rows)
        yield from (f'<p class="fails">{escape(one)}</p>' for one in found.disagreements)
        yield from (f'<p>{escape(one)}</p>' for one in _own_lines(found))


def _own_lines(found: Identification) -> Iterator[str]:
    """Yield the numbers of the scene that each run has of its own in the fit of all."""
    for one in found.estimates if found.alone else ():
        if one.name in found.alone[0].own and not one.name.startswith(('sensor.', 'initial.')):
            yield f'{one.name}: ' + ', '.join(f'{number_words(run.own[one.name], one.unit)} in {run.run}'
                                              for run in found.alone)


def _open(found: Identification) -> Iterator[str]:
    if found.combinations:
        rows = ''.join(f'<li>{escape(one.statement)}</li>' for one in found.combinations)
        yield f'<h2>What this run cannot tell apart</h2><ul>{rows}</ul>'


def _channel_table(found: Identification) -> str:
    rows = [[one.name, str(len(one.times)), *(quantity(size, one.unit) for size in (one.resolution, *_left(one)))]
            for one in found.channels]
    return html_table('Residuals of each channel', ['', 'readings', 'σ of the sensor', 'rms residual', 'largest'],
                      rows)


def _slip_table(found: Identification) -> str:
    """Return how far the slips are apart, in the median and at worst."""
    rows = []
    for words, unit, both in _paired(found, ('time', 'stick_time', 'break_away_force')):
        if len(both):
            apart = np.abs(both[:, 0] - both[:, 1])
            rows.append([words, str(len(both)), '–' if words == 'break-away' else
                         quantity(float(np.median(both[:, 0])), unit),
                         *(quantity(float(size), unit) for size in (np.median(apart), apart.max()))])
    if not rows:
        return '<p>No slip was measured.</p>'
    missing = sum(not (math.isfinite(slip.time) and math.isfinite(slip.fitted_time)) for slip in found.slips)
    note = f'<p class="note">{missing} of {len(found.slips)} slips occur in only one of the two motions.</p>'
    return html_table('Slips, measured and fitted', ['', 'pairs', 'measured, median', 'difference, median', 'largest'],
                      rows) + note * bool(missing)


def _law_table(found: Identification) -> Iterator[str]:
    if found.laws:
        best, *_ = laws = _laws(found)
        rows = [[f'{one.static}, {one.kinetic}{_taken(one.is_chosen)}', str(one.n_parameters), f'{one.cost:.6g}',
                 f'{one.criterion:.6g}', f'{one.criterion - best.criterion:.4g}'] for one in laws]
        yield html_table(f'Laws, static and kinetic, by {found.criterion}: the lowest is best', [
            '', 'parameters', 'sum of squares', 'criterion', 'above best'], rows)


def _start_table(found: Identification) -> Iterator[str]:
    """Yield where the search from each start ended, if there were several."""
    if len(found.starts) > 1:
        best, *_ = starts = _starts(found)
        rows = [[f'{k}{_taken(one.is_best)}', f'{one.cost / best.cost if best.cost else one.cost:.4g}',
                 *(number_words(value, estimate.unit) for value, estimate in zip(one.end, found.estimates))]
                for k, one in enumerate(starts, 1)]
        yield html_table('Where the search from each start ended', [
            'start', 'sum of squares / best', *(one.name for one in found.estimates)], rows)


def _taken(is_it: bool) -> str:
    return ' (taken)' if is_it else ''


def _ends(one: Estimate) -> tuple[str, str]:
    """Return where the search of a number began, and what was found."""
    return number_words(one.start, one.unit), number_words(one.value, one.unit)


def _left(channel: ChannelFit) -> tuple[float, float]:
    """Return the root of the mean square of what is left of a channel, and the largest, in its unit."""
    residuals = channel.residuals
    return float(np.sqrt(np.mean(residuals**2))), float(np.abs(residuals).max())


def _paired(found: Identification, figures: Sequence[str]) -> Iterator[_Pairs]:
    """Yield figures of slips, of those that have both, by their names in `SlipFit`."""
    known = {'time': ('break-away', 's'), 'stick_time': ('time at rest before', 's'),
             'break_away_force': ('break-away force', 'N')}
    for of in figures:
        pairs = np.array([(getattr(slip, of), getattr(slip, f'fitted_{of}')) for slip in found.slips]).reshape(-1, 2)
        yield _Pairs(*known[of], pairs[np.isfinite(pairs).all(axis=1)])


def _laws(found: Identification) -> list[LawFit]:
    """Return the laws, the best first."""
    return sorted(found.laws, key=lambda one: one.criterion)


def _starts(found: Identification) -> list[StartEnd]:
    """Return where searches ended, the best first."""
    return sorted(found.starts, key=lambda one: one.cost)


def _firsts(misfits: Sequence[Misfit]) -> list[Misfit]:
    """Return the first misfit of each channel, which is that of the whole run."""
    channels = [one.channel for one in misfits]
    return [one for k, one in enumerate(misfits) if one.channel not in channels[:k]]


def _foremost(misfits: Sequence[Misfit]) -> list[Misfit]:
    """Return the misfits that matter most: the first of each channel, then those farthest off."""
    firsts = _firsts(misfits)
    others = sorted((one for one in misfits if not any(one is first for first in firsts)),
                    key=lambda one: one.statistic / one.limit if one.limit else math.inf, reverse=True)
    return [*firsts, *others][:_SHOWN]


def report_values(found: Identification, run: str, start: str, friction: Mapping[str, KnownFriction]
                  ) -> dict[str, Any]:
    """Return all that a report has, but for the readings themselves."""
    values: dict[str, Any] = _plain({
        'run': run, 'start': start, 'scene': found.scene.name, 'scene_hash': found.scene.hash, 'fits': found.fits,
        'level': LEVEL, 'estimates': [_estimate(one) for one in found.estimates],
        'correlation': found.correlation.tolist(), 'channels': [_channel(one) for one in found.channels],
        'misfits': [asdict(one) for one in found.misfits],
        'combinations': [asdict(one) for one in found.combinations], 'starts': [asdict(one) for one in found.starts],
        'criterion': found.criterion, 'laws': [asdict(one) for one in found.laws],
        'slips': [asdict(one) for one in found.slips], 'friction': _friction(next(iter(friction.values()))),
        'friction_backward': _friction(friction['backward']) if 'backward' in friction else None, 'cost': found.cost,
        'residuals': found.n_residuals, 'runs': found.runs, 'seconds': found.seconds, 'notes': list(found.notes),
        'restarts': list(found.restarts), 'predictions': plain(prediction_values(found.predictions)),
        'alone': [{'run': one.run, 'fits': one.fits, 'own': one.own, 'estimates': [*map(_estimate, one.estimates)]}
                  for one in found.alone],
        'disagreements': list(found.disagreements), 'versions': versions(),
    })
    return values


def sensor_errors(folder: Path) -> dict[str, float]:
    """Return what the report in a folder says of sensors, as `sensor.CHANNEL.offset`; nothing without a report.

    Raises InputError on one that is damaged.
    """
    path = folder / IDENTIFIED_VALUES
    if not path.is_file():
        return {}
    try:
        estimates = json.loads(path.read_text(encoding='utf-8'))['estimates']
        return {one['name']: float(one['value']) for one in estimates if one['name'].startswith(OF_SENSORS)}
    except (ValueError, LookupError, TypeError, AttributeError):
        raise InputError('report', str(path), 'as identify wrote it', 'run identify again, or remove it') from None


def _estimate(one: Estimate) -> dict[str, Any]:
    return {**asdict(one), 'relative_change': one.value / one.start - 1.0 if one.start else math.nan}


def _channel(one: ChannelFit) -> dict[str, Any]:
    rms, largest = _left(one)
    return {'name': one.name, 'unit': one.unit, 'readings': len(one.times), 'begin': float(one.times[0]),
            'end': float(one.times[-1]), 'resolution': one.resolution, 'correlation_time': one.correlation_time,
            'rms': rms, 'largest': largest}


def _friction(friction: KnownFriction) -> dict[str, Any]:
    bins = friction.bins
    return {
        'kinetic': _band('speed', friction.kinetic), 'static': _band('rest_time', friction.static),
        'accelerating': None if friction.accelerating is None else _band('speed', friction.accelerating),
        'measured': {'speed': bins.places.tolist(), 'median': bins.middles.tolist(),
                     'lower_quartile': bins.low.tolist(), 'upper_quartile': bins.high.tolist()},
        'break_aways': {'rest_time': friction.break_aways.places.tolist(),
                        'coefficient': friction.break_aways.values.tolist(), 'scatter': friction.scatter},
    }


def _band(over: str, band: Band) -> dict[str, Any]:
    return {over: band.places.tolist(), 'coefficient': band.values.tolist(), 'half_width': band.half.tolist()}


def _plain(value: Any) -> Any:
    """Return values without numbers that JSON has no word for."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    return value.item() if isinstance(value, np.generic) else value


# Predictions of runs: a table and a picture for each, and values.

PREDICTED = ('To the left the predicted motion (thin) over the measured one (thick, grey), to the right measured less '
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
        parts += [*prediction_parts(one, name), Picture(folder / f'{name}.svg', PREDICTED)]
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
    return [{'run': one.run, 'channels': [_channel_values(channel) for channel in one.channels],
             'stretch_fit_percent': _number(one.stretch_fit), 'found': one.found, 'notes': one.notes}
            for one in predictions]


def _channel_values(channel: ChannelFit) -> dict[str, Any]:
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


# All of it as a folder: a scene, what is left open of it, and the report as HTML and JSON.

POSTERIOR = 'posterior.yaml'
IDENTIFIED_PAGE = 'report.html'
_WHOLE = 0.99   # of a run: so long a stretch is all of it


def write_results(run: Run, found: Identification, start: str, folder: Path, name: str | None = None) -> None:
    """Write the four files into a folder that exists, and inputs that were measured beside them.

    `start` is the scene that was given, as it was named; `name` that of several runs, of which `run` is the first.

    Raises OSError when the disk refuses.
    """
    start, name = Path(start).name, name or run.name
    friction = known_friction(run, found)
    values = report_values(found, name, start, friction)
    page = report_page(found, name, start, _pictures(found, friction), values['versions'])
    for name, text in input_texts(found).items():
        (folder / name).write_text(text, encoding='utf-8')
    (folder / IDENTIFIED_SCENE).write_text(identified_text(found, name, start), encoding='utf-8')
    (folder / POSTERIOR).write_text(posterior_text(found, name), encoding='utf-8')
    (folder / IDENTIFIED_VALUES).write_text(json.dumps(values, indent=1, allow_nan=False) + '\n', encoding='utf-8')
    (folder / IDENTIFIED_PAGE).write_text(page, encoding='utf-8')


def _pictures(found: Identification, friction: Mapping[str, KnownFriction]) -> dict[str, str]:
    """Return the pictures as parts of a page, by their names."""
    channels = fitted_channels(found)
    names, window, share = [one.name for one in found.estimates], usual_cycles(found), slip_share(found)
    drawn: dict[str, Callable[[Path], None]] = {
        'fit': lambda path: plot_fit(channels, window, found.restarts, path),
        'residuals': lambda path: plot_residuals(channels, share, path),
        'friction': lambda path: plot_known_friction(friction, path),
        'correlations': lambda path: plot_correlations(names, found.correlation, path),
    }
    for k, one in enumerate(found.predictions):
        drawn[f'prediction_{k}'] = partial(draw_prediction, one)
    with TemporaryDirectory() as folder:
        return {name: _picture(Path(folder) / f'{name}.svg', draw) for name, draw in drawn.items()}


def fitted_channels(found: Identification) -> list[FittedChannel]:
    """Return the channels as they are drawn."""
    return [FittedChannel(one.name, one.unit, one.times, one.measured, one.fitted, one.residuals / one.resolution,
                          phases(found, one.times), misfit_spans(found, one), one.free) for one in found.channels]


def misfit_spans(found: Identification, channel: ChannelFit) -> list[tuple[float, float]]:
    """Return where a channel does not fit, s: the stretches; the whole run where no stretch by itself does not."""
    spans = sorted({(one.from_time, one.to_time) for one in found.misfits if one.channel == channel.name})
    whole = float(channel.times[-1] - channel.times[0])
    return [span for span in spans if span[1] - span[0] < _WHOLE * whole] or spans


def _picture(path: Path, draw: Callable[[Path], None]) -> str:
    draw(path)
    return figure(path, caption(path.stem))
