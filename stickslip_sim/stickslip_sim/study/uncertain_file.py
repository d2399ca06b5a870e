# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The file of parameters that are not known exactly: read strictly, so that no misspelling passes unseen.

seed: 0
parameters:
friction.static.limit: {distribution: normal, mean: 0.24, standard_deviation: 0.02, between: [0.18, 0.3]}
axis.normal_force: {distribution: uniform, low: 3000.0, high: 3800.0}
correlations:
friction.static.limit: {axis.normal_force: -0.9}
"""

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

from ..config.ros_yaml import read_yaml
from ..config.strict import section
from ..core.errors import InputError
from ..scene import Parameter
from ..scene.load import named, read_text
from .correlations import Correlations, correlations_of
from .distribution import LAWS, Distribution, Law
from .study import MOST_VARIATIONS
from .variation import parameter_of

_PAGE = 'docs/maps.md'
_SEED = Parameter('seed', 'integer', 0, '', 'of the sample', low=0, high=2**31 - 1)
_LARGEST = 1e15    # as far as any parameter goes
LEAST_KEPT = 0.5   # of the probability: of a law cut further little is left


ParameterOf = Callable[[str], tuple[Parameter, int | None]]


class Uncertain(NamedTuple):
    """The distributions of a file, the seed of their sample, and how they are correlated (None: they are not)."""

    distributions: tuple[Distribution, ...]
    seed: int
    correlations: Correlations | None = None


def load_uncertain(path: str | os.PathLike[str], find: ParameterOf = parameter_of, most: int = MOST_VARIATIONS
                   ) -> Uncertain:
    """Return the content of a file, as `uncertain_of` does; raises InputError, whose text names the file."""
    if not isinstance(path, str | os.PathLike):   # from Python, as a list of names
        raise InputError('parameters', type(path).__name__, 'the path of a file, or names with their distributions',
                         "for example {'axis.mass': {'distribution': 'uniform', 'low': 300.0, 'high': 400.0}}")
    text = read_text(Path(path), 'file of distributions')
    with named(os.fspath(path)):
        return uncertain_of(read_yaml(text), find, most)


def uncertain_of(document: object, find: ParameterOf = parameter_of, most: int = MOST_VARIATIONS) -> Uncertain:
    """Return the content of a document with `most` parameters or fewer, as YAML gives it; raises InputError.

    `find` returns the parameter of a name, and the index of an element: those of a scene, or others beside them.
    """
    given = section('file', document, ('parameters', 'correlations', 'seed'), _PAGE)
    entries = given.get('parameters')
    if not isinstance(entries, Mapping) or not 1 <= len(entries) <= most:
        raise InputError('parameters', entries, f'a section of 1 to {most} parameters',
                         'for example axis.mass: {distribution: uniform, low: 300.0, high: 400.0}')
    seed = _SEED.checked(given.get('seed', _SEED.default))
    assert isinstance(seed, int)
    distributions = tuple(_distribution(name, entry, find) for name, entry in entries.items())
    return Uncertain(distributions, seed, correlations_of([one.name for one in distributions],
                                                          given.get('correlations')))


def _distribution(name: str, entry: object, find: ParameterOf) -> Distribution:
    parameter = find(name)
    word = entry.get('distribution') if isinstance(entry, Mapping) else entry
    if not isinstance(entry, Mapping) or not isinstance(word, str) or word not in LAWS:
        raise InputError(f'{name}.distribution', word, 'one of ' + ', '.join(LAWS),
                         f'for example {name}: {{distribution: uniform, low: 1.0, high: 2.0}}')
    law = LAWS[word]
    known = ('distribution', *law.numbers, *(('between',) if law.ends else ()))
    given = section(name, entry, known, _PAGE)
    numbers = tuple(_number(f'{name}.{key}', given.get(key)) for key in law.numbers)
    _check_rules(name, law, numbers)
    low, high = _ends(name, given.get('between'), law, numbers) if law.ends else (numbers[0], numbers[-1])
    _check_ends(*parameter, (low, high))
    return _kept(Distribution(name, word, numbers, low, high))


def _check_rules(name: str, law: Law, numbers: tuple[float, ...]) -> None:
    """Raise InputError unless the numbers choose a distribution of a law."""
    for rule in law.rules:
        if not rule.holds(*numbers):
            raise InputError(f'{name}.{rule.number}', numbers[law.numbers.index(rule.number)], rule.allowed,
                             'correct the numbers of this distribution')


def _ends(name: str, given: object, law: Law, numbers: tuple[float, ...]) -> tuple[float, float]:
    """Return where the tails of a distribution are cut; raises InputError."""
    assert law.ends is not None
    if not isinstance(given, list) or len(given) != 2:
        low, high = law.ends(*numbers)
        raise InputError(f'{name}.between', given, 'given as [LOW, HIGH]: a tail without an end leaves every range, '
                         'and is not cut in silence', f'for example between: [{low:.6g}, {high:.6g}]')
    low, high = (_number(f'{name}.between', end) for end in given)
    if not low < high:
        raise InputError(f'{name}.between', given, '[LOW, HIGH] with LOW < HIGH', 'put the two in order')
    return low, high


def _check_ends(entry: Parameter, index: int | None, ends: tuple[float, float]) -> None:
    """Raise InputError unless the parameter may have these values."""
    for end in ends:
        entry.checked(end if index is None else (end,))


def _kept(found: Distribution) -> Distribution:
    if found.kept < LEAST_KEPT:
        raise InputError(f'{found.name}.between', [found.low, found.high], f'a range that keeps {LEAST_KEPT:g} or '
                         f'more of the probability; it keeps {found.kept:.2g}', 'widen it')
    return found


def _number(name: str, given: object) -> float:
    number = Parameter(name, 'double', None, '', '', low=-_LARGEST, high=_LARGEST).checked(given)
    assert isinstance(number, float)
    return number
