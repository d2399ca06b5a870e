# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The exact solver: from event to event in closed form."""

from ...axis.records import RECORDS
from ...core.hot_path import UNIT, entry
from ...core.input_profile import InputProfile
from .. import PieceWalk, SolverOfFunctions
from . import engine, many_axes, soundness

start, advance = entry(engine.start), entry(engine.advance)
set_inputs, set_parameters = entry(engine.set_inputs), entry(engine.set_parameters)
set_load = entry(engine.set_load)
step, sample, energy = entry(engine.step), entry(engine.sample), entry(engine.energy)
is_sound = entry(soundness.is_sound)
walk = None if UNIT is None else PieceWalk(UNIT.Pieces, UNIT.walk, UNIT.sample_pieces)
run_axes = getattr(RECORDS, 'run_axes', many_axes.run_axes)
step_axes = getattr(RECORDS, 'step_axes', many_axes.step_axes)


def _under_load(_: InputProfile) -> SolverOfFunctions:
    """Return the solver itself: the normal force comes to it as the inputs do."""
    return SOLVER


SOLVER: SolverOfFunctions = SolverOfFunctions(
    'exact', start, advance, set_inputs, set_parameters, set_load, sample, energy, is_sound, RECORDS,
    walk=walk, with_normal_force=_under_load, step=step)

__all__ = ['SOLVER', 'advance', 'energy', 'is_sound', 'sample', 'set_inputs', 'set_load',
           'set_parameters', 'start']
