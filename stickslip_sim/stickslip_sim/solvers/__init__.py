"""Solvers: each brings a state to a time and writes the events on the way."""
