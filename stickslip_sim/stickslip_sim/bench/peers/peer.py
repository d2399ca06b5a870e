# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a contestant is: a name, settings, and a run that can be timed."""

from collections.abc import Callable
from typing import NamedTuple

from ..problem import Outcome, Problem


class Setting(NamedTuple):
    """A tolerance or a step (s): `value`, and its word."""

    value: float
    unit: str

    @property
    def label(self) -> str:
        """The setting for people."""
        if self.unit == 'step':
            return f'step {self.value * 1e3:g} ms'
        return f'{self.value:.0e}'.replace('e-0', 'e-') if self.value else ''


NO_SETTING = Setting(0.0, '')


def tolerances(*values: float) -> tuple[Setting, ...]:
    """Return settings that are relative and absolute tolerances."""
    return tuple(Setting(value, 'tolerance') for value in values)


def time_steps(*values: float) -> tuple[Setting, ...]:
    """Return settings that are steps in s."""
    return tuple(Setting(value, 'step') for value in values)


class Peer(NamedTuple):
    """A contestant.

    `prepare` does what a user does once (packing, compiling) and returns the run that is timed; that may raise
    SolverError.  `missing` says which package to install, or None; `version` is only asked when nothing is missing.
    """

    name: str
    settings: tuple[Setting, ...]
    missing: str | None
    version: Callable[[], str]
    prepare: Callable[[Problem, Setting], Callable[[], Outcome]]
