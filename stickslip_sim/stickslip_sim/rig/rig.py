# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""One axis and its rig, from step to step: orders come in, products go out."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ..axis import Axis, InitialState
from ..core.errors import InputError
from ..core.input_profile import InputProfile
from ..core.time_grid import Grid
from ..core.types import Event, Instant
from ..simulation.simulator import Simulator, SolverOf
from ..solvers import Solver
from .command_channel import CommandChannel
from .drive import Drive
from .encoder import Encoder
from .faults import Fault, Faults
from .plant import Plant
from .settings import RigSettings
from .step_result import Counts, RigEvent, RigEventKind, StepResult


class Rig:
    """Makes one step after the other; orders take effect with the next step, all that came before it at once.

    Drive velocities come through the wire and are followed by the drive within its limits; forces act at once.
    """

    def __init__(self, axis: Axis, initial: InitialState, drive: InputProfile, force: InputProfile,
                 solver: Solver | SolverOf,
                 grid: Grid, settings: RigSettings) -> None:
        self.simulator = Simulator(axis, initial, drive, force, solver, accounting=True)
        self._grid, self._settings = grid, settings
        self._courses = drive, force
        self._begin()

    def reset(self) -> None:
        """Begin anew with step 0; the parameters of the axis stay as they are."""
        self._plant.rewind()
        self._begin()

    def _begin(self) -> None:
        drive, force = self._courses
        settings = self._settings
        self.step = -1                        # the last one made
        self.counts = Counts()
        self.has_failed = False               # on_timeout: fault; until cleared
        self._faults = Faults(self._grid, settings.faults)
        self._channel = CommandChannel(self._grid, settings.seed)
        self._plant = Plant(self.simulator, Drive(drive, settings.limits), force, self._faults)
        self._velocity_order: float | None = None
        self._force_order: float | None = None
        self._encoder = Encoder(settings.encoder, self._grid.rate, settings.encoder_delay_steps, settings.seed)
        self._notes: list[RigEvent] = []
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

    # Orders, between two steps

    def command_velocity(self, velocity: float) -> None:
        """Send the drive a velocity, m/s; of several before one step the last counts."""
        _check_finite('velocity', velocity, 'm/s')
        self._velocity_order = velocity

    def command_force(self, force: float) -> None:
        """Let a force act on the slider, N."""
        _check_finite('force', force, 'N')
        self._force_order = force

    def time_out(self, silence: float) -> None:
        """Do what the scene says when no drive velocity came for `silence` seconds."""
        self.counts.timed_out += 1
        self.is_silent = True
        reaction = self._settings.on_timeout
        self._notes.append(RigEvent(RigEventKind.COMMAND_TIMEOUT, 'velocity', _TIMEOUT.format(silence,
                                                                                              _REACTIONS[reaction]),
                                silence))
        self.has_failed = reaction == 'fault'
        if reaction != 'hold':
            self._plant.drive.follow(0.0, self.simulator.time, self._settings.timeout_deceleration)

    def inject(self, fault: Fault) -> Fault:
        """Plan a fault from now on; return it with its id.  Raises InputError."""
        fault = self._faults.inject(fault, max(self._next, 1))
        self._notes.append(RigEvent(RigEventKind.FAULT_INJECTED, fault.id, f'{fault.kind} planned', fault.value,
                                    fault=fault))
        return fault

    def clear_fault(self, fault_id: str) -> None:
        """End a fault now, or before it begins; raises InputError when there is none by that id."""
        fault = self._faults.clear(fault_id)
        self._notes.append(RigEvent(RigEventKind.FAULT_CLEARED, fault.id, f'{fault.kind} cleared', fault.value,
                                    fault=fault))
        self._plant.change_faults()

    def clear_faults(self) -> list[str]:
        """End all faults, that of a command time-out among them; return their ids."""
        ids = self._faults.ids
        for fault_id in ids:
            self.clear_fault(fault_id)
        if self.has_failed:
            self.has_failed = False
            self._notes.append(RigEvent(RigEventKind.FAULT_CLEARED, '', 'the drive takes commands again'))
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
                'has_failed': self.has_failed, 'notes': len(self._notes), **self._plant.checkpoint()}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Go on from a checkpoint of a rig of the same scene, with the parameters of the axis that held then.

        Raises InputError, KeyError, TypeError or ValueError when it is none; the rig is of no use then.
        """
        self._plant.restore(saved)
        self._channel.restore(saved['wire'])
        self._faults.restore(saved['faults'])
        self.step, self.has_failed = int(saved['step']), bool(saved['has_failed'])

    # Steps

    def make_step(self) -> StepResult:
        """Make the next step; raises SolverError."""
        step = self._next
        if step >= self._faults.next_change and step > 0:
            self._enter_faults(step)
        velocity, force = self._velocity_order, self._force_order
        if velocity is not None or not self._channel.is_empty:
            self._obey_velocity(velocity, step)
        if force is not None:
            self._force_order = None
            self._plant.command_force(force)
        self._plant.act()
        notes, self._notes = self._notes, []
        events = self.simulator.advance(self._grid.instant(step))
        sample = self.simulator.sample()
        self.step = step
        measured = self._encoder.measure(sample, self._faults.active) if self._settings.measures else None
        return StepResult(step, velocity, force, notes, events, sample, measured)

    def advance(self, to: Instant) -> list[Event]:
        """Bring the axis to any time, through the faults of the scene; for runs without steps.  Returns its events."""
        events: list[Event] = []
        while (begin := self._grid.instant(int(min(self._faults.next_change, _NEVER)) - 1)) < to:
            events += self.simulator.advance(begin)
            self._enter_faults(int(self._faults.next_change))
            self._plant.act()
        return events + self.simulator.advance(to)

    @property
    def _next(self) -> int:
        return self.step + 1

    def _obey_velocity(self, sent: float | None, step: int) -> None:
        self._velocity_order = None
        if sent is not None and not self._channel.put(sent, step, self._faults.active):
            self.counts.lost += 1
            self._notes.append(RigEvent(RigEventKind.COMMAND_LOST, 'velocity', 'a fault ate a command', sent))
        velocity = self._channel.take(step)
        if velocity is None:
            return
        if self.has_failed:
            self.counts.refused += 1
            return
        self.counts.heard += 1
        if self.is_silent:
            self.is_silent = False
            self._notes.append(RigEvent(RigEventKind.COMMAND_RESUMED, 'velocity', 'drive velocities come again',
                                        velocity))
        self._tell_limits(velocity)
        self._plant.drive.follow(velocity, self.simulator.time)

    def _tell_limits(self, velocity: float) -> None:
        can_follow = self._plant.drive.can_follow(velocity, self.simulator.time)
        was_limited, self._is_limited = self._is_limited, not can_follow
        self.counts.limited += self._is_limited
        if self._is_limited and not was_limited:
            self._notes.append(RigEvent(RigEventKind.COMMAND_LIMITED, 'velocity',
                                    'beyond the limits of the drive, which follows within them', velocity))

    def _enter_faults(self, step: int) -> None:
        ended, begun = self._faults.enter(step)
        for kind, word, faults in ((RigEventKind.FAULT_END, 'ends', ended), (RigEventKind.FAULT_BEGIN, 'begins',
                                                                             begun)):
            self._notes.extend(RigEvent(kind, fault.id, f'{fault.kind} {word}', fault.value, fault=fault)
                               for fault in faults)
        self._plant.change_faults()


_NEVER = 2**62    # a step that no run reaches
SILENT_BRIDGE = ('a bridge that sends only what differs from the state is silent while they are near (topic-based'
                 ' ros2_control: trigger_joint_command_threshold -1 sends always)')
FAILED = 'fault after a time-out: the drive takes no command until ~/clear_faults or ~/reset'
_TIMEOUT = f'no drive velocity for {{:.3g}} s: {{}}; {SILENT_BRIDGE}'
_REACTIONS = {'hold': 'the latest is held', 'ramp_to_zero': 'the drive stops until the next',
              'fault': 'the drive stops and takes none until ~/clear_faults or ~/reset'}


def _check_finite(name: str, value: float, unit: str) -> None:
    if not math.isfinite(value):
        raise InputError(name, value, f'finite, in {unit}', 'the command before it stays in force')
