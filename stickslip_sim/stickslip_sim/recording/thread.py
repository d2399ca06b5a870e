# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A thread that writes a bag, so that the producer of messages never waits for a disk."""

from collections import deque
from collections.abc import Mapping
from threading import Event, Lock, Thread

from .bag import BagWriter

_POLL = 0.05       # s
_FLUSH_EVERY = 8   # polls; leaves room below the second that a killed process may lose
_SLICE = 32        # messages at a time; between two slices the interpreter is free for the step loop
_BREATH = 50e-6    # s

_Item = tuple[int, bytes, int, int, int]


class RecorderThread:
    """Owns a BagWriter from now on; `put` from any thread, `failure`, `dropped` and `written` to look at.

    A disk that refuses ends the recording, not the program: `failure` then says why, and messages count as dropped.
    """

    def __init__(self, writer: BagWriter, capacity: int = 20_000) -> None:
        self.failure: str | None = None
        self.written = 0
        self._writer = writer
        self._capacity = capacity
        self._queue: deque[_Item] = deque()
        self._dropped = 0
        self._is_open = True
        self._end = Event()
        self._first: Mapping[str, bytes] = {}
        self._last: Mapping[str, bytes] = {}
        self._lock = Lock()
        self._thread = Thread(target=self._run, name='recorder', daemon=True)
        self._thread.start()

    @property
    def dropped(self) -> int:
        """Messages that were not recorded because the queue was full or the recording had ended."""
        return self._dropped

    @property
    def waiting(self) -> int:
        """Messages in the queue."""
        return len(self._queue)

    def put(self, topic_index: int, data: bytes, log_time_ns: int, publish_time_ns: int, sequence: int) -> None:
        """Hand over a message; never waits, drops it when there is no room."""
        if self._is_open and len(self._queue) < self._capacity:
            self._queue.append((topic_index, data, log_time_ns, publish_time_ns, sequence))
        else:
            self._drop(1)

    def begin(self, attachments: Mapping[str, bytes]) -> None:
        """Have attachments written before the first message is handed over."""
        self._first = attachments

    def wait_for_room(self) -> None:
        """Wait while the queue is more than half full; for those who can."""
        while self._is_open and len(self._queue) > self._capacity // 2:
            self._end.wait(_POLL)

    def close(self, attachments: Mapping[str, bytes] | None = None, timeout: float | None = None) -> bool:
        """Write all that waits, finish the bag; return whether it ended well within `timeout` (s, None: any time)."""
        self._is_open = False
        self._last = attachments or {}
        self._end.set()
        self._thread.join(timeout)
        return not self._thread.is_alive() and self.failure is None

    def _run(self) -> None:
        try:
            self._record()
            self._writer.close(self._last)
        except Exception as error:  # of any kind: the axis goes on and `failure` reports it
            self._is_open = False
            self.failure = str(error) or type(error).__name__
            self._writer.abandon()
            self._drop(self.written - self._writer.on_disk)
            self.written = self._writer.on_disk
        self._drop(len(self._queue))
        self._queue.clear()

    def _record(self) -> None:
        polls = 0
        while not self._end.wait(_POLL):
            self._write_waiting()
            polls += 1
            if polls % _FLUSH_EVERY == 0:
                self._writer.flush()
        self._write_waiting()

    def _write_waiting(self) -> None:
        """Write in slices; a message leaves the queue when it is written."""
        if self._first:
            self._writer.attach(self._first)
            self._first = {}
        while self._queue:
            for _ in range(min(_SLICE, len(self._queue))):
                self._writer.write(*self._queue[0])
                self._queue.popleft()
                self.written += 1
            self._end.wait(_BREATH)

    def _drop(self, count: int) -> None:
        with self._lock:
            self._dropped += count
