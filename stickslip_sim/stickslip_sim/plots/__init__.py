# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures, and pages that hold them.  The only room that imports matplotlib."""

from .run import plot_run
from .trade import SolverCurve, plot_trade
from .what_if import plot_beside

__all__ = ['SolverCurve', 'plot_beside', 'plot_run', 'plot_trade']
