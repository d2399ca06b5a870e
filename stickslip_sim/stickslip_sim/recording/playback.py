# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings to be played: any MCAP bag of ROS 2, from any time on, without reading all that comes before."""

from collections.abc import Collection, Iterator
from contextlib import suppress
from functools import cached_property
from pathlib import Path

from ..bags.bag import METADATA, is_by_wall_clock
from ..bags.bag_files import RecordedFile, RecordedMessage, RecordedTopic, files_of, goes_on_empty
from ..core.errors import InputError, RecordingError
from ..scene import Scene, parse_scene
from .run import SCENE_FILE


class Recording:
    """A bag to be played: its topics, and the log times (ns) of its first and last message, `begin` and `end`.

    One that was cut off (`is_complete` is false) is what is whole of it.  Raises RecordingError when the bag cannot be
    read, or holds no message.
    """

    def __init__(self, path: Path | str) -> None:
        files = files_of(Path(path))
        self.path = files[0] if len(files) == 1 else Path(path)
        self._files = [RecordedFile(file, whose_bytes_are_checked=False) for file in files]
        self.is_complete = all(file.is_complete for file in self._files) and not goes_on_empty(files[-1])
        self.topics: dict[str, RecordedTopic] = {}
        for file in self._files:
            self.topics = {**file.topics, **self.topics}
        spans = [file.span for file in self._files if file.span is not None]
        if not spans:
            raise RecordingError(f'{self.path}: no message can be read of it; give a recording that holds some')
        self.begin, self.end = min(begin for begin, _ in spans), max(end for _, end in spans)
        for file in self._files:
            file.begin = self.begin

    @cached_property
    def scene(self) -> Scene | None:
        """The scene that travels in it; None without one that this version can read."""
        with suppress(InputError, RecordingError):
            if text := self._files[0].attachments.get(SCENE_FILE):
                return parse_scene(text.decode(errors='replace'))
        return None

    def simulation_time(self, message: RecordedMessage) -> int:
        """Return the simulation time of a message of a recording of an axis, ns."""
        return message.publish_time if self._is_by_wall_clock else message.log_time

    def stamp(self, message: RecordedMessage) -> int:
        """Return when a message was stamped, ns."""
        return message.log_time if self._is_by_wall_clock else message.publish_time

    @cached_property
    def _is_by_wall_clock(self) -> bool:
        return any(is_by_wall_clock(record.metadata) for record in self._files[0].metadata if record.name == METADATA)

    @property
    def length(self) -> float:
        """From the first message to the last, s; log times of other recorders are since 1970."""
        return (self.end - self.begin) * 1e-9

    def messages(self, topics: Collection[str], since: int, until: int) -> Iterator[RecordedMessage]:
        """Yield the messages of some topics from one log time to another (ns), both included, in this order.

        A bag without an index, such as one that was cut off, has them in the order in which they were written.  Raises
        RecordingError where the bag is damaged.
        """
        for file in self._files:
            if file.span is not None and file.span[0] <= until and file.span[1] >= since:
                yield from file.messages(topics, since, until)
