# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Rigs without ROS, and orders for them by step, which can be given again: also those of a recorded run."""

import random
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from stickslip_sim.axis import Axis, InitialState
from stickslip_sim.core.input_profile import InputProfile, constant
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.recording import Bag
from stickslip_sim.scene import Scene, scene_from_values
from stickslip_sim.simulation import Fault, Rig, RigEventKind, StepResult
from stickslip_sim.simulation.faults import RULES
from stickslip_sim.simulation.rig import RigSettings
from stickslip_sim.solvers import Solver, exact
from tests.support.axes import COMPLIANT, RIGID, paper_axis


class Command(NamedTuple):
    """What a step is made with: m/s and N."""

    velocity: float | None = None
    force: float | None = None


Order = Callable[[Rig], object] | Command
Script = Mapping[int, Iterable[Order]]

RATE = 1000.0
STUCK = paper_axis(RIGID)       # breaks away at 823.8 N after prolonged rest
AXIS = paper_axis(COMPLIANT)


def make(axis: Axis = AXIS, drive: InputProfile | float = 0.002, force: InputProfile | float = 0.0, rate: float = RATE,
         **settings: Any) -> Rig:
    def profile(given: InputProfile | float) -> InputProfile:
        return given if isinstance(given, InputProfile) else constant(given)

    return Rig(axis, InitialState(), profile(drive), profile(force), exact.SOLVER, Grid(rate), RigSettings(**settings))


def tired_after(time: float) -> Solver:
    """Return the exact solver, which gives up at a time."""
    def advance(p: Any, s: Any, second: float, fraction: float, events: Any, row: int) -> Any:
        if second + fraction > time:
            return row, -1
        return exact.SOLVER.advance(p, s, second, fraction, events, row)

    return exact.SOLVER._replace(advance=advance, step=None)


def run(rig: Rig, steps: int, script: Script | None = None) -> list[StepResult]:
    """Make steps; orders of a step are given before it."""
    results = []
    for _ in range(steps):
        results.append(rig.make_step(*given(rig, (script or {}).get(rig.step + 1, ()))))
    return results


def given(rig: Rig, orders: Iterable[Order]) -> Command:
    """Give orders to a rig; return the commands among them, the last of each kind."""
    commands = Command()
    for order in orders:
        if isinstance(order, Command):
            commands = Command(*(old if new is None else new for old, new in zip(commands, order)))
        else:
            order(rig)
    return commands


def velocity(value: float) -> Order:
    return Command(velocity=value)


def force(value: float) -> Order:
    return Command(force=value)


def inject(kind: str, start: float = 0.0, duration: float = 0.05, value: float = 0.0, name: str = '') -> Order:
    return lambda rig: rig.inject(Fault(name, kind, start, duration, value))


def rig_events_of(results: Iterable[StepResult]) -> list[tuple[int, RigEventKind]]:
    """Return the kinds of rig events, by step."""
    return [(result.step, event.kind) for result in results for event in result.rig_events]


def bits(results: Iterable[Any]) -> list[str]:
    """Return what differs when a single bit does, −0.0 and 0.0 included."""
    return [repr(result) for result in results]


def random_script(seed: int, steps: int) -> Script:
    """Return orders of all kinds, about one in ten steps."""
    stream = random.Random(seed)
    return {step: [_random_order(stream) for _ in range(stream.randint(1, 3))]
            for step in sorted(stream.sample(range(steps), steps // 10))}


def _random_order(stream: random.Random) -> Order:
    speed, push, mass = stream.uniform(-0.02, 0.02), stream.uniform(-900.0, 900.0), stream.uniform(300.0, 400.0)
    kind = stream.choice([*RULES])
    value = {'friction_scale': stream.uniform(0.1, 3.0), 'force_pulse': stream.uniform(-500.0, 500.0),
             'encoder_step': 1e-4, 'encoder_dropout': 0.5, 'command_loss': 0.5, 'command_delay': 0.007}.get(kind, 0.0)
    fault = Fault('', kind, stream.choice([0.0, 0.01]), stream.choice([0.001, 0.02]), value)
    return stream.choice([
        velocity(speed), velocity(speed),
        force(push), lambda rig: rig.inject(fault),
        lambda rig: rig.change_axis(replace(AXIS, mass=mass)), lambda rig: rig.time_out(0.5),
        lambda rig: rig.clear_faults()])


FIELDS = ('time', 'position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force',
          'rest_time', 'mode', 'direction')


def orders_of(recorded: Bag, scene: Scene) -> Script:
    """Return the orders of a bag, by the step before which they came."""
    orders: dict[int, list[Order]] = defaultdict(list)
    values = dict(scene.values)
    for message in recorded.messages(['/drive_velocity', '/external_force', '/parameter_events', '/rig_event']):
        content = recorded.decode(message)
        if message.topic == '/parameter_events':
            values |= {changed.name: changed.value.double_value for changed in content.changed_parameters}
            orders[message.sequence].append(_change(scene_from_values(values)))
        elif message.topic == '/rig_event':
            orders[message.sequence] += _of_event(content)
        else:
            orders[message.sequence].append(_command(content))
    return orders


def made_again(recorded: Bag, scene: Scene) -> list[StepResult]:
    """Return what a rig makes of the orders of a bag, over as many steps."""
    return run(scene.make_rig(), recorded.counts['/slider_state'], orders_of(recorded, scene))


def assert_same_states(recorded: Bag, results: list[StepResult]) -> None:
    """Compare the states of a bag with those of a rig, bit by bit."""
    states = recorded.columns('/slider_state')
    assert list(states['step']) == [result.step for result in results]
    for name in FIELDS:
        ours = np.array([getattr(result.sample, name) for result in results])
        np.testing.assert_array_equal(states[name], ours, err_msg=name)


def rig_events_in(recorded: Bag, *kinds: RigEventKind) -> list[Any]:
    """Return the rig events of some kinds in a bag."""
    return [event for event in map(recorded.decode, recorded.messages(['/rig_event'])) if event.kind in kinds]


def _command(message: Any) -> Order:
    if hasattr(message, 'velocity'):
        return velocity(message.velocity)
    return force(message.force)


def _change(scene: Scene) -> Order:
    return lambda rig: rig.change_axis(scene.axis)


def _of_event(event: Any) -> list[Order]:
    if event.kind == RigEventKind.FAULT_INJECTED:
        return [lambda rig: rig.inject(Fault(event.id, event.fault, event.start, event.duration, event.value))]
    if event.kind == RigEventKind.FAULT_CLEARED:
        return [lambda rig: rig.clear_fault(event.id)]
    if event.kind == RigEventKind.COMMAND_TIMEOUT:
        return [lambda rig: rig.time_out(event.value)]
    return []


class FakeClock:
    """Time that passes only when somebody sleeps or says so."""

    def __init__(self) -> None:
        self.time = 5_000_000_000

    def now(self) -> int:
        return self.time

    def sleep(self, seconds: float) -> None:
        self.time += round(seconds * 1e9)
