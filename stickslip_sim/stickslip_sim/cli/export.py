# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip export`: a topic of a recorded run as a table."""

import sys
import warnings

import click

from .arguments import check_usage, run_argument, verb
from .files import FILE, TEXT, say_written, whole, write_text


@verb(short_help='Export a recorded run as CSV or Parquet.')
@run_argument
@click.option('--csv', 'csv_file', type=TEXT, metavar='FILE.csv',
              help='Write a CSV file with 17 digits ("-" for standard output).')
@click.option('--parquet', type=FILE, metavar='FILE.parquet', help='Write a Parquet file.')
@click.option('--topic', default='slider_state', metavar='TOPIC', help='Topic to export [default: slider_state].')
def export(run: str, csv_file: str | None, parquet: str | None, topic: str) -> None:
    """Write a topic of the recorded RUN as a table, with one row per message and one column per number or text.

    log_time is simulation time and publish_time the message stamp, both in ns; sequence is the step.  A varying normal
    force adds a column to friction_force.
    """
    check_usage((csv_file is None and parquet is None, 'Give --csv FILE.csv or --parquet FILE.parquet.'))
    from ..core.arrays import has_parquet
    from ..core.errors import InputError
    from ..inputs.sources import check_run

    if parquet is not None and not has_parquet():
        raise InputError('--parquet', parquet, 'written by pandas with fastparquet or pyarrow, which are not installed',
                         'pip install pandas fastparquet, or choose --csv')
    check_run(run)
    from ..recording import open_bag
    from ..recording.recorded_run import normal_force_beside
    from .csv_tables import csv_lines

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
    write_text(csv_file, csv_lines({**block, **normal_force(block)} for block in bag.column_blocks(topic)))
    say_written(csv_file, parquet)
