# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip export`: a topic of a recorded run as a table."""

import csv
import io
import sys
import warnings
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import click

from . import completion
from .files import STDOUT, check_distinct, check_file, say_written, whole, write_text
from .run_or_scene import check_run

if TYPE_CHECKING:
    from numpy.typing import NDArray


@click.command(short_help='Write a recorded run as a table, CSV or Parquet.')
@click.argument('run', metavar='RUN', shell_complete=completion.complete_folders)
@click.option('--csv', 'csv_file', metavar='FILE.csv', help='Write numbers with 17 digits ("-": to standard output).')
@click.option('--parquet', metavar='FILE.parquet', help='Write a typed, compressed table.')
@click.option('--topic', default='slider_state', metavar='T', help='What to export [default: slider_state].')
def export(run: str, csv_file: str | None, parquet: str | None, topic: str) -> None:
    """Write a topic of the recorded RUN as a table: a row for each message, a column for each number and text.

    log_time is simulation time, publish_time is that of the message's stamp, both in ns; sequence is the step.  A
    normal force that varies is a column more of friction_force.
    """
    _check(csv_file, parquet)
    check_run(run)
    from ..recording import open_bag
    from ..recording.normal_force_column import normal_force_beside

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter('always')
        bag = open_bag(run)
    for warning in caught:
        print(f'note: {warning.message}', file=sys.stderr)
    bag.resolved(topic)
    normal_force = normal_force_beside(bag, topic)
    if parquet is not None:
        frame = bag.frame(topic)
        with whole(parquet) as temporary:
            frame.assign(**normal_force(frame)).to_parquet(temporary, index=False)
    if csv_file is not None:
        blocks = bag.column_blocks(topic)
        write_text(csv_file, csv_lines({**block, **normal_force(block)} for block in blocks))
    say_written(csv_file, parquet)


def csv_lines(blocks: 'Iterable[dict[str, NDArray[Any]]]') -> Iterator[str]:
    """Yield a line of names, then a line for each row of the blocks; 17 digits give the same floats back."""
    from .csv_numbers import are_numbers, rows_text
    from .csv_tables import parts

    names = ''
    for block in blocks:
        if not names:
            yield (names := ','.join(block) + '\n')
        for part in parts([*block.values()]):
            yield rows_text(part) if are_numbers(part) else _text(part)


def _check(csv_file: str | None, parquet: str | None) -> None:
    """Raise before the work begins when an output cannot be written."""
    targets = [(option, path) for option, path in (('--csv', csv_file), ('--parquet', parquet)) if path is not None]
    if not targets:
        raise click.UsageError('Give --csv FILE.csv or --parquet FILE.parquet.')
    for option, path in targets:
        if path != STDOUT or option == '--parquet':
            check_file(option, path)
    check_distinct(targets)
    if parquet is not None:
        _check_parquet(parquet)


def _text(columns: 'list[NDArray[Any]]') -> str:
    """Return the rows of columns with texts in them, in quotation marks where they need some."""
    text = io.StringIO()
    csv.writer(text, lineterminator='\n').writerows(zip(*map(_cells, columns), strict=True))
    return text.getvalue()


def _cells(column: 'NDArray[Any]') -> list[object]:
    values: list[object] = column.tolist()
    return [f'{value:.17g}' for value in values] if column.dtype.kind == 'f' else values


def _check_parquet(path: str) -> None:
    from ..core.errors import InputError

    if not (find_spec('pandas') and (find_spec('fastparquet') or find_spec('pyarrow'))):
        raise InputError('--parquet', path, 'written by pandas with fastparquet or pyarrow, which are not installed',
                         'pip install pandas fastparquet, or choose --csv')
