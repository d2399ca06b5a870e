# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The table of a sweep as Parquet, where pandas and a writer are installed (the extra `tables`)."""

from importlib.util import find_spec
from pathlib import Path


def write_parquet(table: Path, path: Path) -> None:
    """Write a table of CSV as Parquet, to the last bit; do nothing without pandas and fastparquet or pyarrow."""
    if not (find_spec('pandas') and (find_spec('fastparquet') or find_spec('pyarrow'))):
        return
    import pandas

    temporary = path.with_name(f'.{path.name}')
    try:
        pandas.read_csv(table, float_precision='round_trip').to_parquet(temporary, index=False)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
