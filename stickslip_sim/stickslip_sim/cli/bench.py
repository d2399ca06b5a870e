# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip bench`: cost and error of every solver, against the reference and beside its peers."""

import json
from pathlib import Path
from typing import Any

import click

from .arguments import check_usage
from .files import progress_bar, say_written, whole, write_text

_ROUNDS, _QUICK_ROUNDS = 7, 1
_QUICK_CASES, _QUICK_DURATION = ('A', 'paper_fig8'), 2.0   # s


@click.command(short_help='Compare error and cost of all solvers and other simulators.')
@click.option('--scenes', 'chosen', multiple=True, metavar='NAME...', help='A to D or shipped scenes [default: all].')
@click.argument('more', nargs=-1, metavar='')
@click.option('--out', metavar='FOLDER', help='Write bench.json, bench.md and the pictures there.')
@click.option('--rounds', type=click.IntRange(1, 1000), metavar='N', help='Timing samples per case [default: 7].')
@click.option('--quick', is_flag=True, help='Run two scenes for 2 s with one sample, as a smoke test.')
def bench(chosen: tuple[str, ...], more: tuple[str, ...], out: str | None, rounds: int | None, quick: bool) -> None:
    """Measure error and cost of every solver and setting, and of other simulators that are installed."""
    check_usage((more and not chosen, 'Give the scenes after --scenes.'))
    folder = _made(out) if out is not None else None
    from ..bench.contestants import contestants
    from ..bench.outside import batch_ratios, outside_ratios, ratios
    from ..bench.problem import case_names, make_case
    from ..bench.race import race
    from ..bench.report import marks_table, race_as_json, text_table

    names = (*chosen, *more) or (_QUICK_CASES if quick else tuple(case_names()))
    problems = [make_case(name, _QUICK_DURATION if quick else None) for name in dict.fromkeys(names)]
    rounds = rounds or (_QUICK_ROUNDS if quick else _ROUNDS)
    with progress_bar('racing') as progress:
        results = race(problems, contestants(quick=quick), rounds, progress)
    figures = [] if quick else ratios(results)
    if not chosen and not quick:
        figures += [*outside_ratios(), *batch_ratios()]
    data = race_as_json(results, figures, rounds)
    print('\n\n'.join([*map(text_table, data['cases']), *([marks_table(data['ratios'])] if figures else [])]))
    if folder is not None:
        _write(folder, data)
    say_written(out)


def _made(path: str) -> Path:
    """Make the folder before the work begins; an earlier benchmark in it is replaced."""
    from ..core.errors import InputError

    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError('--out', path, 'a folder that can be created', error.strerror or str(error)) from None
    return folder


def _write(folder: Path, data: dict[str, Any]) -> None:
    from ..bench.problem import LETTERS
    from ..bench.report import markdown
    from ..plots import SolverCurve, plot_trade

    write_text(str(folder / 'bench.json'), [json.dumps(data, indent=1, allow_nan=False) + '\n'])
    write_text(str(folder / 'bench.md'), [markdown(data)])
    for name, wanted in (('trade', True), ('trade_scenes', False)):
        panels = {f'{case["name"]}: {case["summary"]}' if wanted else case['name']: [
            SolverCurve(label, *zip(*points)) for label, points in _points(case).items()]
            for case in data['cases'] if (case['name'] in LETTERS) == wanted}
        for ending in ('png', 'svg'):
            if panels:
                with whole(str(folder / f'{name}.{ending}')) as temporary:
                    plot_trade(panels, _TITLE, temporary)


_TITLE = 'Cost and error of each solver: lower left is better\n(hollow marks missed or invented events)'


def _points(case: dict[str, Any]) -> dict[str, list[tuple[float, float, bool]]]:
    """Return (error, cost, flawed) of each solver's settings."""
    lines: dict[str, list[tuple[float, float, bool]]] = {}
    for row in case['rows']:
        errors, cost = row['errors'], row['cost_per_simulated_second']
        if errors and cost:
            flawed = errors['missed'] + errors['invented'] > 0
            lines.setdefault(row['solver'], []).append((errors['time'], cost['median'], flawed))
    return lines
