# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The step loop: a thread that brings the rig from step to step, as its clock says.  Knows no ROS.

Step n reaches from (n − 1)/rate to n/rate (step 0 is the start).  In real time it is made when its end is due on the
steady clock: first the commands that have arrived are heard, of which the latest hold from its start on, then its
events and its state go out.
So a controller that answers a state within a period acts on the very next step, as in lock-step.
"""

import threading
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress

from ..core.errors import SolverError
from ..simulation import Rig, StepResult
from .commands import CommandInputs, CommandSlot, CommandTotals, Watchdog
from .pacing import CoreShare, StepClock, wake_precisely
from .scheduling import Scheduling, StepThread
from .timing_statistics import TimingStatistics

_IDLE = 0.05            # s between two looks at whether to stop while time stands still
_PATIENCE = 5.0         # s that a request waits for its boundary

_AS_IT_IS = Scheduling()

Sink = Callable[[StepResult], None]


class StepLoop:
    """Runs the steps in a thread of its own; everything else asks for changes `at_boundary`.

    `sinks` get each step result, in the loop's thread.  With `by_request` time moves with `run_steps` only.
    `hear` puts what has arrived into the slots; where others do that, it does nothing.  Raises InputError when the
    `scheduling` cannot be had and must.
    """

    def __init__(self, rig: Rig, clock: StepClock, slots: tuple[CommandSlot, CommandSlot], sinks: Sequence[Sink],
                 watchdog: Watchdog, by_request: bool = False, hear: Callable[[], None] = lambda: None,
                 scheduling: Scheduling = _AS_IT_IS) -> None:
        self.rig = rig
        self.paused = False
        self.by_request = by_request
        self.failure = ''                    # why the solver gave up; time stands still then
        self.crash: BaseException | None = None
        self.latest: StepResult | None = None
        self.timing_statistics, self.pacing_counters = TimingStatistics(), clock.counters
        self._clock, self._sinks, self._watchdog = clock, sinks, watchdog
        self._inputs, self._hear = CommandInputs(slots), hear
        self.step_thread, self._core_share = StepThread(scheduling), CoreShare(clock)
        self._requests: deque[Callable[[], None]] = deque()
        self._is_over, self._wake = threading.Event(), threading.Event()
        self._thread = threading.Thread(target=self._run, name='steps', daemon=True)

    @property
    def step(self) -> int:
        """The last step made; -1 before the start."""
        return self.rig.step

    @property
    def time_ns(self) -> int:
        """Simulation time, ns."""
        return self.rig.time_ns

    @property
    def slots(self) -> Sequence[CommandSlot]:
        """Where commands arrive: drive velocity and force."""
        return self._inputs.slots

    @property
    def held(self) -> list[float | None]:
        """The commands in force, by input; None where the input profile of the scene is."""
        return self._inputs.held

    @property
    def command_totals(self) -> CommandTotals:
        """What befell the commands so far."""
        return self._inputs.totals(self.rig.counts)

    def start(self, lead: int = 0, prepare: Callable[[], object] = lambda: None) -> None:
        """Begin with step 0, due `lead` ns from now; until then `prepare` is done."""
        self._clock.restart(0, lead)
        prepare()
        self._thread.start()

    def stop(self) -> None:
        """Let the step at hand be the last, and wait for it, but not for ever."""
        self._is_over.set()
        self._wake.set()
        if self._thread.ident is not None:
            self._thread.join(_PATIENCE)

    def request(self, action: Callable[[], None]) -> None:
        """Have an action done between two steps by the loop's thread, without waiting for it."""
        self._requests.append(action)
        self._wake.set()

    def at_boundary(self, action: Callable[[], object], patience: float = _PATIENCE) -> bool:
        """Have an action done between two steps by the loop's thread; wait for it and return whether it was done."""
        done = threading.Event()

        def do() -> None:
            action()
            done.set()

        self.request(do)
        if not done.wait(patience):
            with suppress(ValueError):    # it was begun after all
                self._requests.remove(do)
                return False
        return done.wait(patience)

    def pause(self, paused: bool) -> None:
        """Let simulation time stand still, or go on from where it stands; at a boundary only."""
        if self.paused and not paused:
            self._clock.restart(self.step + 1)
        self.paused = paused

    def restart(self) -> None:
        """Begin anew with step 0 and the initial state, without commands; at a boundary only."""
        self._hear()
        self._inputs.forget()
        self.rig.reset()
        self._watchdog.forget()
        self.timing_statistics.forget()
        self.pacing_counters.clear()
        self.failure = ''
        self._clock.restart(0)

    def run_steps(self, count: int, velocity: float | None, force: float | None, stop: Callable[[], bool]
                  ) -> list[StepResult]:
        """Make steps now, under commands (None: those in force), until `stop`; at a boundary only.

        Returns what came of them, of none the latest; when the solver gives up on the way, `failure` says why.
        """
        if count == 0:
            return [] if self.latest is None else [self.latest]
        self._hear()
        self._inputs.put((velocity, force), self._clock.now())
        results: list[StepResult] = []
        try:
            while len(results) < count and not stop() and not self._is_over.is_set():
                self._clock.counters.steps += 1
                results.append(self._make_step(self._clock.now(), 0))
        except SolverError as error:
            self.failure = str(error)
        return results

    def _run(self) -> None:
        wake_precisely()
        self.step_thread.enter()
        try:
            while not self._is_over.is_set():
                self._turn()
        except BaseException as error:
            self.crash = error

    def _turn(self) -> None:
        if self._wake.is_set():
            self._wake.clear()
        try:
            while self._requests and (self.rig.step >= 0 or self.failure):    # first of all a run has its start
                self._requests.popleft()()
            if self._stands_still:
                self._hear()
                self._wake.wait(_IDLE)
            elif self._clock.wait(self.rig.step + 1):
                self._make_due_step()
            elif self.rig.step >= 0:    # a long period: what comes meanwhile is counted, and the latest will hold
                self._hear()
        except SolverError as error:
            self.failure = str(error)

    def _make_due_step(self) -> None:
        counters = self.pacing_counters
        caught_up = counters.caught_up
        begin, lateness = self._clock.begin(self.rig.step + 1)
        if counters.caught_up == caught_up:
            self._core_share.waited(begin)
        self._make_step(begin, lateness)

    @property
    def _stands_still(self) -> bool:
        return bool(self.failure) or ((self.paused or self.by_request) and self.rig.step >= 0)

    def _make_step(self, begin: int, lateness: int) -> StepResult:
        if self.rig.step >= 0:    # the first step is the start, which comes before any command
            self._hear()
        new = self._inputs.take(self._clock.now())
        self._watch()
        result = self.latest = self.rig.make_step(new.velocity, new.force)
        for take in self._sinks:
            take(result)
        end = self._clock.now()
        self.timing_statistics.add(self.rig.time_ns, end - begin, lateness, new.age,
                                   end - new.arrival if new.arrival else None)
        if self.step_thread.is_fifo:
            self._core_share.worked(end)
        return result

    def _watch(self) -> None:
        """Look for a time-out."""
        if not self._watchdog.is_on:
            return
        silence = self._watchdog.silence(self.rig.counts.heard, self._clock.watch_time(self.rig.time_ns))
        if silence:
            self.rig.time_out(silence)
