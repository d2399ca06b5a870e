# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The end of a process that stands still in the middleware (docs/first_aid.md).

A call of Fast DDS that never comes back keeps the interpreter: no other thread of Python runs then, and no handler of
a signal.  So a compiled thread looks whether one of Python still runs.  Where it was not compiled, the end alone is
bounded.
"""

import faulthandler
import importlib
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from threading import Event, Thread
from typing import Any

GRACE = 10.0   # s; tests of it have less
_BEAT = 0.5       # s
_SIGNAL = signal.SIGUSR2    # has the stacks of all threads written
_STACK = 262_144   # bytes for each of its threads: a node may lock all memory, some MB for each other thread
_MEMORY = Path('/dev/shm')
_PORTS = 'fast*_port*[0-9]'
_MADE = 2         # in the first word of a port's file; less before all of it is there
_REMEDY = 'a program that was killed may have left a half-made port of Fast DDS in /dev/shm'


class Standstill:
    """Ends the process with a line and the stacks of its threads when Python has not run for 10 s.

    The exit code is 2 until the node `is_up`, 1 from then on.  A bag keeps what was recorded, up to the last second.
    """

    def __init__(self, name: str) -> None:
        self._name, self._is_last = name, Event()
        self._watch = _compiled_watch()
        if self._watch is None:
            return
        files = ' '.join(map(str, half_made_ports()))
        self._say('ROS does not come up', files and f'rm {files}', 2)
        faulthandler.register(_SIGNAL, file=2, all_threads=True)
        size = threading.stack_size(_STACK)
        self._threads = [Thread(target=run, name=name, daemon=True) for name, run in (
            ('alive', self._beat), ('standstill', lambda: self._watch.look(GRACE, _SIGNAL)))]
        for thread in self._threads:
            thread.start()
        threading.stack_size(size)

    def is_up(self) -> None:
        """Take it that the node has come up."""
        if self._watch is not None:
            self._say('stands still', '', 1)

    def last(self) -> None:
        """Let the process end within 10 s from now on, also where Python still runs."""
        if self._watch is None:
            faulthandler.dump_traceback_later(GRACE, exit=True, file=2)
        self._is_last.set()

    def close(self) -> None:
        """Look no more, unless the process is to end."""
        if self._watch is not None and not self._is_last.is_set():
            self._is_last.set()
            self._watch.end()
            for thread in self._threads:    # a thread that comes back to an interpreter that is ending is killed there
                thread.join()

    def _say(self, what: str, remedy: str, code: int) -> None:
        text = (f'{self._name}: {what}: a call has not come back for {GRACE:g} s; {_REMEDY}: '
                f'{remedy or "see docs/first_aid.md"}\n')
        self._watch.say(text.encode(), code)

    def _beat(self) -> None:
        while not self._is_last.wait(_BEAT):
            self._watch.beat()


def half_made_ports() -> Iterator[Path]:
    """Yield the files of ports of Fast DDS that are not made to their end: who opens one waits for that."""
    for path in sorted(_MEMORY.glob(_PORTS)):
        try:
            with path.open('rb') as file:
                word = file.read(4)
        except OSError:    # it has gone, or is of another user
            continue
        if int.from_bytes(word, sys.byteorder) < _MADE:
            yield path


def _compiled_watch() -> Any:
    try:
        return importlib.import_module('stickslip_sim._standstill').Watch()
    except ImportError:
        return None
