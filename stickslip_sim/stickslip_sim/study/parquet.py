"""The table of a sweep as Parquet, where pyarrow is installed (the extra `parquet`)."""

from importlib.util import find_spec
from pathlib import Path

from .figures import FIGURES


def write_parquet(table: Path, path: Path) -> bool:
    """Write a table of CSV as Parquet, block by block; return False without pyarrow."""
    if find_spec('pyarrow') is None:
        return False
    from pyarrow import csv, parquet, schema, string
    from pyarrow import float64 as number

    with table.open(encoding='utf-8') as file:
        names = file.readline().rstrip('\n').split(',')
    types = schema([(name, string() if name == FIGURES[0] else number()) for name in names])
    temporary = path.with_name(f'.{path.name}')
    try:
        with (csv.open_csv(table, convert_options=csv.ConvertOptions(column_types=types)) as blocks,
              parquet.ParquetWriter(temporary, types) as writer):
            for block in blocks:
                writer.write_batch(block)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
    return True
