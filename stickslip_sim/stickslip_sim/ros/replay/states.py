# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Everything recorded, back onto its topics: for viewers."""

from collections.abc import Iterator, Sequence
from functools import partial

from rclpy.node import Node

from ...recording.playback import Recording
from .player import Act, nothing
from .recorded_topics import publisher_of
from .span import PlayedSpan


class States:
    """The script of recorded topics, within a span of the recording."""

    def __init__(self, node: Node, recording: Recording, topics: Sequence[str], span: PlayedSpan) -> None:
        self.begin = span.begin
        self._recording, self._span = recording, span
        self._out = {name: publisher_of(node, recording.topics[name]) for name in topics}

    def prepare(self) -> None:
        """Do nothing: viewers come and go."""

    def acts(self) -> Iterator[Act]:
        """Yield the messages, each at its log time."""
        for message in self._recording.messages(self._out, self._span.begin, self._span.end):
            yield Act(message.log_time, partial(self._out[message.topic].publish, message.data))
        yield Act(self._span.end, nothing)
