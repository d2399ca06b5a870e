# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The records that the solvers work on: those of the compiled unit, or those of plain Python."""

from typing import Any

from ..core.hot_path import UNIT
from . import layout

# the unit has its own Parameters, State, Events, Sinusoids, SampleRow and EnergyRow, with the same fields
RECORDS: Any = layout if UNIT is None else UNIT
