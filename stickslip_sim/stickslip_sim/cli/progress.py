# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A progress bar on a terminal, for work that takes long: the share that is done where it is known, and the time."""

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import click

from ..core.types import Progress

_STEPS = 1000
_WITHOUT_SHARE = '%(label)s  %(info)s'
_WITH_SHARE = '%(label)s  [%(bar)s]  %(info)s'


@contextmanager
def progress_bar(label: str, patience: float = 1.0, every: float = 0.5) -> Iterator[Progress]:
    """Yield a function that takes the share that is done; None when nobody looks.

    A thread draws, so that one sees how long it takes also where the work does not come round to say how far it is.
    It draws after `patience` (s), and `every` so many seconds.  Within a bar there is no other.
    """
    if _Bar.is_up or not sys.stderr.isatty():
        yield None
        return
    bar = _Bar(label, patience, every)
    try:
        yield bar.take
    finally:
        bar.end()


class _Bar:
    is_up = False

    def __init__(self, label: str, patience: float, every: float) -> None:
        _Bar.is_up = True
        self._label, self._patience, self._every = label, patience, every
        self._begin = time.monotonic()
        self._share: float | None = None
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._draw, daemon=True)
        self._thread.start()

    def take(self, share: float) -> None:
        self._share = share

    def end(self) -> None:
        self._ended.set()
        self._thread.join()
        _Bar.is_up = False

    def _draw(self) -> None:
        if self._ended.wait(self._patience):
            return
        without_share, with_share = self._drawn(_WITHOUT_SHARE, False), self._drawn(_WITH_SHARE, True)
        while True:
            share = self._share
            bar = without_share if share is None else with_share
            bar.update(round((share or 0.0) * _STEPS) - bar.pos)
            bar.render_progress()
            if self._ended.wait(self._every):
                break
        bar.render_finish()

    def _drawn(self, template: str, show_percent: bool) -> Any:
        return click.progressbar(length=_STEPS, label=self._label, file=sys.stderr, show_eta=False, width=30,
                                 show_percent=show_percent, bar_template=template,
                                 item_show_func=lambda _: f'{time.monotonic() - self._begin:.0f} s')
