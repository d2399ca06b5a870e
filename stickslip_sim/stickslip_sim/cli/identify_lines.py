# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What an identification found, as lines for people."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..identification.identified import Identification

_NAME, _NUMBER = 36, 14
_BETTER = 10.0      # of the criterion: laws so far below are better (Kass and Raftery 1995: very strong evidence)
_ELSEWHERE = 1.01    # times the least sum of squares: a search that ended above it ended elsewhere


def result_lines(found: 'Identification', run: str) -> Iterator[str]:
    """Yield what was found: the parameters, what they cannot tell, laws and starts."""
    channels = ' and '.join(one.name for one in found.channels)
    yield (f'{run}: {found.scene.name} from {channels}, {found.n_residuals} residuals, {found.runs} simulations in '
           f'{found.seconds:.3g} s')
    for note in found.notes:
        yield f'  note: {note}'
    yield f'{"":{_NAME}}{"start":>{_NUMBER}}{"found":>{_NUMBER}}   95 % interval'
    yield from _estimates(found)
    for together in found.combinations:
        yield f'not separated: {together.statement}'
    yield from _slips(found)
    yield from _laws(found)
    yield from _starts(found)
    yield 'the model fits: no test of the residuals rejects it' if found.fits else 'THE MODEL DOES NOT FIT this run:'
    yield from _misfits(found)


def _misfits(found: 'Identification') -> Iterator[str]:
    """Yield the first misfit of each channel, which is that of the whole run."""
    first = {misfit.channel: misfit for misfit in reversed(found.misfits)}
    for misfit in found.misfits:
        if misfit is first[misfit.channel]:
            yield f'  {misfit.statement}'
    more = len(found.misfits) - len(first)
    if more:
        yield f'  and {more} more, in report.html'


def _estimates(found: 'Identification') -> Iterator[str]:
    from ..identification.identified import FOUND, VOID
    from ..identification.report.identified_scene import interval_words, number_words

    for one in found.estimates:
        kind = '' if one.kind in (FOUND, VOID) else f', {one.kind}'
        yield (f'{one.name:{_NAME}}{number_words(one.start, one.unit):>{_NUMBER}}'
               f'{number_words(one.value, one.unit):>{_NUMBER}}   {interval_words(one)}{kind}')


def _slips(found: 'Identification') -> Iterator[str]:
    """Yield how far slips are apart, in the median and at most, of those that both motions have."""
    import numpy as np

    apart = []
    for words, of in (('break-away force', 'break_away_force'), ('time at rest before', 'stick_time')):
        pairs = np.array([(getattr(slip, of), getattr(slip, f'fitted_{of}')) for slip in found.slips]).reshape(-1, 2)
        both = pairs[np.isfinite(pairs).all(axis=1) & (pairs[:, 0] != 0.0)]
        if len(both):
            off = 100.0 * np.abs(both[:, 1] / both[:, 0] - 1.0)
            apart.append(f'{words} {np.median(off):.2g} and {off.max():.2g} %')
    if apart:
        yield (f'{len(found.slips)} slips, fitted beside measured, apart in the median and at most: '
               f'{", ".join(apart)}')


def _laws(found: 'Identification') -> Iterator[str]:
    """Yield which laws are better by far than those of the scene; that none is, where others were tried."""
    if len(found.laws) < 2:
        return
    taken = next(one for one in found.laws if one.is_chosen)
    better = [one for one in sorted(found.laws, key=lambda one: one.criterion)
              if taken.criterion - one.criterion > _BETTER]
    for one in better:
        yield (f'better laws: {one.static} with {one.kinetic}, {found.criterion} '
               f'{taken.criterion - one.criterion:.4g} below {taken.static} with {taken.kinetic}')
    if not better:
        yield (f'none of {len(found.laws) - 1} other laws is better by more than {_BETTER:g} of {found.criterion} than '
               f'{taken.static} with {taken.kinetic}')


def _starts(found: 'Identification') -> Iterator[str]:
    """Yield how many searches ended elsewhere."""
    best = min((one.cost for one in found.starts), default=0.0)
    elsewhere = sum(one.cost > _ELSEWHERE * best for one in found.starts)
    if elsewhere:
        yield (f'{elsewhere} of {len(found.starts)} starts ended elsewhere, with a larger sum of squares: report.html '
               'has them')
