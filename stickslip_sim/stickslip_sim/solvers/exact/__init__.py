"""The exact solver: from event to event in closed form."""

from .. import Solver
from .engine import advance, energy, sample, set_inputs, set_parameters, start

SOLVER = Solver('exact', start, advance, set_inputs, set_parameters, sample, energy)

__all__ = ['SOLVER', 'advance', 'energy', 'sample', 'set_inputs', 'set_parameters', 'start']
