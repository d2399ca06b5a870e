# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of a node: begun, watched and ended while the axis runs."""

import os
import time
from collections import deque
from collections.abc import Mapping, Sequence
from pathlib import Path
from threading import Event, Lock, Thread
from typing import Any

from ..bags.bag import BagWriter, Split
from ..bags.schemas import MessageCodec, schema
from ..bags.topics import PARAMETER_EVENTS, RECORDED, Topic
from ..core.errors import InputError, RecordingError
from ..scene.model import Scene
from ..scene.values import file_name
from .run import RunFacts, checkpoint_file, open_run, receipt_file

# Names of new folders: by the time of day, and none that is in use.

def stamped_folder(place: Path, name: str) -> Path:
    """Return the path of a folder that does not exist: `name` and the time of day, UTC to the second.

    Axes may start in the same second.
    """
    return _unused(place / f'{name}_{time.strftime("%Y%m%dT%H%M%SZ", time.gmtime())}')


def _unused(first: Path) -> Path:
    """Return a path, or where that is taken, the first with a number behind it that is not."""
    folder, number = first, 1
    while os.path.lexists(folder):
        number += 1
        folder = first.with_name(f'{first.name}_{number}')
    return folder


# A thread that writes a bag, so that the producer of messages never waits for a disk.

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


_RUNS = 'runs'


class Recordings:
    """At most one recording at a time; a failure ends the recording and is kept to be reported, never raised.

    All lie below the folder of the one that the scene names at the start, or below runs/: a user who may set parameters
    may not write anywhere.  `topics` are those of RECORDED by the names that they have on the graph.
    """

    def __init__(self, namespace: str, scene: Scene, topics: Sequence[Topic] = ()) -> None:
        self.recorder: RecorderThread | None = None
        self.folder = ''             # of the recording under way
        self.failure = ''            # why the latest recording ended or did not begin
        self.died = ''               # why the first one that did not come to its end died
        self.dropped = 0             # messages of earlier recordings
        self._namespace, self._topics = namespace, topics
        given = os.path.expanduser(scene.record.folder)
        self._root = Path(os.path.realpath(Path(given).parent if given else _RUNS))
        self._codec = MessageCodec([PARAMETER_EVENTS.type])

    @property
    def total_dropped(self) -> int:
        """Messages that did not get into a bag, of all recordings."""
        return self.dropped + (self.recorder.dropped if self.recorder else 0)

    def prepare(self) -> None:
        """Do now what would disturb the step loop later: read the message definitions."""
        for topic in RECORDED:
            schema(topic.type)

    def begin(self, scene: Scene) -> None:
        """Open a new run folder; raises RecordingError."""
        try:
            writer = open_run(self._folder_of(scene), RunFacts.of(scene), self._topics, split_of(scene))
        except InputError as error:
            self.failure = str(error)
            raise RecordingError(self.failure) from None
        except (RecordingError, OSError, ValueError) as error:    # the last: odd names
            self.failure = f'record.folder = {scene.record.folder!r}: {error}'
            raise RecordingError(self.failure) from None
        self.recorder, self.folder, self.failure = RecorderThread(writer), str(writer.folder), ''

    def continue_from(self, checkpoint: Mapping[str, object]) -> None:
        """Let the recording that has just begun store the state from which the axis goes on."""
        if self.recorder is not None:
            self.recorder.begin(checkpoint_file(checkpoint))

    def end(self, receipt: Mapping[str, object]) -> None:
        """Finish the bag; raises RecordingError when it could not be written to its end."""
        recorder, self.recorder, self.folder = self.recorder, None, ''
        if recorder is None:
            return
        ended_well = recorder.close(receipt_file(receipt))
        self.dropped += recorder.dropped
        if not ended_well:
            raise RecordingError(self._die(recorder.failure or 'the bag could not be finished'))

    def parameter_event(self, fields: Mapping[str, Any]) -> bytes:
        """Return the CDR bytes of a ParameterEvent.

        rclpy allots a few bytes too many to a message with empty lists, and strict readers of bags refuse those.
        """
        return self._codec.encode(PARAMETER_EVENTS.type, fields)

    def check(self) -> str:
        """Return why the recording under way has failed, once; empty while all is well."""
        if self.recorder is None or self.recorder.failure is None:
            return ''
        failure = self._die(self.recorder.failure)
        self.dropped += self.recorder.dropped
        self.recorder, self.folder = None, ''
        return failure

    def _die(self, failure: str) -> str:
        self.failure, self.died = failure, self.died or failure
        return failure

    def _folder_of(self, scene: Scene) -> Path:
        """Return the folder of the scene, or a new one that is named after namespace, scene and time.

        Raises InputError on one that lies elsewhere.
        """
        if not scene.record.folder:
            names = [*filter(None, self._namespace.split('/')), file_name(scene.name)]
            return stamped_folder(self._root, '_'.join(names))
        folder = self.allowed(scene.record.folder)
        return _unused(folder) if scene.record.each_reset else folder

    def allowed(self, folder: str) -> Path:
        """Return the folder of a recording; raises InputError when it lies elsewhere."""
        try:
            path = Path(folder).expanduser()
        except RuntimeError:
            raise InputError('record.folder', folder, 'in a home that exists', 'check the name of the user') from None
        if folder and self._root not in Path(os.path.realpath(path)).parents:
            raise InputError('record.folder', folder, f'below {self._root}, as at the start of the node',
                             'give one there, or leave it empty')
        return path


def split_of(scene: Scene) -> Split:
    """Return when the scene lets a bag go on in another file."""
    duration = scene.record.max_duration
    return Split(scene.record.max_size, None if duration is None else round(duration * 1e9))
