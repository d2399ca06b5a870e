# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Put what `stickslip bench` wrote, and tick.py added to it, into docs/data/races.json, and draw its pictures.

    python3 -m benchmarks.accuracy [runs/bench]    # without a folder: draw what the data has
"""

import json
import sys
from pathlib import Path
from typing import Any

from stickslip_sim.bench.problem import LETTERS
from stickslip_sim.cli.bench import _TITLE
from stickslip_sim.plots import SolverCurve, plot_trade

from .measured import DATA, keep, kept

IMAGES = DATA.parent / 'images'
NO_FIGURES = dict.fromkeys(('missed', 'invented', 'reference_events', 'time', 'position'))


def row(case: str, raced: dict[str, Any]) -> dict[str, object]:
    """Return a row of the race with the figures that the page and its readers compare."""
    figures, cost = raced['errors'] or NO_FIGURES, raced['cost_per_simulated_second']
    return {'case': case, 'solver': raced['solver'], 'setting': raced['label'], 'cost': cost and cost['median'],
            'missed': figures['missed'], 'invented': figures['invented'], 'of': figures['reference_events'],
            'time_error': figures['time'], 'position_error': figures['position'], 'note': raced['note']}


def take(folder: Path) -> None:
    """Keep the races of a folder."""
    found = json.loads((folder / 'bench.json').read_text(encoding='utf-8'))
    keep(DATA / 'races.json', command='make bench', **{name: found[name] for name in (
        'machine', 'versions', 'rounds', 'ratios')},
        cases=[{name: case[name] for name in ('name', 'summary', 'duration', 'reference_events')}
               for case in found['cases']],
        rows=[row(case['name'], raced) for case in found['cases'] for raced in case['rows']])


def draw(folder: Path) -> None:
    """Draw the cost of every solver over its error: of the four cases, and of the shipped scenes."""
    found = kept('races')
    for picture, is_letter in (('trade', True), ('trade_scenes', False)):
        panels: dict[str, list[SolverCurve]] = {}
        for case in found['cases']:
            if (case['name'] in LETTERS) != is_letter:
                continue
            points: dict[str, list[tuple[float, float, bool]]] = {}
            for one in found['rows']:
                if one['case'] == case['name'] and one['cost'] is not None:
                    flawed = one['missed'] + one['invented'] > 0
                    points.setdefault(one['solver'], []).append((one['time_error'], one['cost'], flawed))
            panels[f'{case["name"]}: {case["summary"]}' if is_letter else case['name']] = [
                SolverCurve(label, *zip(*each)) for label, each in points.items()]
        plot_trade(panels, _TITLE, folder / f'{picture}.png')


if __name__ == '__main__':
    for given in sys.argv[1:]:
        take(Path(given))
    draw(IMAGES)
