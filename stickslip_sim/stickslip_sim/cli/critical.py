# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip critical`: the value of a parameter at which stick-slip begins or ends."""

import math
from typing import TYPE_CHECKING

import click

from . import completion
from .scene_changes import SceneChanges, scene_changes

if TYPE_CHECKING:
    from ..scene import Scene
    from ..study.answer_changes import Findings, Transition
    from ..study.critical import Critical
    from ..study.variation import Variation

_ACCURACY = 1e-9
_DIGITS = 12   # of ends that are too small or large to be written out


@click.command(short_help='Find the value at which stick-slip begins or ends.')
@click.argument('scene', metavar='SCENE', shell_complete=completion.complete_scenes)
@click.option('--of', 'name', required=True, metavar='A.B', shell_complete=completion.complete_parameters,
              help='The parameter, or an element of a list: A.B[1].')
@click.option('--between', metavar='LOW:HIGH', help='Where to look [default: 1/100 to 100 times its value].')
@click.option('--accuracy', type=float, default=_ACCURACY, metavar='REL',
              help=f'Relative width of what is left open [default: {_ACCURACY:g}].')
@scene_changes('Change a parameter of the scene.')
def critical(scene: str, name: str, between: str | None, accuracy: float, changes: SceneChanges) -> None:
    """Find where SCENE goes over from stick-slip to sliding: from rest, and from sliding."""
    from ..study.critical import critical_of
    from .progress import progress_bar

    loaded = changes.load(scene)
    over = range_given(loaded, name, between, changes)
    with progress_bar('narrowing') as progress:
        found = critical_of(loaded, over, accuracy, progress)
    print('\n'.join(_lines(loaded, found)))


def range_given(scene: 'Scene', name: str, between: str | None, changes: SceneChanges) -> 'Variation':
    """Return where to look for critical values of a parameter; raises InputError."""
    from ..study.critical import default_range
    from ..study.variation import parameter_of, range_of

    parameter_of(name)
    if between is None:
        return default_range(scene, name)
    over = range_of('--between', name, between)
    changes.check_ranges([over])
    return over


def _lines(scene: 'Scene', found: 'Critical') -> list[str]:
    from ..study.theory import feed_of_theory
    from ..study.variation import with_place

    over = found.over
    unit = f' {over.unit}'.rstrip()
    digits = max(3, math.ceil(-math.log10(found.accuracy)) + 1)
    lines = [f'{scene.name}: {with_place(scene.values, over.name)} from {over.low:g} to {over.high:g}{unit}, '
             f'to {found.accuracy:g} of the value',
             *_start_lines('from rest', found.from_rest, unit, digits, 'stick-slip', 'no stick-slip'),
             *_start_lines('from sliding', found.from_sliding, unit, digits, 'sliding is lost', 'sliding lasts')]
    lines += [f'{"bistable":14} from {low:.6g} to {high:.6g}{unit} both go on: the start decides'
              for low, high in found.both]
    theory = feed_of_theory(scene.axis) if over.name == 'drive.velocity' else None
    lines += _table_lines(scene, found, unit, digits)
    return lines if theory is None else [*lines, f'{"closed form":14} {theory:.{digits + 2}g}{unit}, from rest']


def _table_lines(scene: 'Scene', found: 'Critical', unit: str, digits: int) -> list[str]:
    """Return a line for each value that a table of friction decides, and one on what else would."""
    from ..study.table_facts import breakpoints_between

    lines = []
    for fact in found.by_table:
        start = 'sliding' if fact.from_sliding else 'rest'
        which = f'{"by the table":14} {fact.value:.{digits}g}{unit} from {start}: '
        if fact.breakpoint is not None:
            lines.append(f'{which}the feed is a breakpoint, {fact.table}[{fact.breakpoint}]; '
                         'there the slope of mu_k jumps')
        else:
            end = 'm/s on' if math.isinf(fact.high) else f'to {fact.high:g} m/s'
            lines.append(f'{which}the straight segment of mu_k from {fact.low:g} {end} decides')
    if lines and breakpoints_between(scene):
        lines.append(f'{"":14} a smooth law may have another value; stickslip friction fits one to points')
    return lines


def _start_lines(start: str, findings: 'Findings', unit: str, digits: int, yes: str, no: str) -> list[str]:
    """Return a line for each transition of the findings, or one that there is none, and for each stretch in doubt."""
    from ..study.answer_changes import NO, YES

    found = [(one.low, f'{_value(one, unit, digits)}: '
              + (f'{no} below, {yes} above' if one.rises else f'{yes} below, {no} above'))
             for one in findings.transitions]
    if not found and findings.first >= NO:
        where = 'elsewhere in' if findings.doubts else 'all over'
        found = [(-math.inf, f'no transition: {yes if findings.first == YES else no} {where} the range')]
    found += [(one.low, f'{_stretch("from {} to {}", one.low, one.high, unit)}: {_why(one.failed)}')
              for one in findings.doubts]
    return [f'{start:14} {text}' for _, text in sorted(found)]


def _value(one: 'Transition', unit: str, digits: int) -> str:
    if one.resolved:
        return f'{one.value:.{digits}g}{unit}'
    return f'{_stretch("between {} and {}", one.low, one.high, unit)}, {_why(one.failed)}'


def _why(failed: bool) -> str:
    return 'not known, the exact engine gave up' if failed else 'undecided'


def _stretch(words: str, low: float, high: float, unit: str) -> str:
    """Return a stretch with as many digits as its length has a use for, rounded outwards."""
    step = 10.0 ** (math.floor(math.log10(high - low)) - 1)
    decimals = max(0, -round(math.log10(step)))
    ends = math.floor(low / step) * step, math.ceil(high / step) * step
    return words.format(*(f'{end:.{decimals}f}' if 1e-4 <= abs(end) < 1e9 else f'{end:.{_DIGITS}g}' for end in ends)
                        ) + unit
