# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip extremes`: measure the engine on cases that break other simulators; print the figures and their marks."""

import sys
from pathlib import Path

import click

from .files import check_file, end_with, say_written, write_text

_FORMATS = ('.json', '.md')


@click.command(short_help='Measure the engine on cases that break other simulators.')
@click.option('--only', metavar='X1,X7', help='Measure only these.')
@click.option('--quick', is_flag=True, help='In a reduced size, as the tests do.')
@click.option('--out', metavar='FILE.json|FILE.md', help='Write the table to a file, too.')
def extremes(only: str | None, quick: bool, out: str | None) -> None:
    """Measure the engine on extreme cases; exit with 3 if it misses a mark."""
    if out is not None:
        _check_out(out)
    _check_mpmath()
    from ..proof.judges import Setup
    from ..proof.suite import chosen, json_text, markdown_text, results, row, table_head

    selected = chosen([number.strip().upper() for number in only.split(',')] if only is not None else [])
    print(table_head())
    outcomes = []
    coming = iter(results(selected, Setup(full=not quick)))
    for extreme in selected:
        _show(f'{extreme.number} …')
        outcome = next(coming)
        _show('')
        print('\n'.join(row(outcome)), flush=True)
        outcomes.append(outcome)
    if out is not None:
        text = json_text(outcomes, quick) if out.endswith('.json') else markdown_text(outcomes, quick)
        write_text(out, [text])
        say_written(out)
    missed = [outcome.extreme.number for outcome in outcomes if not outcome.passed]
    end_with(f'{len(missed)} of {len(outcomes)} extremes missed: {", ".join(missed)}' if missed else '')


def _check_out(out: str) -> None:
    from ..core.errors import InputError
    if Path(out).suffix not in _FORMATS:
        raise InputError('--out', out, 'a file ending in .json or .md', 'change its ending')
    check_file('--out', out)


def _check_mpmath() -> None:
    from importlib.util import find_spec

    from ..core.errors import InputError
    if find_spec('mpmath') is None:
        raise InputError('mpmath', None, 'installed: the figures are measured in its arithmetic', 'pip install mpmath')


def _show(text: str) -> None:
    """Show the present step on a terminal; an empty text removes it."""
    if sys.stderr.isatty():
        print(f'\r\x1b[K{text}', end='', file=sys.stderr, flush=True)
