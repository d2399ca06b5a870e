# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The exact solver: from event to event in closed form."""

from ...core.jit import entry
from .. import Solver
from . import many_axes, engine, judge

start, advance, set_inputs, set_parameters, sample, energy, is_sound = (
    entry('exact', function) for function in (engine.start, engine.advance, engine.set_inputs, engine.set_parameters,
                                              engine.sample, engine.energy, judge.is_sound))
run_axes = entry('exact', many_axes.run_axes)

SOLVER = Solver('exact', start, advance, set_inputs, set_parameters, sample, energy, is_sound)

__all__ = ['SOLVER', 'advance', 'energy', 'is_sound', 'sample', 'set_inputs', 'set_parameters', 'start']
