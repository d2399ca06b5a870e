# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Plays a script: lets things happen when their time in the recording has come.  Knows no ROS."""

import math
import threading
from collections.abc import Callable, Iterator
from threading import Lock
from typing import NamedTuple, Protocol

from ...core.time_grid import NANOSECONDS
from ...realtime.pacing import Clock, SteadyClock, wake_precisely

# The time of a recording on the steady clock: at any rate, stopped and continued.

class Timeline:
    """Says what time it is in a recording, ns; safe between threads.

    Every instant is reckoned from one time on the steady clock, so that no lateness adds up.
    """

    def __init__(self, rate: float, is_paused: bool = False, clock: Clock | None = None) -> None:
        self._clock: Clock = clock or SteadyClock()
        self._lock = Lock()
        self._rate, self._is_paused = rate, is_paused
        self._time, self._since = 0, self._clock.now()

    @property
    def is_paused(self) -> bool:
        """Whether time stands still."""
        return self._is_paused

    def now(self) -> int:
        """Return the time in the recording, ns."""
        with self._lock:
            return self._now()

    def left(self, time: int) -> float:
        """Return in how many seconds of the steady clock a time comes; inf while time stands still."""
        with self._lock:
            return math.inf if self._is_paused else (time - self._now()) / (self._rate * NANOSECONDS)

    def move(self, time: int) -> None:
        """Let it be this time now."""
        with self._lock:
            self._time, self._since = time, self._clock.now()

    def pause(self, paused: bool) -> None:
        """Let time stand still, or go on from where it stands."""
        with self._lock:
            self._time, self._since = self._now(), self._clock.now()
            self._is_paused = paused

    def change_rate(self, rate: float) -> None:
        """Let time go on at another rate: seconds of the recording per second."""
        with self._lock:
            self._time, self._since = self._now(), self._clock.now()
            self._rate = rate

    def _now(self) -> int:
        if self._is_paused:
            return self._time
        return self._time + round((self._clock.now() - self._since) * self._rate)


_IDLE = 0.05        # s between two looks at whether to stop
_PATIENCE = 5.0     # s that the end waits for what is being done


class StoppedError(Exception):
    """The player is to stop; raised by a wait in its thread."""


class Act(NamedTuple):
    """What happens at a time of the recording, ns."""

    time: int
    do: Callable[[], object]


def nothing() -> None:
    """Do nothing: what a script does at the end of its span, so that it lasts as long."""


class Script(Protocol):
    """What is played, from the time `begin` of the recording (ns) on."""

    begin: int

    def prepare(self) -> None:
        """Do what must be done before each time that it is played."""

    def acts(self) -> Iterator[Act]:
        """Yield what happens, in the order of time."""


def wait_until(look: Callable[[], object], stop: threading.Event, patience: float) -> bool:
    """Wait until `look` returns something true, at most `patience` s; return whether it did.  Raises StoppedError."""
    for _ in range(round(patience / _IDLE)):
        if look():
            return True
        if stop.wait(_IDLE):
            raise StoppedError
    return False


class Player:
    """Plays a script in a thread of its own, `delay` seconds after its start, once or again and again.

    `stop` ends it; `crash` is what went wrong.
    """

    def __init__(self, script: Script, timeline: Timeline, stop: threading.Event, delay: float, loop: bool) -> None:
        self.is_over = False
        self.crash: BaseException | None = None
        self._script, self._timeline, self._stop = script, timeline, stop
        self._delay, self._loop = delay, loop
        self._single = 0     # acts that may happen while time stands still
        self._changed = threading.Event()
        self._thread = threading.Thread(target=self._run, name='player', daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def ask_to_stop(self) -> None:
        """Let what is being done be the last."""
        self._stop.set()
        self._changed.set()

    def end(self) -> None:
        """Stop, and wait for what is being done, but not for ever."""
        self.ask_to_stop()
        if self._thread.ident is not None:
            self._thread.join(_PATIENCE)

    def pause(self, paused: bool) -> None:
        """Let time stand still, or go on."""
        self._timeline.pause(paused)
        self._single = 0
        self._changed.set()

    def change_rate(self, rate: float) -> None:
        """Go on at another rate."""
        self._timeline.change_rate(rate)
        self._changed.set()

    def play_next(self) -> bool:
        """Let the next act happen while time stands still; return whether it will."""
        if self.is_over or not self._timeline.is_paused:
            return False
        self._single += 1
        self._changed.set()
        return True

    def _run(self) -> None:
        wake_precisely()
        try:
            self._play()
            while self._loop:
                self._play()
        except StoppedError:
            pass
        except BaseException as error:
            self.crash = error
        self.is_over = True

    def _play(self) -> None:
        self._script.prepare()
        if self._stop.wait(self._delay):
            raise StoppedError
        self._timeline.move(self._script.begin)
        for act in self._script.acts():
            self._wait_for(act.time)
            act.do()

    def _wait_for(self, time: int) -> None:
        while not self._stop.is_set():
            self._changed.clear()
            left = self._timeline.left(time)
            if left <= 0.0:
                return
            if self._single:
                self._single -= 1
                self._timeline.move(time)
                return
            self._changed.wait(min(left, _IDLE))
        raise StoppedError
