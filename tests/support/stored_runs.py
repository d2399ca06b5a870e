# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The runs of the reference simulator that are stored; `make_data` writes them and says what is in there."""

import json
from functools import cache
from pathlib import Path
from typing import Any

FILE = Path(__file__).parents[1] / 'data' / 'reference_events.json'


@cache
def stored() -> dict[str, Any]:
    """Return the runs by the name of their scene."""
    data: dict[str, Any] = json.loads(FILE.read_text(encoding='utf-8'))
    return data
