"""Scenes for the reference automaton, the law it must keep, and the runs of it that are stored."""
