# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The run of a closed loop: like every other, with what was ordered and measured beside."""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import ClassVar

import numpy as np

from ..check.limits import Limits, load_limits, outcomes_of
from ..check.report import Checked
from ..core.arrays import Columns, Numbers
from ..core.types import Event, Mode, Sample
from ..figures.cycles import summary
from ..recording.messages import slider_joint
from ..recording.offline_bag import NO_ORDERS, Orders, write_steps
from ..recording.run import RunFacts
from ..runs import SimulatedRun
from ..runs.run import normal_force_of
from ..runs.samples import HeldSamples
from ..runs.simulated import columns_of_rows, receipt_of
from ..scene import Scene
from ..simulation import Measured, Rig, RigEvent
from ..simulation.step_result import Mark, TimedRigEvent, marks_of_events

_NOTHING = Measured(0.0, 0.0, 0.0, 0.0)    # before the first measurement


class LoopRecord:
    """What came of the steps so far; `start` is the mode at the start."""

    def __init__(self, start: Mode) -> None:
        self.start = start
        self.rows: list[bytes] = []                                        # the numbers of samples
        self.measured: list[Measured | None] = []
        self.commands: list[tuple[int, float | None, float | None]] = []   # step from which on, m/s, N
        self.events: list[tuple[int, Event]] = []                          # step into which it fell
        self.rig_events: list[tuple[int, RigEvent]] = []

    def note(self, step: int, events: list[Event], rig_events: list[RigEvent]) -> None:
        """Take what happened in a step, and to the rig at its start."""
        self.events += [(step, event) for event in events]
        self.rig_events += [(step, event) for event in rig_events]


@dataclass(frozen=True, eq=False)
class ClosedLoopRun(SimulatedRun):
    """A run whose drive followed a controller.

    `told` is what was measured at each step; a setpoint, if there is one, is known at each step.
    """

    told: Sequence[Measured | None] = ()
    orders: Orders = NO_ORDERS
    controller: str = ''
    is_commanded: ClassVar[bool] = True

    @classmethod
    def of(cls, scene: Scene, record: LoopRecord, rig: Rig, controller: str, every: int, wanted: Numbers | None,
           cost: tuple[float, float]) -> 'ClosedLoopRun':
        """Return the run of a rig that was made so far, with what it cost (CPU and wall time, s)."""
        columns = columns_of_rows(np.frombuffer(b''.join(record.rows)).reshape(-1, len(Sample._fields)))
        time, simulator, events = columns['time'], rig.simulator, [event for _, event in record.events]
        end = max(float(time[-1]), float(scene.time.step))
        figures = summary(events, end, record.start)
        receipt = receipt_of(scene, end, float(scene.time.step), figures, simulator.root_iterations,
                             simulator.sample(), simulator.energy, *cost)
        receipt['controller'] = {'name': controller, 'rate': scene.time.rate / every}
        receipt['commands'] = {'received': len(record.commands), **{
            name: getattr(rig.counts, name) for name in ('refused', 'lost', 'limited', 'timed_out')}}
        setpoint = {} if wanted is None else {'time': time, 'position': wanted[:len(time), 0],
                                              'velocity': wanted[:len(time), 1]}
        orders = Orders(record.commands, record.events, record.rig_events)
        return cls(scene, end, None, events, HeldSamples({**columns, **normal_force_of(scene, time)}), figures, receipt,
                   setpoint=setpoint, orders=orders, controller=controller, told=record.measured)

    @property
    def source(self) -> str:
        """Which controller drove it, and for how long."""
        return f'simulated for {self.duration:g} s with {self.controller} in the loop'

    @cached_property
    def measured(self) -> Columns:
        """What was measured at each step, by the fields of Measurement; where it was lost, what was measured before."""
        lost = np.array([one is None for one in self.told])
        latest = np.maximum.accumulate(np.where(lost, 0, np.arange(len(lost))))
        rows = np.array([one or _NOTHING for one in self.told], dtype=np.float64)[latest]
        return {'time': self.samples['time'], **{name: rows[:, i] for i, name in enumerate(Measured._fields)},
                'drive_force': self.samples['drive_force'], 'is_lost': lost}

    @property
    def commands(self) -> Columns:
        """The velocities that were ordered, each at the start of the first step in which it holds."""
        (steps, velocities), _ = self.orders.commanded()
        return {'time': self.samples['time'][steps - 1], 'velocity': velocities}

    @property
    def marks(self) -> list[Mark]:
        """When faults were in force, and commands lost, limited or missing."""
        times = self.samples['time']
        return marks_of_events((TimedRigEvent(float(times[max(step - 1, 0)]), event.kind, event.id,
                                              event.fault.kind if event.fault else '', event.number)
                                for step, event in self.orders.rig_events), self.begin, self.end)

    def check(self, limits: Limits | str | os.PathLike[str]) -> Checked:
        """Return the outcome of each limit in a file (docs/check.md), `passed` for all; raises InputError."""
        limits = limits if isinstance(limits, Limits) else load_limits(os.fspath(limits))
        return Checked(self.name, self, outcomes_of(limits, self))

    def save(self, folder: Path | str) -> None:
        """Record the run as a bag, that of a node in lock-step with this controller.

        Raises RecordingError; a folder that exists is not touched, one that was begun vanishes on an error.
        """
        write_steps(folder, RunFacts.of(self.scene), self.samples, self.orders, self.receipt, self.setpoint,
                    slider_joint(self.scene.joint_prefix))
