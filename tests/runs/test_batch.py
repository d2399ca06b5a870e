# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Many axes at once: the same bits as one by one, on any number of threads; and what is refused."""

import math
import random
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest

from stickslip_sim.axis import Axis, CompliantContact, Friction, InitialState
from stickslip_sim.axis.rows import EventRow
from stickslip_sim.core.errors import InputError
from stickslip_sim.core.types import Event, EventKind, Mode
from stickslip_sim.figures.cycles import Summary, summary
from stickslip_sim.friction import KineticTable, StaticLaw, StaticLawKind, kinetic_table
from stickslip_sim.friction.kinetic import default_excess
from stickslip_sim.friction.shapes import Decay
from stickslip_sim.inputs import load_scene
from stickslip_sim.runs.batch import BATCH_COLUMNS, BatchFigures, run_batch
from stickslip_sim.solvers.exact.axis_figures import AxisFigures
from stickslip_sim.solvers.exact.many_axes import book
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
              'static_time_constant': 0.5, 'static_exponent': 0.7, 'static_backward_initial': 0.14,
              'static_backward_limit': 0.2, 'static_backward_time_constant': 0.1, 'static_backward_exponent': 1.5,
              'kinetic_velocities': [[0.0, 0.02]], 'kinetic_coefficients': [[0.125, 0.06]], 'kinetic_end_slope': 0.1,
              'kinetic_backward_velocities': [[0.0, 0.01, 0.03]], 'kinetic_backward_coefficients': [[0.11, 0.08, 0.04]],
              'kinetic_backward_end_slope': 0.2}
    of_a_law = {f'kinetic_{side}{name}' for side in ('', 'backward_')
                for name in ('initial', 'limit', 'stribeck_velocity', 'exponent', 'viscous')}
    assert values.keys() == BATCH_COLUMNS.keys() - of_a_law
    tables = KineticTable((0.0, 0.02), (0.125, 0.06), 0.1), KineticTable((0.0, 0.01, 0.03), (0.11, 0.08, 0.04), 0.2)
    laws = (StaticLaw(StaticLawKind.KATO, 0.13, 0.3, 0.5, 0.7), StaticLaw(StaticLawKind.KATO, 0.14, 0.2, 0.1, 1.5))
    ahead, back = (Friction(law, table, default_excess(table)) for law, table in zip(laws, tables))
    changed = Axis(300.0, 5e5, 3000.0, 3000.0, CompliantContact(4e6, 1e4), replace(ahead, backward=back))
    feeds = [0.002, -0.002]
    figures = run_batch(axis, 5.0, drive_velocity=feeds, **values)
    for k, feed in enumerate(feeds):
        assert figures.cycles[k] > 1
        assert_same(figures, k, one_by_one(changed, feed, 0.0, InitialState(), 5.0))


def test_a_smooth_law_may_differ_from_axis_to_axis() -> None:
    axis, count = load_scene('stribeck').axis, 4
    law, tolerance = axis.friction.kinetic.law, axis.friction.kinetic.tolerance
    assert law is not None
    speeds, exponents = np.geomspace(0.005, 0.02, count), np.linspace(0.8, 2.0, count)
    figures = run_batch(axis, 4.0, drive_velocity=0.002, kinetic_stribeck_velocity=speeds, kinetic_exponent=exponents)
    for k in range(count):
        table = kinetic_table(replace(law, stribeck_velocity=float(speeds[k]), shape=Decay(float(exponents[k]))),
                              tolerance)
        friction = replace(axis.friction, kinetic=table, excess=default_excess(table))   # which follows v_gr
        assert_same(figures, k, one_by_one(replace(axis, friction=friction), 0.002, 0.0, InitialState(), 4.0))


def test_friction_of_one_direction_changes_alone_or_with_the_other() -> None:
    both = paper_axis(RIGID)
    back = replace(both.friction, static=replace(both.friction.static, limit=0.3))
    sided = replace(both, friction=replace(both.friction, backward=back))
    for axis, limits in ((both, (0.2, 0.2)), (sided, (0.2, 0.3))):   # one friction for both, or one for each
        figures = run_batch(axis, 3.0, drive_velocity=[0.002, -0.002], static_limit=0.2)
        assert figures.break_away_force[0] < 0.2 * 3432.3275
        first = run_batch(axis, 1.2, drive_velocity=[0.002, -0.002], static_limit=0.2).first_break_away
        load = [limit * 3432.3275 - 4000.0 * 0.002 for limit in limits]
        assert first == pytest.approx([force / 6e5 / 0.002 for force in load], rel=1e-12)


@pytest.mark.parametrize('threads', [1, 2, 3, 7])
def test_the_threads_change_no_bit(threads: int) -> None:
    feeds = np.geomspace(1e-4, 2e-2, 1100)   # more than four helpings of a thread
    figures = [run_batch(paper_axis(RIGID), 3.0, drive_velocity=feeds, threads=n) for n in (threads, None)]
    for field in fields(BatchFigures):
        one, other = (getattr(f, field.name) for f in figures)
        assert one.tobytes() == other.tobytes()


def test_plain_python_gives_the_same_bits(in_a_process: Program) -> None:
    assert in_a_process(PROGRAM, compiled=False) == in_a_process(PROGRAM, compiled=True)


def test_pauses_count_in_the_second_half_alone() -> None:
    figures = AxisFigures()
    for second in (1.0, 2.0, 5.0, 7.0, 8.0):   # each slip lasts half a second
        book(figures, [], 0, EventRow(second, 0.0, EventKind.BREAKAWAY, Mode.ACCELERATING), 6.0)
        book(figures, [], 0, EventRow(second, 0.5, EventKind.STICK, Mode.STICK), 6.0)
    assert (figures.sticks, figures.longest_pause) == (4.0, 2.0)


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
    ({'kinetic_coefficients': [0.12, 0.05]}, 'kinetic_coefficients', 'shape (2,)'),
    ({'kinetic_coefficients': [[0.12, 0.05], [0.12, -0.1]]}, 'kinetic_coefficients', '-0.1'),
    ({'kinetic_coefficients': [[0.12, 0.05, 0.01]]}, 'kinetic_coefficients', '3'),
    ({'kinetic_velocities': [[0.0, 0.01], [0.0, 0.0]]}, 'kinetic_velocities', 'index 1'),
    ({'kinetic_coefficients': [[0.13, 0.05]]}, 'static_initial', '0.12'),
    ({'kinetic_backward_coefficients': [[0.13, 0.05]]}, 'static_backward_initial', '0.12'),
    ({'static_backward_limit': [0.2, 0.1]}, 'static_backward_limit', '0.1'),
    ({'kinetic_stribeck_velocity': 0.01}, 'kinetic_stribeck_velocity', 'table'),
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
