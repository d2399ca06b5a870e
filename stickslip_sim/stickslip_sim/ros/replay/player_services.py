# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The services of the replay, with the names that rosbag2's player has for them."""

from typing import Any

from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

from ..services.answers import answer
from .player import Player
from .timeline import Timeline


class Services:
    """~/pause, ~/resume, ~/toggle_paused, ~/set_paused, ~/is_paused, ~/play_next, ~/stop."""

    def __init__(self, node: Node, player: Player, timeline: Timeline) -> None:
        self._player, self._timeline = player, timeline
        node.create_service(SetBool, '~/set_paused', lambda request, response: self._pause(request.data, response))
        node.create_service(Trigger, '~/pause', lambda _, response: self._pause(True, response))
        node.create_service(Trigger, '~/resume', lambda _, response: self._pause(False, response))
        node.create_service(Trigger, '~/toggle_paused',
                            lambda _, response: self._pause(not timeline.is_paused, response))
        node.create_service(Trigger, '~/is_paused', lambda _, response: self._answer(timeline.is_paused, response))
        node.create_service(Trigger, '~/play_next', self._play_next)
        node.create_service(Trigger, '~/stop', self._stop)

    def _pause(self, paused: bool, response: Any) -> Any:
        self._player.pause(paused)
        return self._answer(True, response)

    def _answer(self, success: bool, response: Any) -> Any:
        word = 'paused' if self._timeline.is_paused else 'running'
        return answer(response, success, f'{word} at {self._timeline.now() * 1e-9:g} s of the recording')

    def _play_next(self, _: Any, response: Any) -> Any:
        done = self._player.play_next()
        return answer(response, done, 'the next message goes out' if done else 'refused: call ~/pause first')

    def _stop(self, _: Any, response: Any) -> Any:
        self._player.ask_to_stop()
        return answer(response, True, 'the replay ends')
