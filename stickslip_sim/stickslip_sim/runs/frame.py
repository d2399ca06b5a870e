# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Columns as a data frame of pandas, which nothing else needs."""

from collections.abc import Mapping
from typing import Any

from ..core.errors import InputError


def data_frame(columns: Mapping[str, Any], source: str) -> Any:
    """Return columns as a pandas.DataFrame; raises InputError without pandas: `source` has the same numbers."""
    try:
        import pandas
    except ImportError:
        raise InputError('pandas', None, 'installed for a data frame',
                         f'pip install pandas; `{source}` has the same numbers without it') from None
    return pandas.DataFrame(dict(columns))
