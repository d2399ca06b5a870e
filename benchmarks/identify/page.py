# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The page with the figures of identification: docs/identification_figures.md."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from operator import itemgetter
from statistics import median
from typing import TypeVar

from stickslip_sim.identification.identified import FOUND
from stickslip_sim.report.markdown import markdown_table

from .axes import FARTHEST, FREE, LEAST_SLIPS, NEAREST
from .foreign import ForeignOutcome
from .measuring import USUAL
from .outcomes import CLOSE, Outcome, all_parameters
from .page_beside import beside, foreign_data, share
from .page_varied import of_every_kind
from .rivals import RivalOutcome

FOUND_MARK, TIME_MARK = 95, 10.0   # % of parameters, s
COVERAGE_MARK = 92, 98             # %

Entry = TypeVar('Entry')


def page(outcomes: Sequence[Outcome], others: Mapping[str, Sequence[Outcome]],
         varied: Sequence[Outcome],
         rivals: Mapping[str, Sequence[RivalOutcome]], foreign: ForeignOutcome, machine: str, seed: int) -> str:
    """Return the page for what was measured."""
    return '\n'.join([
        '# Identification, measured', '',
        'See here how near to the truth `stickslip identify` comes, how true its intervals are, and how long it takes.',
        f'`python3 -m benchmarks.identify --axes {len(outcomes)} --seed {seed}` wrote this page on', f'{machine}.', '',
        '## Synthetic axes', '',
        f'{len(outcomes)} axes, drawn at random: rigid and compliant contacts, five laws of static and four of kinetic',
        f'friction in turn, {FREE[0]} to {FREE[1]} free parameters.  Each is {NEAREST:.0%} to {FARTHEST:.0%} off at the'
        ' start, up or down, and its',
        'range goes from half to twice the start.  The feed has six steps of known velocity: four with stick-slip, a',
        f'fast one, and one back.  An axis with fewer than {LEAST_SLIPS} break-aways is drawn again.  For 10 s at'
        f' {USUAL.rate:g} Hz an encoder of',
        f'{USUAL.resolution * 1e6:g} µm shows the position, and a sensor the force of the drive, with noise of'
        f' {USUAL.force_noise:.0%} of its root mean square.', '',
        *_marks(outcomes), '',
        '* Found: within 1 % of the truth, or the truth within the 95 % interval that is given with it.',
        '* Covered: the truth lies within that interval.', '',
        '### Other sensors', '', 'The same axes through an encoder that does not count:', '', *_by_sensors(others), '',
        '### By model', '', *_by_model(outcomes), '',
        '### By parameter', '', *_by_parameter(outcomes), '', *_failures(outcomes),
        *of_every_kind(varied), *beside(rivals), *foreign_data(foreign), ''])


def _marks(outcomes: Sequence[Outcome]) -> list[str]:
    parameters = all_parameters(outcomes)
    low, high = COVERAGE_MARK
    return markdown_table(('figure', 'measured', 'mark'), [
        ('parameters found', _percent(each.is_found for each in parameters), f'{FOUND_MARK} %'),
        ('axes of which all is found', f'{sum(each.is_found for each in outcomes)} of {len(outcomes)}', '–'),
        (f'parameters within {CLOSE:.0%}', _percent(each.error <= CLOSE for each in parameters), '–'),
        ('parameters covered', _percent(each.is_covered for each in parameters), f'{low} to {high} %'),
        ('half of the interval, median', share(median(each.width for each in parameters)), '–'),
        ('error, median', share(median(each.error for each in parameters)), '–'),
        ('axes whose model is said to fit', f'{sum(each.fits for each in outcomes)} of {len(outcomes)}', '–'),
        ('processor time, median', f'{median(each.seconds for each in outcomes):.1f} s', f'{TIME_MARK:g} s'),
        ('processor time, longest', f'{max(each.seconds for each in outcomes):.1f} s', '–'),
        ('simulations, median', f'{median(each.runs for each in outcomes):,.0f}', '–')])


def _by_sensors(others: Mapping[str, Sequence[Outcome]]) -> list[str]:
    heads = 'sensors', 'said to fit', 'of which all is found', 'farthest from the truth of what is called found'
    return markdown_table(heads, [
        (words, f'{sum(each.fits for each in of)} of {len(of)}', str(sum(each.is_found for each in of)),
         share(max(_far(of), default=0.0))) for words, of in others.items()])


def _far(outcomes: Sequence[Outcome]) -> Iterable[float]:
    return [each.error for each in all_parameters(outcomes) if each.kind == FOUND]


def _by_model(outcomes: Sequence[Outcome]) -> list[str]:
    groups = _grouped((': '.join(model), outcome) for outcome in outcomes
                      for model in zip(('contact', 'static', 'kinetic'), outcome.models, strict=True))
    heads = 'model', 'axes', 'of which all is found', 'parameters covered', 'processor time, median'
    return markdown_table(heads, [
        (name, str(len(of)), str(sum(each.is_found for each in of)),
         _percent(each.is_covered for each in all_parameters(of)), f'{median(each.seconds for each in of):.1f} s')
        for name, of in groups])


def _by_parameter(outcomes: Sequence[Outcome]) -> list[str]:
    groups = _grouped((parameter.name, parameter) for parameter in all_parameters(outcomes))
    heads = 'parameter', 'times', 'found', 'covered', 'error, median', 'half of the interval, median'
    return markdown_table(heads, [
        (f'`{name}`', str(len(of)), _percent(each.is_found for each in of), _percent(each.is_covered for each in of),
         share(median(each.error for each in of)), share(median(each.width for each in of))) for name, of in groups])


def _grouped(named: Iterable[tuple[str, Entry]]) -> list[tuple[str, list[Entry]]]:
    """Return what has one name together, in the order of the names."""
    groups: defaultdict[str, list[Entry]] = defaultdict(list)
    for name, entry in named:
        groups[name].append(entry)
    return sorted(groups.items(), key=itemgetter(0))


def _failures(outcomes: Sequence[Outcome]) -> list[str]:
    failed = [f'* {each.axis} ({", ".join(each.models)}): {each.failure}' for each in outcomes if each.failure]
    return ['Refused or failed:', '', *failed, ''] if failed else []


def _percent(holds: Iterable[bool]) -> str:
    flags = list(holds)
    return f'{100.0 * sum(flags) / len(flags):.1f} %' if flags else '–'
