# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures.  The only room that imports matplotlib; what is drawn of a result is decided in its own room."""

from .run import plot_run
from .trade import SolverCurve, plot_trade

__all__ = ['SolverCurve', 'plot_run', 'plot_trade']
