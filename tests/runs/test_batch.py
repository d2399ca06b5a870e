# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many axes at once: the same bits as one by one, on any number of threads; and what is refused."""

import math
import random
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest

from stickslip_sim.axis import Axis, CompliantContact, InitialState
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import Event, EventKind, Mode
from stickslip_sim.friction import StaticLaw, StaticLawKind
from stickslip_sim.runs.batch import COLUMNS, BatchFigures, run_batch
from stickslip_sim.simulation.cycles import Summary, summary
from tests.conftest import Program
from tests.support.axes import COMPLIANT, RIGID, instant, make, paper_axis, random_axis

LAST_CYCLE = ('direction', 'rest_time', 'slip_time', 'stick_time', 'period', 'slip_travel', 'jump', 'peak_speed',
              'break_away_force', 'static_coefficient')
PROGRAM = '''
import dataclasses
from stickslip_sim.runs.batch import run_batch
from tests.support.axes import COMPLIANT, RIGID, paper_axis
for contact in (RIGID, COMPLIANT):
    figures = run_batch(paper_axis(contact), 4.0, drive_velocity=[0.0, 0.001, 0.005, -0.03],
                        mass=[350.0, 200.0, 500.0, 350.0])
    for field in dataclasses.fields(figures):
        print(field.name, *(float(value).hex() for value in getattr(figures, field.name)))
'''


def one_by_one(axis: Axis, velocity: float, force: float, initial: InitialState,
               duration: float) -> tuple[list[Event], Summary, Mode]:
    """Return events, summary and the mode at the end of a run of its own."""
    simulator = make(axis, velocity, force, initial)
    start = simulator.sample().mode if initial.velocity != 0.0 else Mode.STICK
    events = simulator.advance(instant(duration))
    return events, summary(events, duration, start), simulator.sample().mode


def assert_same(figures: BatchFigures, k: int, run: tuple[list[Event], Summary, Mode]) -> None:
    events, known, mode = run
    breaks = [e.time for e in events if e.kind == EventKind.REVERSE or
              (e.kind == EventKind.BREAKAWAY and e.mode != Mode.STICK)]
    assert figures.complete[k]
    assert figures.events[k] == len(events)
    assert figures.cycles[k] == known.cycles
    assert figures.final_mode[k] == mode
    assert figures.settled[k] == known.settled
    assert figures.stick_share[k] == pytest.approx(known.stick_share, abs=1e-12)   # one sums exactly, one as it goes
    assert [*breaks[:1]] == [] if math.isnan(figures.first_break_away[k]) else [figures.first_break_away[k]]
    for name in LAST_CYCLE:
        value = getattr(figures, name)[k]
        if known.last is None:
            assert math.isnan(value)
        else:
            assert value == getattr(known.last, name), name


@pytest.mark.parametrize('seed', range(12))
def test_random_axes_give_the_bits_of_runs_of_their_own(seed: int) -> None:
    rng = random.Random(seed)
    axis, count, duration = random_axis(rng), 8, 4.0
    initial = rng.choice((InitialState(), InitialState(0.0, 0.0, 0.1), InitialState(0.001, 0.02, 0.0)))
    masses = [axis.mass * 2.0 ** rng.uniform(-1, 1) for _ in range(count)]
    stiffnesses = [axis.drive_stiffness * 2.0 ** rng.uniform(-1, 1) for _ in range(count)]
    feeds = [rng.choice((-1, 1)) * 10 ** rng.uniform(-3, -1.3) for _ in range(count)]
    forces = [rng.uniform(-100, 100) for _ in range(count)]
    figures = run_batch(axis, duration, drive_velocity=feeds, external_force=forces, initial=initial, mass=masses,
                        drive_stiffness=stiffnesses)
    for k in range(count):
        changed = replace(axis, mass=masses[k], drive_stiffness=stiffnesses[k])
        assert_same(figures, k, one_by_one(changed, feeds[k], forces[k], initial, duration))


def test_every_column_goes_where_its_name_says() -> None:
    axis = paper_axis(COMPLIANT)
    static = replace(axis.friction.static, kind=StaticLawKind.KATO)
    axis = replace(axis, friction=replace(axis.friction, static=static))
    values: dict[str, Any] = {'mass': 300.0, 'drive_stiffness': 5e5, 'drive_damping': 3000.0, 'normal_force': 3000.0,
              'contact_stiffness': 4e6, 'contact_damping': 1e4, 'static_initial': 0.13, 'static_limit': 0.3,
              'static_time_constant': 0.5, 'static_exponent': 0.7}
    assert values.keys() == COLUMNS.keys()
    changed = Axis(300.0, 5e5, 3000.0, 3000.0, CompliantContact(4e6, 1e4), replace(
        axis.friction, static=StaticLaw(StaticLawKind.KATO, 0.13, 0.3, 0.5, 0.7)))
    figures = run_batch(axis, 5.0, drive_velocity=0.002, **values)
    assert figures.cycles[0] > 1
    assert_same(figures, 0, one_by_one(changed, 0.002, 0.0, InitialState(), 5.0))


@pytest.mark.parametrize('threads', [1, 2, 3, 7])
def test_the_threads_change_no_bit(threads: int) -> None:
    feeds = np.geomspace(1e-4, 2e-2, 1100)   # more than four helpings of a thread
    figures = [run_batch(paper_axis(RIGID), 3.0, drive_velocity=feeds, threads=n) for n in (threads, None)]
    for field in fields(BatchFigures):
        one, other = (getattr(f, field.name) for f in figures)
        assert one.tobytes() == other.tobytes()


def test_plain_python_gives_the_same_bits(in_a_process: Program) -> None:
    assert in_a_process(PROGRAM, compiled=False) == in_a_process(PROGRAM, compiled=True)


def test_a_number_stands_for_all_axes() -> None:
    figures = run_batch(paper_axis(RIGID), 3.0, drive_velocity=0.002, mass=[350.0, 350.0, 351.0])
    assert len(figures.events) == 3
    assert figures.period[0] == figures.period[1] != figures.period[2]


@pytest.mark.parametrize(('changes', 'name', 'value'), [
    ({'drive_velocity': math.nan}, 'drive_velocity', 'nan'),
    ({'external_force': [0.0, math.inf]}, 'external_force', 'inf'),
    ({'drive_velocity': []}, 'drive_velocity', 'shape (0,)'),
    ({'drive_velocity': [[0.1]]}, 'drive_velocity', 'shape (1, 1)'),
    ({'drive_velocity': [0.1, 0.2], 'mass': [1.0, 2.0, 3.0]}, 'drive_velocity', '2 values'),
    ({'mass': [350.0, 0.0]}, 'mass', '0.0'),
    ({'mass': -1.0}, 'mass', '-1.0'),
    ({'drive_stiffness': -1.0}, 'drive_stiffness', '-1.0'),
    ({'drive_damping': math.nan}, 'drive_damping', 'nan'),
    ({'normal_force': math.inf}, 'normal_force', 'inf'),
    ({'static_time_constant': 0.0}, 'static_time_constant', '0.0'),
    ({'static_initial': [0.12, 0.1]}, 'static_initial', '0.1'),
    ({'static_limit': 0.11}, 'static_limit', '0.11'),
    ({'contact_stiffness': 5e6}, 'contact_stiffness', 'given'),
    ({'weight': 1.0}, 'weight', 'given')])
def test_what_has_no_meaning_is_refused_by_name(changes: dict[str, Any], name: str, value: str) -> None:
    with pytest.raises(InputError) as refused:
        run_batch(paper_axis(RIGID), 1.0, **{'drive_velocity': 0.001, **changes})
    assert refused.value.name == name
    assert value in str(refused.value)


@pytest.mark.parametrize('duration', [0.0, -1.0, math.inf, math.nan])
def test_a_duration_without_a_meaning_is_refused(duration: float) -> None:
    with pytest.raises(InputError, match='duration'):
        run_batch(paper_axis(RIGID), duration, drive_velocity=0.001)


def test_a_start_that_the_axis_cannot_have_is_refused() -> None:
    with pytest.raises(InputError):
        run_batch(paper_axis(RIGID), 1.0, drive_velocity=0.001, initial=InitialState(0.0, 0.0, -1.0))
