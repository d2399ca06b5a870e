# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The marks: how many times the cost of the exact engine, rival by rival, and how wrong it is, from one race."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from .problem import Setting
from .race import RACE_DIGITS, CaseResult, Row

_FINEST = Setting(1e-12, 'tolerance')
_TAYLOR = Setting(1e-16, 'tolerance')   # heyoka has rounding as error, as the exact engine has
_MILLISECOND = Setting(1e-3, 'step')
# (rival, setting, case, mark: at least that many times the exact engine's cost, aim; None: reported without a mark)
_MARKS: tuple[tuple[str, Setting, str, float | None, float | None], ...] = (
    *(('scipy DOP853', _FINEST, case, 3000.0, 6000.0) for case in 'ABC'), ('scipy DOP853', _FINEST, 'D', None, None),
    *(('heyoka', _TAYLOR, case, mark, aim) for case, mark, aim in (
        ('A', 25.0, 30.0), ('B', 25.0, 30.0), ('C', 18.0, 25.0), ('D', 30.0, 60.0))),
    *(('CVODE (Adams), as from C', _FINEST, case, None, None) for case in 'ABCD'),
    *(('DOP853 with events, numba', _FINEST, case, 10.0, 25.0) for case in 'ABC'),
    ('DOP853 with events, numba', _FINEST, 'D', 1.5, 5.0),
    ('fixed_step euler', _MILLISECOND, 'A', 5.0, 8.0),
    *(('fixed_step euler', _MILLISECOND, case, None, None) for case in 'BCD'),
    *(('MuJoCo', _MILLISECOND, case, None, None) for case in 'ABCD'))
_ERROR_MARK, _ERROR_AIM = 1e-12, 2e-14   # s, of event times


class Ratio(NamedTuple):
    """A measured figure beside the limit to reach (`mark`) and the goal (`aim`), where they are set."""

    what: str
    case: str
    measured: float
    mark: str = ''
    aim: str = ''
    met: bool | None = None   # the mark; None without one


def at_least(what: str, case: str, measured: float, mark: float, aim: float) -> Ratio:
    """Return a figure that must not be below its mark."""
    return Ratio(what, case, measured, f'>= {mark:g}', f'{aim:g}', measured >= mark)


def at_most(what: str, case: str, measured: float, mark: float, aim: float | None = None) -> Ratio:
    """Return a figure that must not be above its mark."""
    return Ratio(what, case, measured, f'<= {mark:g}', '' if aim is None else f'{aim:g}', measured <= mark)


def ratios(results: Sequence[CaseResult]) -> list[Ratio]:
    """Return all figures that the race can speak to."""
    by_case = {result.problem.name: result for result in results}
    return [*_costs(by_case), *_accuracy(by_case)]


def _costs(by_case: dict[str, CaseResult]) -> Iterator[Ratio]:
    for rival, setting, case, mark, aim in _MARKS:
        if case not in by_case:
            continue
        own, other = _find(by_case[case], 'exact', None), _find(by_case[case], rival, setting)
        if own is None or other is None or own.cost is None or other.cost is None:
            continue
        what, measured = f'cost of {rival}, {setting.label} / exact', other.cost.median / own.cost.median
        yield Ratio(what, case, measured) if mark is None or aim is None else at_least(what, case, measured, mark, aim)


def _accuracy(by_case: dict[str, CaseResult]) -> Iterator[Ratio]:
    for case in 'ABCD':
        row = _find(by_case[case], 'exact', None) if case in by_case else None
        if row is not None and row.errors is not None:
            error, duration = row.errors, by_case[case].problem.duration
            figure = at_most(f'worst event time of exact over {duration:g} s against {RACE_DIGITS} digits, s', case,
                             error.time, _ERROR_MARK, _ERROR_AIM)
            yield figure._replace(met=bool(figure.met) and error.missed == error.invented == 0)


def _find(result: CaseResult, contestant: str, setting: Setting | None) -> Row | None:
    return next((row for row in result.rows if row.contestant == contestant and setting in (None, row.setting)), None)
