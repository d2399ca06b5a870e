"""The extremes: what breaks other simulators, measured on this one against its mark."""
