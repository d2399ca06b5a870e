# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What came of many axes, as the tables of docs/data/identification.json; shares, and s of processor time."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from statistics import median
from typing import TypeVar

from stickslip_sim.identification.identified import FOUND

from .foreign import ForeignOutcome
from .outcomes import CLOSE, Outcome, all_parameters
from .rivals import RivalOutcome
from .varied import FEEDS, SENSORS, kind_of

Entry = TypeVar('Entry')
Table = list[dict[str, object]]


def synthetic(outcomes: Sequence[Outcome]) -> Table:
    """Return the figures of the axes that excite all they have, with their units and marks."""
    parameters = all_parameters(outcomes)
    of_all = f'of {len(outcomes)}'
    return [dict(zip(('figure', 'measured', 'unit', 'mark'), row)) for row in (
        ('parameters found', _share(each.is_found for each in parameters), 'share', '>= 95 %'),
        ('axes of which all is found', sum(each.is_found for each in outcomes), of_all, ''),
        (f'parameters within {CLOSE:.0%}', _share(each.error <= CLOSE for each in parameters), 'share', ''),
        ('parameters covered', _share(each.is_covered for each in parameters), 'share', '92 to 98 %'),
        ('half of the interval, median', median(each.width for each in parameters), 'share', ''),
        ('error, median', median(each.error for each in parameters), 'share', ''),
        ('axes whose model is said to fit', sum(each.fits for each in outcomes), of_all, ''),
        ('processor time, median', median(each.seconds for each in outcomes), 's', '<= 10 s'),
        ('processor time, longest', max(each.seconds for each in outcomes), 's', ''),
        ('simulations, median', median(each.runs for each in outcomes), '', ''))]


def by_sensors(others: Mapping[str, Sequence[Outcome]]) -> Table:
    """Return what is found of the same axes through encoders that do not count; `farthest` of what is called found."""
    return [{'sensors': words, 'axes': len(of), 'fit': sum(each.fits for each in of),
             'all_found': sum(each.is_found for each in of),
             'farthest': max((each.error for each in all_parameters(of) if each.kind == FOUND), default=None)}
            for words, of in others.items()]


def by_model(outcomes: Sequence[Outcome]) -> Table:
    """Return the figures of each contact and law."""
    groups = _grouped((': '.join(model), outcome) for outcome in outcomes
                      for model in zip(('contact', 'static', 'kinetic'), outcome.models, strict=True))
    return [{'model': name, 'axes': len(of), 'all_found': sum(each.is_found for each in of),
             'covered': _share(each.is_covered for each in all_parameters(of)),
             'cpu': median(each.seconds for each in of)} for name, of in groups.items()]


def by_parameter(outcomes: Sequence[Outcome]) -> Table:
    """Return the figures of each parameter."""
    groups = _grouped((each.name, each) for each in all_parameters(outcomes))
    return [{'parameter': name, 'times': len(of), 'found': _share(each.is_found for each in of),
             'covered': _share(each.is_covered for each in of), 'error': median(each.error for each in of),
             'half_interval': median(each.width for each in of)} for name, of in groups.items()]


def of_every_kind(varied: Sequence[Outcome]) -> Table:
    """Return the figures of the axes whose feeds were not chosen: by what the sensors show, and by feed."""
    groups = {words: [of for k, of in enumerate(varied) if kind_of(k) == words] for words in SENSORS}
    groups |= {f'feed: {feed}': [of for of in varied if of.axis.startswith(f'{feed} ')] for feed in FEEDS}
    return [_of_kind(words, of) for words, of in groups.items() if of]


def _of_kind(words: str, of: Sequence[Outcome]) -> dict[str, object]:
    parameters = all_parameters(of)
    found = [each for each in parameters if each.kind == FOUND]
    return {'axes': words, 'number': len(of), 'rejected': sum(not each.fits for each in of),
            'found': _share(each.kind == FOUND for each in parameters),
            'covered': _share(each.is_covered for each in found), 'far_off': sum(each.is_far for each in found),
            'cpu': median(each.seconds for each in of)}


def not_right(outcomes: Iterable[Outcome]) -> list[str]:
    """Return what was rejected, refused or far off, one by one."""
    return list(chain.from_iterable(
        [f'{of.axis} ({", ".join(of.models)}): {words}' for words in (
            *([] if of.fits else [of.failure or 'rejected']),
            *(f'{each.name} off by {each.error:.2%}' for each in of.parameters if each.is_far))] for of in outcomes))


def beside(rivals: Mapping[str, Sequence[RivalOutcome]]) -> Table:
    """Return what each method found on the same data."""
    errors = {name: [error for each in of for error in each.errors] for name, of in rivals.items()}
    return [{'method': name, 'axes': len(of), 'parameters': len(errors[name]),
             'close': _share(error <= CLOSE for error in errors[name]),
             'error_median': median(errors[name]) if errors[name] else None,
             'error_largest': max(errors[name], default=None), 'cpu': median(each.seconds for each in of),
             'simulations': median(each.runs for each in of)} for name, of in rivals.items() if of]


def foreign_slips(foreign: ForeignOutcome) -> Table:
    """Return by how much the slips of the scene found differ from those of the LuGre axis."""
    differences = {
        'break-away force': (foreign.differences_of_slips('break_away_force'), 0.05),
        'stick time': (foreign.differences_of_slips('stick_time'), 0.05),
        'break-away force, the scene left to itself': (foreign.differences('force'), None),
        'stick time, the scene left to itself': (foreign.differences('stick_time'), None)}
    return [{'figure': title, 'median': median(of) if of else None, 'largest': max(of, default=None), 'mark': mark}
            for title, (of, mark) in differences.items()]


def _grouped(named: Iterable[tuple[str, Entry]]) -> dict[str, list[Entry]]:
    """Return what has one name together, in the order of the names."""
    groups: defaultdict[str, list[Entry]] = defaultdict(list)
    for name, entry in named:
        groups[name].append(entry)
    return dict(sorted(groups.items()))


def _share(holds: Iterable[bool]) -> float | None:
    flags = list(holds)
    return sum(flags) / len(flags) if flags else None
