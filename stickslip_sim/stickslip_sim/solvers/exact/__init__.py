"""The exact solver: from event to event in closed form."""

from .engine import advance, sample, set_inputs, set_parameters, start

__all__ = ['advance', 'sample', 'set_inputs', 'set_parameters', 'start']
