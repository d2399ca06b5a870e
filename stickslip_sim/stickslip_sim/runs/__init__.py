# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run as one thing, made or recorded: samples, events, summary, receipt; and batches.  Variants are in `study`."""

from .run import COLUMNS, Run
from .simulated import SimulatedRun, simulate, simulate_events

__all__ = ['COLUMNS', 'Run', 'SimulatedRun', 'simulate', 'simulate_events']
