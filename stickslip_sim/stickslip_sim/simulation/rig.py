# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One axis and its rig, from step to step: commands and orders come in, step results go out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..axis import Axis, InitialState
from ..axis.rows import SampleRow
from ..core.errors import InputError
from ..core.input_profile import InputProfile
from ..core.time_grid import Grid, Instants
from ..core.types import Event, Instant, tuple_of
from ..solvers import Solver
from .drive import CommandChannel, Drive, DriveLimits
from .encoder import Encoder, EncoderSettings, Measured
from .faults import NO_EFFECT, Fault, Faults
from .plant import Plant
from .simulator import Simulator
from .solved_axis import SolverOf, sample_of
from .step_result import Counts, RigEvent, RigEventKind, StepResult

# What a scene says of the rig.

@dataclass(frozen=True, slots=True)
class RigSettings:
    """`on_timeout`: hold, ramp_to_zero or fault, with `timeout_deceleration` (m/s²); `measures`: encoders are read."""

    seed: int = 0
    measures: bool = False
    encoder: EncoderSettings = field(default_factory=EncoderSettings)
    encoder_delay_steps: int = 0
    limits: DriveLimits = field(default_factory=DriveLimits)
    on_timeout: str = 'hold'
    timeout_deceleration: float = 1.0
    faults: tuple[Fault, ...] = ()


# What comes of a step: the record of a sample, a measurement, events at their times and at the start of the step.
StepRow = tuple[SampleRow, Measured | None, list[Event], list[RigEvent]]


class Rig:
    """Makes one step after the other; what is ordered between two takes effect with the next, all of it at once.

    A commanded velocity passes the command channel, and the drive follows it within its limits; a force acts at once.
    Each policy of a command is in one place: its range in the slot where it arrives (`realtime.commands`), which counts
    what it refuses; the reaction to silence here, where commands are refused, and counted, until it is cleared; the
    limits in `Drive`.  Whether something changed since the last step is known to the plant alone.
    """

    def __init__(self, axis: Axis, initial: InitialState, drive: InputProfile, force: InputProfile,
                 solver: Solver | SolverOf,
                 grid: Grid, settings: RigSettings, load: InputProfile | None = None) -> None:
        self.simulator = Simulator(axis, initial, drive, force, solver, accounting=True, load=load)
        self._grid, self._settings, self._measures = grid, settings, settings.measures
        self._profiles = drive, force
        self._begin()

    def reset(self) -> None:
        """Begin anew with step 0; the parameters of the axis stay as they are."""
        self._plant.rewind()
        self._begin()

    def _begin(self) -> None:
        drive, force = self._profiles
        settings = self._settings
        self.step = -1                        # the last one made
        self.counts = Counts()
        self.has_failed = False               # on_timeout: fault; until cleared
        self._faults = Faults(self._grid, settings.faults)
        self._channel = CommandChannel(settings.seed)
        self._plant = Plant(self.simulator, Drive(drive, settings.limits, 1.0 / self._grid.rate),
                            force, self._faults)
        self._encoder = Encoder(settings.encoder, self._grid.rate, settings.encoder_delay_steps, settings.seed)
        self._rig_events: list[RigEvent] = []
        self.is_silent = False                # since a command time-out, until the next command
        self._is_limited = False

    @property
    def time_ns(self) -> int:
        """Simulation time, ns."""
        return self.simulator.time.nanoseconds

    @property
    def fault_ids(self) -> Sequence[str]:
        """The faults that are planned or in force."""
        return self._faults.ids

    @property
    def has_orders(self) -> bool:
        """Whether faults were injected or cleared since the last step."""
        return bool(self._rig_events)

    # Orders, between two steps

    def time_out(self, silence: float) -> None:
        """Do what the scene says when no drive velocity came for `silence` seconds."""
        self.counts.timed_out += 1
        self.is_silent = True
        reaction = self._settings.on_timeout
        self._rig_events.append(RigEvent(RigEventKind.COMMAND_TIMEOUT, 'velocity',
                                         _TIMEOUT.format(silence, _REACTIONS[reaction]), silence))
        self.has_failed = reaction == 'fault'
        if reaction != 'hold':
            self._plant.follow(0.0, self._settings.timeout_deceleration)

    def inject(self, fault: Fault) -> Fault:
        """Plan a fault from now on; return it with its id.  Raises InputError."""
        fault = self._faults.inject(fault, max(self.step + 1, 1))
        self._rig_events.append(RigEvent(RigEventKind.FAULT_INJECTED, fault.id, f'{fault.kind} planned', fault.value,
                                         fault=fault))
        return fault

    def clear_fault(self, fault_id: str) -> None:
        """End a fault now, or before it begins; raises InputError when there is none by that id."""
        fault = self._faults.clear(fault_id)
        self._rig_events.append(RigEvent(RigEventKind.FAULT_CLEARED, fault.id, f'{fault.kind} cleared', fault.value,
                                         fault=fault))
        self._plant.is_changed = True

    def idle_reason(self, fault: Fault) -> str:
        """Return why a fault does nothing here; empty for one that acts."""
        if self._measures or not fault.kind.startswith('encoder_'):
            return ''
        return f'{fault.kind} does nothing: no encoder is read; set joint_interface.enabled: true'

    def clear_faults(self) -> list[str]:
        """End all faults, that of a command time-out among them; return their ids."""
        ids = self._faults.ids
        for fault_id in ids:
            self.clear_fault(fault_id)
        if self.has_failed:
            self.has_failed = False
            self._rig_events.append(RigEvent(RigEventKind.FAULT_CLEARED, '', 'the drive takes commands again'))
        return ids

    def change_axis(self, axis: Axis) -> None:
        """Go on with other parameters."""
        self._plant.change_axis(axis)

    # Checkpoints

    def checkpoint(self) -> dict[str, Any]:
        """Return all that the motion from the next step on depends on beside the scene, as plain data.

        The encoders are left out: what they measure moves nothing.
        """
        self._plant.act()
        return {'step': self.step, 'wire': self._channel.checkpoint(), 'faults': self._faults.checkpoint(),
                'has_failed': self.has_failed, 'notes': len(self._rig_events), **self._plant.checkpoint()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Go on from a checkpoint of a rig of the same scene, with the parameters of the axis that held then.

        Raises InputError, KeyError, TypeError or ValueError when it is none; the rig is of no use then.
        """
        self._plant.restore(saved)
        self._channel.restore(saved['wire'])
        self._faults.restore(saved['faults'])
        self.step, self.has_failed = int(saved['step']), bool(saved['has_failed'])

    # Steps

    def make_step(self, velocity: float | None = None, force: float | None = None) -> StepResult:
        """Make the next step, with a new drive velocity (m/s) and force (N) from its start on, or those in force.

        Raises SolverError, and InputError on a command that is not finite: then nothing has happened.
        """
        row, measured, events, rig_events = self.make_row(velocity, force)
        return tuple_of(StepResult, (self.step, velocity, force, rig_events, events, sample_of(row), measured))

    def make_row(self, velocity: float | None, force: float | None, end: Instant | None = None) -> StepRow:
        """Make the next step as `make_step` does; the record of its sample is filled anew by the next.

        Its `end` need not be calculated where it is known.
        """
        if velocity is not None and not isfinite(velocity):
            raise _not_finite('velocity', velocity, 'm/s')
        if force is not None and not isfinite(force):
            raise _not_finite('force', force, 'N')
        step, faults, plant = self.step + 1, self._faults, self._plant
        if step >= faults.next_change and step > 0:
            self._enter_faults(step)
        if velocity is not None or self._channel.under_way:
            self._command_drive(velocity, step)
        if force is not None:
            plant.push(force)
        if plant.is_changed:
            plant.act()
        rig_events, self._rig_events = self._rig_events, []
        events, row = self.simulator.step(end or self._grid.instant(step))
        self.step = step
        measured = (self._encoder.measure(row.position, row.velocity, row.drive, row.drive_velocity, faults.effect)
                    if self._measures else None)
        return row, measured, events, rig_events

    def advance(self, to: Instant) -> list[Event]:
        """Bring the axis to any time, through the faults of the scene; for runs without steps.  Returns its events."""
        events: list[Event] = []
        while (change := self._next_change()) < to:
            events += self._pass_change(change)
        return events + self.simulator.advance(to)

    def take_samples(self, at: Instants, out: NDArray[np.float64]) -> list[Event]:
        """Bring the axis to one time after the other, as `advance` does, and fill a row with the sample at each.

        Returns the events up to the last.
        """
        events: list[Event] = []
        taken = 0
        while taken < len(out):
            change = self._next_change()
            last = at.before(change, included=True)
            if last > taken:
                events += self.simulator.take_samples(at.part(taken, last), out[taken:last])
                taken = last
            else:
                events += self._pass_change(change)
        return events

    def _next_change(self) -> Instant:
        """Return when the next fault of the scene begins or ends."""
        return self._grid.instant(int(min(self._faults.next_change, _NEVER)) - 1)

    def _pass_change(self, change: Instant) -> list[Event]:
        """Bring the axis to that time, and through it; return its events."""
        events = self.simulator.advance(change)
        self._enter_faults(int(self._faults.next_change))
        self._plant.act()
        return events

    def _command_drive(self, sent: float | None, step: int) -> None:
        channel, effect = self._channel, self._faults.effect
        velocity = sent
        if effect is not NO_EFFECT or channel.under_way:
            if sent is not None and not channel.put(sent, step, effect):
                self.counts.lost += 1
                self._rig_events.append(RigEvent(RigEventKind.COMMAND_LOST, 'velocity', 'a fault ate a command', sent))
            velocity = channel.take(step)
        if velocity is None:
            return
        counts = self.counts
        if self.has_failed:
            counts.refused += 1
            return
        counts.heard += 1
        if self.is_silent:
            self.is_silent = False
            self._rig_events.append(RigEvent(RigEventKind.COMMAND_RESUMED, 'velocity', 'drive velocities come again',
                                             velocity))
        was_limited, self._is_limited = self._is_limited, not self._plant.follow(velocity)
        if self._is_limited:
            counts.limited += 1
            if not was_limited:
                self._rig_events.append(RigEvent(RigEventKind.COMMAND_LIMITED, 'velocity',
                                                 'beyond the limits of the drive, which follows within them', velocity))

    def _enter_faults(self, step: int) -> None:
        ended, begun = self._faults.enter(step)
        for kind, word, faults in ((RigEventKind.FAULT_END, 'ends', ended), (RigEventKind.FAULT_BEGIN, 'begins',
                                                                             begun)):
            self._rig_events.extend(RigEvent(kind, fault.id, f'{fault.kind} {word}', fault.value, fault=fault)
                                    for fault in faults)
        self._plant.is_changed = True


_NEVER = 2**62    # a step that no run reaches
SILENT_BRIDGE = ('a bridge that sends only what differs from the state is silent while they are near (topic-based'
                 ' ros2_control: trigger_joint_command_threshold -1 sends always)')
DRIVE_FAILED = 'fault after a time-out: the drive takes no command until ~/clear_faults or ~/reset'
_TIMEOUT = f'no drive velocity for {{:.3g}} s: {{}}; {SILENT_BRIDGE}'
_REACTIONS = {'hold': 'the latest is held', 'ramp_to_zero': 'the drive stops until the next',
              'fault': 'the drive stops and takes none until ~/clear_faults or ~/reset'}


def _not_finite(name: str, value: float, unit: str) -> InputError:
    return InputError(name, value, f'finite, in {unit}', 'the command before it stays in force')
