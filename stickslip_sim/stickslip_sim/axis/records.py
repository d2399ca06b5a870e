# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The records that the solvers work on: those of the compiled unit, or those of plain Python."""

from types import SimpleNamespace
from typing import Any

from ..core.hot_path import UNIT
from .layout import Parameters
from .rows import EnergyRow, Events, SampleRow, Sinusoids
from .state_record import State

PLAIN: Any = SimpleNamespace(Parameters=Parameters, State=State, Events=Events, Sinusoids=Sinusoids,
                             SampleRow=SampleRow, EnergyRow=EnergyRow)
# the unit has its own, with the same fields
RECORDS: Any = PLAIN if UNIT is None else UNIT
