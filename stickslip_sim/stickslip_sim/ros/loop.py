"""The step loop: a thread that brings the axis from step to step on absolute deadlines.  Knows no ROS.

Step n ends at n / rate (step 0 is the start); at that instant on the steady clock the loop advances the axis to it,
hands out the events and the state, then lets the latest commands take effect: they hold from step n + 1 on.
"""

import threading
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import NamedTuple, Protocol

from ..commands import Command, CommandSlot
from ..errors import SolverError
from ..pacing import Grid, Pacer, wake_precisely
from ..simulator import Simulator
from ..words import Event, Sample
from .timing import Window

_IDLE = 0.01            # s between two looks at the requests while time stands still
_PATIENCE = 5.0         # s that a request waits for its boundary


class Output(Protocol):
    """What takes the products of the steps, in the loop's thread."""

    def event(self, step: int, event: Event) -> None:
        """Take an event that fell into a step."""

    def sample(self, step: int, sample: Sample) -> None:
        """Take the state at the end of a step."""

    def command(self, kind: int, step: int, time_ns: int, value: float) -> None:
        """Take a command that holds from the begin of a step on; `kind` is its place among the inputs."""


class Input(NamedTuple):
    """A slot and what to do with a command in it."""

    slot: CommandSlot
    apply: Callable[[float], None]


class StepLoop:
    """Runs the steps in a thread of its own; everything else asks for changes `at_boundary`."""

    def __init__(self, simulator: Simulator, grid: Grid, pacer: Pacer, slots: Sequence[CommandSlot],
                 output: Output) -> None:
        self.simulator = simulator
        self.step = -1                       # the last one made; step 0 ends at time 0
        self.paused = False
        self.failure = ''                    # why the solver gave up; time stands still then
        self.crash: BaseException | None = None
        self.window = Window()
        self._grid, self._pacer, self._output = grid, pacer, output
        self._inputs = [Input(slot, apply) for slot, apply in
                        zip(slots, (simulator.command_velocity, simulator.command_force))]
        self._held: list[Command | None] = [None] * len(self._inputs)
        self._requests: deque[Callable[[], None]] = deque()
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._run, name='steps', daemon=True)

    @property
    def time_ns(self) -> int:
        """Simulation time, ns."""
        return self.simulator.time.nanoseconds

    def start(self) -> None:
        """Begin with step 0, now."""
        self._thread.start()

    def stop(self) -> None:
        """Let the step at hand be the last, and wait for it, but not for ever."""
        self._is_over.set()
        if self._thread.ident is not None:
            self._thread.join(_PATIENCE)

    def at_boundary(self, action: Callable[[], None]) -> bool:
        """Have an action done between two steps by the loop's thread; wait for it and return whether it was done."""
        done = threading.Event()

        def do() -> None:
            action()
            done.set()

        self._requests.append(do)
        if not done.wait(_PATIENCE):
            with suppress(ValueError):    # it was begun after all
                self._requests.remove(do)
                return False
        return done.wait(_PATIENCE)

    def pause(self, paused: bool) -> None:
        """Let simulation time stand still, or go on from where it stands; at a boundary only."""
        if self.paused and not paused:
            self._pacer.restart(self.step + 1)
        self.paused = paused

    def restart(self) -> None:
        """Begin anew with step 0 and the initial state, without commands; at a boundary only."""
        for i, taken in enumerate(self._inputs):
            taken.slot.forget()
            self._held[i] = None
        self.simulator.reset()
        self.step = -1
        self.failure = ''
        self._pacer.restart(0)

    def repeat_commands(self) -> None:
        """Hand out the commands in force once more; at a boundary only."""
        for kind, command in enumerate(self._held):
            if command is not None:
                self._output.command(kind, self.step + 1, self.time_ns, command.value)

    def _run(self) -> None:
        wake_precisely()
        self._pacer.restart(0)
        try:
            while not self._is_over.is_set():
                self._turn()
        except BaseException as error:
            self.crash = error

    def _turn(self) -> None:
        try:
            while self._requests:
                self._requests.popleft()()
            if self.paused or self.failure:
                self._pacer.idle(_IDLE)
            elif self._pacer.wait(self.step + 1):
                self._make_step(self.step + 1)
        except SolverError as error:
            self.failure = str(error)

    def _make_step(self, step: int) -> None:
        begin, lateness = self._pacer.begin(step)
        simulator, output = self.simulator, self._output
        for event in simulator.advance(self._grid.instant(step)):
            output.event(max(step, 1), event)
        output.sample(step, simulator.sample())
        self.step = step
        arrival = self._take_commands(step)
        self.window.add(self._pacer.now() - begin, lateness, begin - arrival if arrival else None)

    def _take_commands(self, step: int) -> int:
        """Apply what is new; return when the newest command in force arrived, 0 when there is none."""
        newest = 0
        for kind, (slot, apply) in enumerate(self._inputs):
            command = slot.latest
            if command is None:
                continue
            if command is not self._held[kind]:
                apply(command.value)
                self._held[kind] = command
                self._output.command(kind, step + 1, self.time_ns, command.value)
            newest = max(newest, command.arrival)
        return newest
