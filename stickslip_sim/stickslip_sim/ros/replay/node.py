# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The node `replay`: wires a recording, its script and the services of a player together."""

import threading
import time

from rclpy.clock import Clock as RosClock
from rclpy.clock import ClockType
from rclpy.duration import Duration
from rosgraph_msgs.msg import Clock

from ...core.time_grid import NANOSECONDS
from ...recording.playback import Recording
from ...recording.topics import CLOCK
from ..node.conversion import set_stamp
from ..node.endpoints import publisher
from ..node.listed_parameters import ListedNode
from ..process.given_parameters import GivenParameters
from .commands import Commands
from .player import Player, Script
from .player_services import Services
from .replay_settings import REPLAY_PARAMETERS, STATES_MODE, Settings
from .span import chosen_topics, span_of
from .states import States
from .timeline import Timeline

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
