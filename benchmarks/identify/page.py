# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The page with the figures of identification: docs/identification_figures.md."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from operator import itemgetter
from statistics import median
from typing import TypeVar

from stickslip_sim.identification.identified import FOUND
from stickslip_sim.report.text import markdown_table

from .axes import FARTHEST, FREE, LEAST_SLIPS, NEAREST
from .foreign import ForeignOutcome
from .measuring import USUAL
from .mujoco_sysid import INSTALL, is_installed
from .outcomes import CLOSE, FAR, INTERVALS, Outcome, ParameterOutcome, all_parameters
from .rivals import RivalOutcome
from .varied import FEEDS, SENSORS, SLIPS, VARIED_FREE, kind_of

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


# The sections of the page on other methods, and on data of another model.

_FOREIGN_MARK = 5   # %
_STATEMENTS = 4     # of the misfit that are shown
_LEGEND = (
    '* Least squares: `scipy.optimize.least_squares` with its defaults, over the whole run, simulated by semi-implicit',
    '  Euler at 0.1 ms with the laws of the axis (`solver.name: fixed_step`).',
    '* `mujoco.sysid`, our laws: its optimizer with its defaults, on the same residuals.',
    '* `mujoco.sysid`, own friction: a slide joint with `frictionloss` and `damping`, which has no static limit that',
    '  grows with rest and no falling curve.  Only mass, stiffness and damping of the drive have an error, if free.',
)


def beside(rivals: Mapping[str, Sequence[RivalOutcome]]) -> list[str]:
    """Return the section on other methods."""
    missing = [] if is_installed() else [f'`mujoco.sysid` is not installed here: `{INSTALL}`.', '']
    return ['## Beside others', '', 'The same data, starts and ranges, one core, one after the other:', '',
            *markdown_table(('method', 'axes', f'parameters within {CLOSE:.0%}', 'error, median', 'error, largest',
                             'processor time, median', 'simulations, median'),
                            [_rival(name, of) for name, of in rivals.items()]), '', *missing, *_LEGEND, '']


def foreign_data(foreign: ForeignOutcome) -> list[str]:
    """Return the section on the LuGre axis."""
    single = [_difference_row(title, foreign.differences_of_slips(name), f'{_FOREIGN_MARK} %')
              for title, name in (('break-away force', 'break_away_force'), ('stick time', 'stick_time'))]
    alone = [_difference_row(f'{title}, the scene left to itself', foreign.differences(name), '')
             for title, name in (('break-away force', 'force'), ('stick time', 'stick_time'))]
    return [
        '## Data of another model', '',
        'An axis with LuGre friction, integrated by SciPy to a tolerance of 1e-9: bristles bend before the slider',
        'slides, and static friction knows no rest time.  Our laws cannot be right for it; the tool must say so.', '',
        f'* Said to fit: {"yes" if foreign.fits else "no"} (right: no).',
        *(f'* {statement}' for statement in foreign.statements[:_STATEMENTS]),
        *([f'* … and {more} more statements.'] if (more := len(foreign.statements) - _STATEMENTS) > 0 else []),
        f'* Slips: {foreign.true_slips} of the LuGre axis, {foreign.found_slips} of the scene found.',
        f'* Processor time: {foreign.seconds:.1f} s.', '',
        *markdown_table(('of the slips, each from the measured arrest before it', 'difference, median', 'largest',
                         'mark'), [*single, *alone]), '',
        'Left to itself the scene comes to the next change of the feed at another moment of its cycle, and the slip',
        'there is another one.', '']


def _difference_row(title: str, of: Sequence[float], mark: str) -> list[str]:
    return [title, *([f'{100.0 * median(of):.1f} %', f'{100.0 * of[-1]:.1f} %'] if of else ['–', '–']), mark]


def share(part: float) -> str:
    """Return a share in %, with two digits."""
    return f'{100.0 * part:.0f} %' if part >= 0.995 else f'{100.0 * part:.2g} %'


def _rival(name: str, of: Sequence[RivalOutcome]) -> list[str]:
    errors = [error for each in of for error in each.errors]
    close = 100.0 * sum(error <= CLOSE for error in errors) / len(errors) if errors else 0.0
    return [name, str(len(of)), f'{close:.0f} % of {len(errors)}',
            *([share(median(errors)), share(max(errors))] if errors else ['–', '–']),
            f'{median(each.seconds for each in of):.1f} s', f'{median(each.runs for each in of):,.0f}']
# The section of the page on axes of every kind, as `varied` draws them.

_REJECTED = 1e-4   # once in 10,000 times a test rejects a right model


def of_every_kind(varied: Sequence[Outcome]) -> list[str]:
    """Return the section; nothing without axes."""
    if not varied:
        return []
    groups = {words: [of for k, of in enumerate(varied) if kind_of(k) == words] for words in SENSORS}
    groups |= {f'feed: {feed}': [of for of in varied if of.axis.startswith(f'{feed} ')] for feed in FEEDS}
    rows = [_row_of_kind(words, of) for words, of in groups.items() if of]
    return [
        '## Axes of every kind', '',
        f'{len(varied)} axes with {SLIPS[0]} to {SLIPS[1]} break-aways, {VARIED_FREE[0]} to {VARIED_FREE[1]} free '
        'parameters and feeds that were not chosen to',
        'excite them, some with other friction backwards, some without a sensor of'
        ' force, or driven by a motor without a spring.',
        'What such a run does not show must be called not identifiable, and a right model must not be rejected (each'
        f' test may: {_REJECTED:.2%}).', '',
        *markdown_table(('axes', 'number', 'rejected', 'called found', 'of these covered', 'far off',
                         'processor time, median'), rows), '',
        f'* Far off: called found, and off by more than {FAR:.0%} of the truth and {INTERVALS:g} intervals.', '',
        *_listed(varied)]


def _row_of_kind(words: str, of: Sequence[Outcome]) -> list[str]:
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
