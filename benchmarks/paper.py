# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure what docs/paper.md shows, and put it between its markers: `python3 -m benchmarks.paper` (seconds)."""

import pathlib

from stickslip_sim.study.critical import critical_drop, critical_feed

from . import naive_switching, sensitivity
from .classics import DAMPING_RATIOS, DROP, EXACT, GROUPS, PAPER, Result, damped
from .closed_forms import light_damping_feed
from .page import replace_generated

PAGE = pathlib.Path('docs/paper.md')


def tables() -> dict[str, str]:
    """Return the tables by the names of their markers."""
    return {'sensitivity': sensitivity.table(), 'switching': naive_switching.table(), 'classics': results_table(),
            'critical': critical_table()}


def results_table() -> str:
    """Return the classical results and how close the engine is to them."""
    rows = [f'| {r.name} | {_figure(r)} | {_bound(r)} |\n' for group in GROUPS for r in group()]
    return '| result | figure | engine within |\n|---|---|---|\n' + ''.join(rows)


def critical_table() -> str:
    """Return critical feeds beside the usual estimate of them."""
    rows = [f'| {zeta:.4g} | {critical_drop(zeta):.6f} | {critical_feed(damped(zeta), DROP) * 1e3:.4f} | '
            f'{light_damping_feed(damped(zeta), DROP) / critical_feed(damped(zeta), DROP) - 1.0:+.0%} |\n'
            for zeta in (*DAMPING_RATIOS, PAPER.damping_ratio)]
    return '| ζ | A_c | v_c / (mm/s) for ΔF = 412 N | ΔF/√(4π ζ c m) beside it |\n|---|---|---|---|\n' + ''.join(rows)


def _figure(result: Result) -> str:
    return f'{result.expected:.10g} {result.unit}'.rstrip()


def _bound(result: Result) -> str:
    return f'{EXACT:.0e}' if result.tolerance == EXACT else f'{result.tolerance * abs(result.expected):.0e} absolute'


if __name__ == '__main__':
    for name, text in tables().items():
        replace_generated(PAGE, text, name)
