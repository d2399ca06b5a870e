# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What is found of a run once and kept as long as the run."""

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

from .run import Run

_Found = TypeVar('_Found')


def kept(find: Callable[[Run], _Found]) -> Callable[[Run], _Found]:
    """Return a function that finds the same, but looks at each run only once; what it finds must not hold the run."""
    known: WeakKeyDictionary[Run, _Found] = WeakKeyDictionary()

    @wraps(find)
    def kept_or_found(run: Run) -> _Found:
        if run not in known:
            known[run] = find(run)
        return known[run]

    return kept_or_found
