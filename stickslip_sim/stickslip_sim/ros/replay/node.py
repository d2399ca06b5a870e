# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node `replay`: wires a recording, its script and the services of a player together."""

import threading
import time
from typing import Any

from rclpy.clock import Clock as RosClock
from rclpy.clock import ClockType
from rclpy.duration import Duration
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool, Trigger

from ...bags.topics import CLOCK
from ...core.time_grid import NANOSECONDS
from ...recording.reader import Recording
from ..node.endpoints import publisher, set_stamp
from ..node.parameters import ListedNode
from ..node.time_services import answer
from ..programs import GivenParameters
from .commands import Commands
from .player import Player, Script, Timeline
from .span import REPLAY_PARAMETERS, STATES_MODE, Settings, chosen_topics, span_of
from .states import States

# The services of the replay, with the names that rosbag2's player has for them.

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


NAME = 'replay'
_PATIENCE = 5.0    # s; what did not fit into shared memory is sent again after 3 s (the heartbeat of Fast DDS)


class Replay(ListedNode):
    """Plays a recording; raises InputError or RecordingError when parameters or recording are refused."""

    def __init__(self, given: GivenParameters) -> None:
        super().__init__(NAME, REPLAY_PARAMETERS, given)
        settings = self._settings = Settings.of(self.values)
        self._recording = Recording(settings.bag)
        self._span = span_of(self._recording, settings)
        self._timeline = Timeline(settings.rate, settings.start_paused)
        self._timeline.move(self._span.begin)
        stop = threading.Event()
        self.player = Player(self._script(stop), self._timeline, stop, settings.delay, settings.loop)
        Services(self, self.player, self._timeline)
        if settings.clock:
            self._open_clock(settings.clock)

    def begin(self) -> None:
        """Log what is played, and play."""
        settings, log = self._settings, self.get_logger()
        if not self._recording.is_complete:
            log.warning(f'{self._recording.path} was cut off: it is played as far as it goes,'
                        f' {self._recording.length:g} s')
        begin, end = ((time - self._recording.begin) / NANOSECONDS for time in self._span)
        log.info(f'{settings.mode} of {self._recording.path} from {begin:g} s to {end:g} s, at rate {settings.rate:g}')
        self.player.start()

    def end(self) -> None:
        """Stop playing; wait for those who listen to have it all, but not for ever."""
        self.player.end()
        last = time.monotonic() + _PATIENCE
        for out in self.publishers:
            out.wait_for_all_acked(Duration(seconds=max(0.0, last - time.monotonic())))

    def values_changed(self) -> None:
        """Go on at another rate."""
        rate = self.values['rate']
        if isinstance(rate, float):
            self.player.change_rate(rate)

    def _script(self, stop: threading.Event) -> Script:
        if self._settings.mode == STATES_MODE:
            return States(self, self._recording, chosen_topics(self._recording, self._settings.topics), self._span)
        return Commands(self, self._recording, self._settings, self._span, stop)

    def _open_clock(self, rate: float) -> None:
        """Publish the time in which the stamps of the played messages are."""
        recording = self._recording
        first = next(recording.messages(recording.topics, recording.begin, recording.begin))
        offset = recording.stamp(first) - first.log_time
        out, message = publisher(self, CLOCK), Clock()

        def publish() -> None:
            set_stamp(message.clock, min(self._timeline.now(), self._span.end) + offset)
            out.publish(message)

        self.create_timer(1.0 / rate, publish, clock=RosClock(clock_type=ClockType.STEADY_TIME))
