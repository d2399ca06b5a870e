# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Arrays by what is in them."""

from collections.abc import Mapping
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import InputError

Numbers = NDArray[np.float64]
Flags = NDArray[np.bool_]
Columns = dict[str, Numbers]


def rows_between(time: Numbers, begin: float, end: float) -> slice:
    """Return the rows from `begin` to `end` (s), both included, of a column of times that rises."""
    return slice(int(np.searchsorted(time, begin)), int(np.searchsorted(time, end, 'right')))


def data_frame(columns: Mapping[str, Any], source: str) -> Any:
    """Return columns as a pandas.DataFrame; raises InputError without pandas: `source` has the same numbers."""
    try:
        import pandas
    except ImportError:
        raise InputError('pandas', None, 'installed for a data frame',
                         f'pip install pandas; `{source}` has the same numbers without it') from None
    return pandas.DataFrame(dict(columns))


def has_parquet() -> bool:
    """Return whether pandas and a writer of Parquet are installed (the extra `tables`)."""
    return bool(find_spec('pandas') and (find_spec('fastparquet') or find_spec('pyarrow')))
