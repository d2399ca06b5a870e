# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Results as JSON values: plain numbers, texts, lists and mappings, and the versions that they depend on."""

import json
import math
import platform
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy

from ..core.hot_path import hot_path
from ..core.types import Mode
from ..core.version import __version__


def plain(value: Any) -> Any:
    """Turn named tuples and dataclasses into mappings, arrays into lists, words and infinities into text."""
    if isinstance(value, Enum):
        return value.name if isinstance(value, Mode) else value.name.lower()
    if isinstance(value, tuple) and hasattr(value, '_asdict'):
        value = value._asdict()
    elif is_dataclass(value):
        value = {field.name: getattr(value, field.name) for field in fields(value)}
    elif isinstance(value, numpy.ndarray):
        value = value.tolist()
    if isinstance(value, Mapping):
        return {plain(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(map(plain, value))
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    return value


def json_text(value: Any, indent: int = 1) -> str:
    """Return anything that `plain` takes as the text of a JSON file."""
    return json.dumps(plain(value), indent=indent, allow_nan=False) + '\n'


def versions() -> dict[str, str]:
    """Return the versions of everything that the numbers depend on."""
    return {'stickslip': __version__, 'python': platform.python_version(), 'numpy': numpy.__version__,
            'hot_path': hot_path()}
