# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A progress bar on a terminal, for work that takes long."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import click

_PATIENCE = 1.0   # s before a bar appears
_STEPS = 1000


@contextmanager
def progress_bar(label: str) -> Iterator[Callable[[float], None] | None]:
    """Yield a function that takes the share that is done; None when nobody looks."""
    if not sys.stderr.isatty():
        yield None
        return
    bar = click.progressbar(length=_STEPS, label=label, file=sys.stderr)
    begin = time.monotonic()
    visible = False

    def show(share: float) -> None:
        nonlocal visible
        if visible or (share < 1.0 and time.monotonic() - begin > _PATIENCE):
            visible = True
            bar.update(round(share * _STEPS) - bar.pos)

    try:
        yield show
    finally:
        if visible:
            bar.render_finish()
