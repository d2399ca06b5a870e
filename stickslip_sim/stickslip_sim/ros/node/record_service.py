# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of the node, begun and ended by the scene, by ~/record, or by a failure."""

from collections.abc import Callable
from typing import Any

from std_srvs.srv import SetBool

from ...core.errors import RecordingError
from ...realtime.step_loop import StepLoop
from ...recording import RECORDED
from ...recording.recordings import Recordings
from .parameters import SceneNode
from .publishers import Publishers
from .time_services import BUSY, answer


class RecordService:
    """Attaches recordings to the publishers between two steps.

    `publish` publishes what changed (run_info); `receipt` makes the receipt that ends a bag.
    """

    def __init__(self, node: SceneNode, loop: StepLoop, publishers: Publishers, publish: Callable[[], None],
                 receipt: Callable[[], dict[str, Any]]) -> None:
        self.recordings = Recordings(node.get_namespace(), node.scene, [
            topic._replace(name=node.resolve_topic_name(topic.name)) for topic in RECORDED])
        self._node, self._loop, self._publishers = node, loop, publishers
        self._publish, self._receipt = publish, receipt
        node.create_service(SetBool, '~/record', self._set_recording)

    @property
    def is_recording(self) -> bool:
        """Whether a bag is open."""
        return self.recordings.recorder is not None

    def begin_at_start(self, start: Callable[[Callable[[], None]], None]) -> None:
        """Begin a recording, and with it the steps: `start` attaches it before the first.  Raises RecordingError."""
        self.recordings.begin(self._node.scene)
        start(self._attach)
        self._log_begin()

    def begin(self) -> str:
        """Begin a recording between two steps; return why it failed, or an empty text."""
        try:
            self.recordings.begin(self._node.scene)
        except RecordingError as error:
            self._node.get_logger().error(f'no recording: {error}')
            self._publish()
            return str(error)
        if not self._loop.at_boundary(self._attach):
            self.recordings.end({})
            return BUSY
        self._log_begin()
        return ''

    def renew(self, restart: Callable[[], None]) -> None:
        """Restart with a bag of its own, after the one that is recorded into; at a boundary only.

        Time stands still meanwhile.  A bag that cannot be written is logged, and there is none then.
        """
        self._publishers.recorder = None
        log = self._node.get_logger()
        try:
            if folder := self.recordings.folder:
                self.recordings.end(self._receipt())
                log.info(f'recorded into {folder}')
            self.recordings.begin(self._node.scene)
        except RecordingError as error:
            log.error(f'no recording: {error}')
        restart()
        if self.is_recording:
            self._attach()
            self._log_begin()

    def end(self) -> str:
        """End the recording; return why the bag could not be finished, or an empty text."""
        receipts: list[dict[str, Any]] = []
        folder = self.recordings.folder

        def detach() -> None:
            self._publishers.recorder = None
            receipts.append(self._receipt())

        self._loop.at_boundary(detach)
        try:
            self.recordings.end(receipts[0] if receipts else {})
        except RecordingError as error:
            self._node.get_logger().error(f'recording failed: {error}')
            return str(error)
        finally:
            self._publish()
        if folder:
            self._node.get_logger().info(f'recorded into {folder}')
        return ''

    def close(self) -> None:
        """End the recording of a loop that has stopped; raises RecordingError when this one, or one before, died."""
        self._publishers.recorder = None
        if self.is_recording:
            folder = self.recordings.folder
            self.recordings.end(self._receipt())
            self._node.get_logger().info(f'recorded into {folder}')
        if self.recordings.died:
            raise RecordingError(self.recordings.died)

    def look(self) -> None:
        """Give a recording up that has failed."""
        failure = self.recordings.check()
        if failure:
            self._publishers.recorder = None
            self._node.get_logger().error(f'recording failed, the axis goes on: {failure}')
            self._publish()

    def _log_begin(self) -> None:
        self._node.get_logger().info(f'recording into {self.recordings.folder}')

    def _attach(self) -> None:
        rig = self._loop.rig
        start = rig.simulator.sample() if self._loop.step == 0 else None    # went out before there was a bag
        if self._loop.step >= 0:
            self.recordings.continue_from(rig.checkpoint())
        self._publishers.recorder = self.recordings.recorder
        self._publish()
        if start is not None:
            self._publishers.record_start(start)
        for kind, value in enumerate(self._loop.held):
            if value is not None:
                self._publishers.command(kind, self._loop.step, self._loop.time_ns, value)   # since then, or before

    def _set_recording(self, request: Any, response: Any) -> Any:
        folder = self.recordings.folder
        if not request.data and not folder:
            failure = self.recordings.failure
            return answer(response, not failure, f'not recording: {failure}' if failure else 'not recording')
        if not request.data:
            failure = self.end()
            return answer(response, not failure, failure or f'recorded into {folder}')
        if folder:
            return answer(response, True, f'already recording into {folder}')
        failure = self.begin()
        return answer(response, not failure, failure or f'recording into {self.recordings.folder}')
