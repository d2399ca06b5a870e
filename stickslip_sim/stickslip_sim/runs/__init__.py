# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run as one thing, simulated or recorded: samples, events, figures, receipt, estimate of its error; and batches."""

from .run import COLUMNS, Columns, Run
from .simulated import SimulatedRun, simulate, simulate_events

__all__ = ['COLUMNS', 'Columns', 'Run', 'SimulatedRun', 'simulate', 'simulate_events']
