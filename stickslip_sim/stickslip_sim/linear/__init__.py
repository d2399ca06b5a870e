"""Closed-form motion of one linear mode, and its guaranteed first roots.  Knows no friction and no axis."""
