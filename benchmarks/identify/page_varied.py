# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The section of the page on axes of every kind, as `varied` draws them."""

from collections.abc import Sequence
from statistics import median

from stickslip_sim.identification.identified import FOUND
from stickslip_sim.report.markdown import markdown_table

from .outcomes import FAR, INTERVALS, Outcome, ParameterOutcome, all_parameters
from .page_beside import share
from .varied import FEEDS, FREE, SENSORS, SLIPS, kind_of

_REJECTED = 1e-4   # once in 10,000 times a test rejects a right model


def of_every_kind(varied: Sequence[Outcome]) -> list[str]:
    """Return the section; nothing without axes."""
    if not varied:
        return []
    groups = {words: [of for k, of in enumerate(varied) if kind_of(k) == words] for words in SENSORS}
    groups |= {f'feed: {feed}': [of for of in varied if of.axis.startswith(f'{feed} ')] for feed in FEEDS}
    return [
        '## Axes of every kind', '',
        f'{len(varied)} axes with {SLIPS[0]} to {SLIPS[1]} break-aways, {FREE[0]} to {FREE[1]} free parameters and'
        ' feeds that were not chosen to', 'excite them, some with other friction backwards, some without a sensor of'
        ' force, or driven by a motor without a spring.',
        'What such a run does not show must be called not identifiable, and a right model must not be rejected (each'
        f' test may: {_REJECTED:.2%}).', '',
        *markdown_table(('axes', 'number', 'rejected', 'called found', 'of these covered', 'far off',
                         'processor time, median'), [_row(words, of) for words, of in groups.items() if of]), '',
        f'* Far off: called found, and off by more than {FAR:.0%} of the truth and {INTERVALS:g} intervals.', '',
        *_listed(varied)]


def _row(words: str, of: Sequence[Outcome]) -> list[str]:
    parameters = all_parameters(of)
    found = [each for each in parameters if each.kind == FOUND]
    return [words, str(len(of)), str(sum(not each.fits for each in of)), _part(found, parameters),
            _part([each for each in found if each.is_covered], found), str(sum(each.is_far for each in found)),
            f'{median(each.seconds for each in of):.1f} s']


def _part(some: Sequence[ParameterOutcome], of: Sequence[ParameterOutcome]) -> str:
    return share(len(some) / len(of)) if of else '–'


def _listed(varied: Sequence[Outcome]) -> list[str]:
    """Return what was rejected, refused or far off, one by one."""
    found = [f'* {each.axis} ({", ".join(each.models)}): {each.failure or "rejected"}' for each in varied
             if not each.fits]
    found += [f'* {each.axis} ({", ".join(each.models)}): `{one.name}` off by {share(one.error)}' for each in varied
              for one in each.parameters if one.is_far]
    return [*found, ''] if found else []
