# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Waiting for what another thread or process does: on a condition, with a deadline."""

import time
from collections.abc import Callable
from typing import Any

DEADLINE = 60.0   # s, of which a quiet machine needs a few


def wait_for(look: Callable[[], Any], what: str, deadline: float = DEADLINE) -> Any:
    """Return what `look` returns as soon as that is true."""
    end = time.monotonic() + deadline
    while not (found := look()):
        assert time.monotonic() < end, f'waited {deadline} s for {what}'
        time.sleep(0.01)
    return found


def first_of(growing: list[Any], is_it: Callable[[Any], bool], begin: int) -> Callable[[], Any]:
    """Return a look for the first item from `begin` on that fulfils a condition; each goes on where the last ended."""
    seen = begin

    def find() -> Any:
        nonlocal seen
        for item in growing[seen:]:
            seen += 1
            if is_it(item):
                return item
        return None

    return find
