"""The claims: how many times the cost of the exact engine, rival by rival, from the medians of one race."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from .peers.peer import Setting
from .race import CaseResult, Row

_FINEST = Setting(1e-12, 'tolerance')
_MILLISECOND = Setting(1e-3, 'step')
# (rival, setting, case, at least that many times the exact engine's cost; None: told, not claimed)
_CLAIMS: tuple[tuple[str, Setting, str, float | None], ...] = (
    *(('scipy DOP853', _FINEST, case, 3000.0) for case in 'ABC'), ('scipy DOP853', _FINEST, 'D', None),
    *(('scikit-sundae CVODE (Adams)', _FINEST, case, 250.0) for case in 'ABC'),
    *(('CVODE (Adams), as from C', _FINEST, case, None) for case in 'ABCD'),
    *(('DOP853 with events, numba', _FINEST, case, 10.0) for case in 'ABC'),
    ('DOP853 with events, numba', _FINEST, 'D', 1.5),
    ('semi-implicit Euler, numba', _MILLISECOND, 'A', 5.0),
    *(('semi-implicit Euler, numba', _MILLISECOND, case, None) for case in 'BCD'),
    *(('MuJoCo', _MILLISECOND, case, None) for case in 'ABCD'))
EXACT_ERROR = 1e-12   # s: the exact engine's event times over 60 s of A, B and C


class Ratio(NamedTuple):
    """One claim and what was measured; `holds` is None without a claim."""

    what: str
    case: str
    measured: float
    claimed: str
    holds: bool | None


def ratios(results: Sequence[CaseResult]) -> list[Ratio]:
    """Return all claims that the race can speak to."""
    by_case = {result.problem.name: result for result in results}
    return [*_costs(by_case), *_accuracy(by_case)]


def _costs(by_case: dict[str, CaseResult]) -> Iterator[Ratio]:
    for rival, setting, case, least in _CLAIMS:
        if case not in by_case:
            continue
        own, other = _find(by_case[case], 'exact', None), _find(by_case[case], rival, setting)
        if own is None or other is None or own.cost is None or other.cost is None:
            continue
        measured = other.cost.median / own.cost.median
        yield Ratio(f'cost of {rival}, {setting.label} / exact', case, measured, f'>= {least:g}' if least else '',
                    measured >= least if least else None)


def _accuracy(by_case: dict[str, CaseResult]) -> Iterator[Ratio]:
    for case in 'ABC':
        row = _find(by_case[case], 'exact', None) if case in by_case else None
        if row is not None and row.errors is not None:
            error = row.errors
            yield Ratio('worst event time of exact against 30 digits, s', case, error.time, f'<= {EXACT_ERROR:g}',
                        error.time <= EXACT_ERROR and error.missed == error.invented == 0)


def _find(result: CaseResult, contestant: str, setting: Setting | None) -> Row | None:
    return next((row for row in result.rows if row.contestant == contestant and setting in (None, row.setting)), None)
