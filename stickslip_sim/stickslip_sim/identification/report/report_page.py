# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The report of an identification as one HTML page that needs no network."""

import math
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from typing import Any

import numpy as np

from ...plots.html_page import folded, html_page, html_table
from ...runs.wording import quantity
from ..identified import Estimate, Identification, Misfit
from .identified_scene import interval_words, number_words

_CAPTIONS = {
    'fit': 'The fitted motion (thin) over the measured one (thick, grey): the whole run, and two cycles of it '
           '(shaded).  Where single slips were fitted, each begins at a measured arrest, marked below: no prediction '
           'of more than that slip.  The free run (dashed) is what the model does by itself from the start on.',
    'residuals': 'What is left, in standard deviations of the sensor: over time, and over the phase of the cycle, from '
                 'break-away to break-away, where a pattern shows what the model lacks.  Red: a test rejects the '
                 'model there.',
    'friction': 'Friction as identified, with the band that its numbers leave (95 %), and straight from the '
                'measurement: force on the slider less its inertia, within slips.  (a) Over speed, (b) over the time '
                'at rest; friction that depends on the direction has a row for each.',
    'correlations': 'How the errors of the numbers go together: near 1 or −1 the run shows only their combination.',
}
_SHOWN = 3   # misfits, above the fold
_ORDER = ('fit', 'residuals', 'friction')


def report_page(found: Identification, run: str, start: str, pictures: Mapping[str, str], versions: Mapping[str, str]
                ) -> str:
    """Return the page; `pictures` are parts of HTML by the names that `caption` takes."""
    title = f'{found.scene.name}, identified from {run}'
    body = [f'<h1>{escape(title)}</h1>', _verdict(found), *_facts(found, run, start), _estimates(found.estimates),
            *_open(found), *(pictures[name] for name in _ORDER), _channels(found), _slips(found),
            pictures['correlations'], _laws(found), _starts(found)]
    body.append(f'<p class="other">{escape(", ".join(f"{name} {version}" for name, version in versions.items()))}</p>')
    return html_page(title, [part for part in body if part])


def caption(name: str) -> str:
    """Return the text below a picture."""
    return _CAPTIONS[name]


def _verdict(found: Identification) -> str:
    if found.fits:
        return '<p class="holds">✓ The model fits: no test of the residuals rejects it.</p>'
    rows = ''.join(f'<li>{escape(one.statement)}</li>' for one in _foremost(found.misfits))
    return ('<p class="fails">✗ The model does not fit this run.  Its numbers are the best it can do; their '
            f'intervals are void.</p><ul>{rows}</ul>{_all_tests(found.misfits)}')


def _foremost(misfits: Sequence[Misfit]) -> list[Misfit]:
    """Return the misfits that matter most: the first of each channel, of all of the run, then those farthest off."""
    firsts = {one.channel: one for one in reversed(misfits)}
    others = sorted((one for one in misfits if one is not firsts[one.channel]),
                    key=lambda one: one.statistic / one.limit if one.limit else math.inf, reverse=True)
    return [*(one for one in misfits if one is firsts[one.channel]), *others][:_SHOWN]


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


def _estimates(estimates: Sequence[Estimate]) -> str:
    rows = []
    for one in estimates:
        change = f'{100.0 * (one.value / one.start - 1.0):+.2f} %' if one.start else '–'
        numbers = (number_words(value, one.unit) for value in (one.start, one.value))
        rows.append([one.name, *numbers, change, interval_words(one), 'profile' if one.profile else 'covariance',
                     one.kind, one.derivation])
    return html_table('Parameters: where the search began, what was found, and the 95 % interval', [
        '', 'start', 'value', 'change', 'interval', 'interval by', 'kind', 'from'], rows)


def _open(found: Identification) -> Iterator[str]:
    if found.combinations:
        rows = ''.join(f'<li>{escape(one.statement)}</li>' for one in found.combinations)
        yield f'<h2>What this run cannot tell apart</h2><ul>{rows}</ul>'


def _channels(found: Identification) -> str:
    rows = [[one.name, str(len(one.times)), quantity(one.resolution, one.unit),
             quantity(float(np.sqrt(np.mean(one.residuals**2))), one.unit),
             quantity(float(np.abs(one.residuals).max()), one.unit)] for one in found.channels]
    return html_table('What is left of each channel', ['', 'readings', 'σ of the sensor', 'rms residual', 'largest'],
                      rows)


def _slips(found: Identification) -> str:
    """Return how far the slips are apart, in the median and at worst."""
    rows = []
    for words, unit, measured, fitted in (('break-away', 's', 'time', 'fitted_time'),
                                          ('time at rest before', 's', 'stick_time', 'fitted_stick_time'),
                                          ('break-away force', 'N', 'break_away_force', 'fitted_break_away_force')):
        pairs = np.array([(getattr(slip, measured), getattr(slip, fitted)) for slip in found.slips]).reshape(-1, 2)
        both = pairs[np.isfinite(pairs).all(axis=1)]
        if len(both):
            apart = np.abs(both[:, 0] - both[:, 1])
            rows.append([words, str(len(both)), quantity(float(np.median(both[:, 0])), unit) if words != 'break-away'
                         else '–', quantity(float(np.median(apart)), unit), quantity(float(apart.max()), unit)])
    missing = sum(not (math.isfinite(slip.time) and math.isfinite(slip.fitted_time)) for slip in found.slips)
    if not rows:
        return '<p>No slip was measured.</p>'
    note = f'<p class="note">{missing} of {len(found.slips)} slips are in one of the two motions alone.</p>'
    return html_table('Slips: measured beside fitted', ['', 'pairs', 'measured, median', 'apart, median', 'at worst'],
                      rows) + note * bool(missing)


def _laws(found: Identification) -> str:
    if not found.laws:
        return ''
    best = min(one.criterion for one in found.laws)
    rows: list[list[Any]] = [
        [f'{one.static}, {one.kinetic}' + (' (taken)' if one.is_chosen else ''), str(one.n_parameters),
         f'{one.cost:.6g}', f'{one.criterion:.6g}', f'{one.criterion - best:.4g}']
        for one in sorted(found.laws, key=lambda one: one.criterion)]
    return html_table(f'Laws, static and kinetic, by {found.criterion}: the lowest is best', [
        '', 'parameters', 'sum of squares', 'criterion', 'above best'], rows)


def _starts(found: Identification) -> str:
    """Return where the search from each start ended, with a note on those that ended elsewhere."""
    if len(found.starts) < 2:
        return ''
    best = min(one.cost for one in found.starts)
    rows = [[str(k + 1) + (' (taken)' if one.is_best else ''), f'{one.cost / best:.4g}' if best else f'{one.cost:.4g}',
             *(number_words(value, estimate.unit) for value, estimate in zip(one.end, found.estimates))]
            for k, one in enumerate(sorted(found.starts, key=lambda one: one.cost))]
    return html_table('Where the search from each start ended', [
        'start', 'sum of squares / best', *(one.name for one in found.estimates)], rows)
