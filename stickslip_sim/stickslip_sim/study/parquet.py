# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The table of a sweep as Parquet, where pandas and a writer are installed (the extra `tables`)."""

from collections.abc import Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path

from ..core.arrays import Numbers


def write_parquet(columns: Mapping[str, Numbers | Sequence[str]], path: Path) -> None:
    """Write columns as Parquet, to the last bit; do nothing where pandas or its writer is missing or broken."""
    if not (find_spec('pandas') and (find_spec('fastparquet') or find_spec('pyarrow'))):
        return
    temporary = path.with_name(f'.{path.name}')
    try:
        import pandas
        pandas.DataFrame(columns).to_parquet(temporary, index=False)
        temporary.replace(path)
    except ImportError:   # there, but not in working order: no reason to leave the table of a study unfinished
        pass
    finally:
        temporary.unlink(missing_ok=True)
