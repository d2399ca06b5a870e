# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of a node: begun, watched and ended while the axis runs."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..core.errors import InputError, RecordingError
from ..scene.model import Scene
from ..scene.text import file_name
from .bag import Split
from .run import RunFacts, checkpoint_file, open_run, receipt_file
from .schemas import MessageCodec, schema
from .stamped_folder import stamped_folder
from .thread import RecorderThread
from .topics import PARAMETER_EVENTS, RECORDED, Topic

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
        return self.allowed(scene.record.folder)

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
