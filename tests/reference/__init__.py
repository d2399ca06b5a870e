"""High-precision reference simulator of the stick-slip axis (test code, mpmath).

Independent of the product: it shares no code with the engine it judges.

    run = simulate(parameters, duration, dps=40)      # list of Event
    run.state_at([0.1, 0.2])                          # list of Sample

``parameters`` is the nested dictionary of a scene (axis, contact, friction, initial) with piecewise-linear
inputs ``drive`` and ``force`` as lists of (start, value, slope).  Every float is taken as the double it is.
"""

from .automaton import Event, Run, Sample, simulate

__all__ = ["Event", "Run", "Sample", "simulate"]
