# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Long input profiles: the same bits compiled or not, piece by piece, and however time is split."""

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from stickslip_sim.axis import InitialState, pack
from stickslip_sim.axis.records import PLAIN
from stickslip_sim.core import hot_path
from stickslip_sim.core.errors import InputError, UnsoundError
from stickslip_sim.core.input_profile import InputProfile, constant, sinusoids, steps, table
from stickslip_sim.core.time_grid import instants
from stickslip_sim.core.types import Event, Instant, Sample
from stickslip_sim.simulation.simulator import Simulator
from stickslip_sim.solvers import DONE, FULL, PieceWalk, Solver, SolverOfFunctions, exact, fixed_step, with_advance
from stickslip_sim.solvers.exact import engine
from stickslip_sim.solvers.exact.pieces import Pieces, enter_pieces
from stickslip_sim.solvers.walk import walk_of
from tests.conftest import Program
from tests.support.axes import COMPLIANT, instant, paper_axis
from tests.support.forced_profiles import with_sinusoids

DURATION = 3.0
PIECES = 3000
ONE_BY_ONE = with_advance(exact.SOLVER, exact.advance)   # without a walk of its own
AXIS = paper_axis(COMPLIANT)


def _enter(p: Any, s: Any, drive: Pieces, force: Pieces, *others: Any) -> tuple[float, int, int]:
    return enter_pieces(p, s, drive, force, Pieces(None), *others)


def _never(*_: Any) -> tuple[int, float, int, int]:
    raise NotImplementedError


IN_PYTHON = SolverOfFunctions('exact', engine.start, engine.advance, engine.set_inputs, engine.set_parameters,
                              engine.set_load, engine.sample, records=PLAIN, walk=PieceWalk(Pieces, _enter, _never))
START = 0.0, 0.0, math.inf, 0.0, 0.0   # those of InitialState()
Bits = list[tuple[float, ...]]


def profiles(kind: str) -> tuple[InputProfile, InputProfile]:
    """Return a drive and a force of thousands of pieces; some begin at the same time."""
    rng = random.Random(kind)
    times = [k * DURATION / PIECES for k in range(PIECES)]
    velocities = [0.01 + 0.02 * math.sin(40.0 * t) + rng.uniform(-2e-3, 2e-3) for t in times]
    if kind == 'held':
        velocities[200:900] = [0.01] * 700
    drive = table('drive', times, velocities)
    if kind == 'periods':
        drive = table('drive', times[:900], velocities[:900], DURATION / 3.1)
    forces = [rng.uniform(-1.0, 1.0) * 0.05 * AXIS.normal_force for _ in range(400)]
    begins = [0.0, *sorted(rng.sample(times[1:1000], 199)), *sorted(rng.uniform(1.0, 2.5) for _ in range(200))]
    force = steps('force', begins, forces, 2.6 if kind == 'periods' else math.inf)
    if kind == 'sinusoids':
        return with_sinusoids(drive, (5e-3, 31.0, 0.3)), with_sinusoids(force, (0.03 * AXIS.normal_force, 7.0, 1.0))
    return drive, force


def make(kind: str, solver: Solver = exact.SOLVER) -> Simulator:
    drive, force = profiles(kind)
    return Simulator(AXIS, InitialState(), drive, force, solver, accounting=True)


def bits(events: Sequence[Event]) -> Bits:
    return [tuple(map(float, event)) for event in events]


def advance(simulator: Simulator, calls: int, begin: float = 0.0) -> Bits:
    return [row for k in range(1, calls + 1)
            for row in bits(simulator.advance(instant(begin + (DURATION - begin) * k / calls)))]


def run_in(kind: str, calls: int) -> list[str]:
    """Return all that a run gives, in hexadecimal."""
    simulator = make(kind)
    events = advance(simulator, calls)
    rows = [*events, simulator.sample(), simulator.energy or ()]
    return [' '.join(float(number).hex() for number in row) for row in rows]


KINDS = ['plain', 'held', 'periods', 'sinusoids']


@pytest.mark.parametrize('kind', KINDS)
@pytest.mark.parametrize('calls', [1, 7, 4001])
def test_a_walk_gives_the_bits_of_one_piece_after_the_other(kind: str, calls: int) -> None:
    one, other = make(kind), make(kind, ONE_BY_ONE)
    events = advance(one, calls)
    assert len(events) > 100
    assert events == advance(other, calls)
    assert one.checkpoint() == other.checkpoint()
    assert (one.sample(), one.energy, one.event_counts) == (other.sample(), other.energy, other.event_counts)
    assert one.root_iterations == other.root_iterations


def sampled(kind: str, solver: Solver, blocks: int, rate: int = 1300) -> tuple[Bits, bytes, Simulator]:
    """Return the events and the samples of a run that takes them in blocks."""
    simulator = make(kind, solver)
    at = instants(Fraction(1, rate), 0, int(DURATION * rate) + 1)
    rows = np.empty((len(at.seconds), len(Sample._fields)))
    ends = [len(rows) * k // blocks for k in range(blocks + 1)]
    events = [row for first, last in pairwise(ends)
              for row in bits(simulator.take_samples(at.part(first, last), rows[first:last]))]
    return events, rows.tobytes(), simulator


@pytest.mark.parametrize('kind', KINDS)
@pytest.mark.parametrize('rate', [1300, 7])   # many samples a piece, or pieces a sample: a table fills
def test_samples_through_pieces_have_the_bits_of_those_one_by_one(kind: str, rate: int) -> None:
    simulator = make(kind, ONE_BY_ONE)
    events, samples = [], []
    for time in map(Instant, *(column.tolist() for column in instants(Fraction(1, rate), 0, int(DURATION * rate) + 1))):
        events += bits(simulator.advance(time))
        samples.append(simulator.sample())
    assert len(events) > 100
    for solver, blocks in ((exact.SOLVER, 1), (exact.SOLVER, 5), (ONE_BY_ONE, 1)):
        own, rows, other = sampled(kind, solver, blocks, rate)
        assert own == events
        assert rows == np.array(samples).tobytes()
        assert (other.sample(), other.energy, other.time) == (simulator.sample(), simulator.energy, simulator.time)
        assert other.event_counts == simulator.event_counts


@pytest.mark.parametrize('kind', KINDS)
def test_the_split_of_time_changes_no_bit(kind: str) -> None:
    whole = run_in(kind, 1)
    assert all(run_in(kind, calls) == whole for calls in (333, 4001))


@pytest.mark.skipif(hot_path.UNIT is None, reason='no compiled code in this source tree')
def test_plain_python_gives_the_same_bits(in_a_process: Program) -> None:
    program = ('from tests.simulation.test_long_profiles import KINDS, run_in\n'
               'print(*(line for kind in KINDS[1:] for line in run_in(kind, 3)), sep="\\n")')    # pieces are in all
    assert in_a_process(program, compiled=False).split('\n')[:-1] == [
        line for kind in KINDS[1:] for line in run_in(kind, 3)]


@pytest.mark.parametrize('solver', [exact.SOLVER, ONE_BY_ONE, IN_PYTHON], ids=['walk', 'one by one', 'in Python'])
@pytest.mark.parametrize('room', [1, 2, 3, 64])
def test_a_table_that_fills_in_mid_walk_loses_no_event(solver: Solver, room: int) -> None:
    simulator = make('plain')
    of, walk = solver.records, walk_of(solver)
    p, s, sinusoids, events = of.Parameters(pack(AXIS)), of.State(0), of.Sinusoids([]), of.Events(room)
    s.accounting = 1.0
    drive, force = profiles('plain')
    v, f = drive.piece_at(0.0), force.piece_at(0.0)
    rows = solver.start(p, s, *START, v.value, v.rate, f.value, f.rate, sinusoids, events, 0)
    until, found, filled = min(v.end, f.end), [events.row(i) for i in range(rows)], 0
    pieces = walk.pieces_of(drive), walk.pieces_of(force)
    end = FULL
    while end == FULL:
        until, rows, end = walk.run(p, s, *pieces, until, 2.0, sinusoids, events, 0)
        found += [events.row(i) for i in range(rows)]
        filled += end == FULL
    assert end == DONE
    assert until > 2.0
    assert filled == len(found) // room > 0
    assert [tuple(map(float, row)) for row in found] == bits(simulator.advance(instant(2.0)))


def doctored(solver: Solver) -> Solver:
    """Return a solver with energy that the run never had, from the first walk through pieces on."""
    walk = walk_of(solver)

    def spoilt(way: Callable[..., Any]) -> Callable[..., Any]:
        def spoil(p: Any, s: Any, *arguments: Any) -> Any:
            s.stored_at_start += 1e3   # J
            return way(p, s, *arguments)

        return spoil

    spoilt_walk = walk._replace(run=spoilt(walk.run), sample=spoilt(walk.sample))
    return solver._replace(walk=spoilt_walk)   # type: ignore[attr-defined, no-any-return]


@pytest.mark.parametrize('takes_samples', [False, True])
def test_a_run_that_gives_up_in_mid_walk_says_when_and_stands_there(takes_samples: bool) -> None:
    ends = []
    at, rows = instants(Fraction(1, 1000), 0, 2000), np.empty((2000, len(Sample._fields)))
    for solver in (exact.SOLVER, ONE_BY_ONE):
        simulator = make('plain', doctored(solver))
        go = partial(simulator.take_samples, at, rows) if takes_samples else partial(simulator.advance, instant(2.0))
        with pytest.raises(UnsoundError, match='violates its own motion or energy balance at t = ') as failure:
            go()
        assert 0.0 < simulator.time.seconds < 0.5
        assert repr(simulator.time.seconds) in str(failure.value)
        ends.append((str(failure.value), simulator.time, simulator.sample()))
    assert ends[0] == ends[1]


def test_commands_in_between_and_a_checkpoint_go_on_with_the_pieces() -> None:
    ends = []
    for solver in (exact.SOLVER, ONE_BY_ONE):
        simulator, (drive, force) = make('plain', solver), profiles('plain')
        events = bits(simulator.advance(instant(0.7003)))
        simulator.command_drive(0.02)
        events += bits(simulator.advance(instant(1.1)))
        simulator.command_drive(drive)
        simulator.command_force(-0.0)
        events += bits(simulator.advance(instant(1.9)))
        other = make('plain', solver)
        other.restore(simulator.checkpoint(), AXIS, drive, -0.0)
        simulator.command_force(force)
        other.command_force(force)
        rest = advance(simulator, 3, 1.9)
        assert rest == advance(other, 5, 1.9)
        ends.append((events + rest, simulator.checkpoint()))
    assert ends[0] == ends[1]


def test_a_solver_without_a_walk_of_its_own_takes_every_piece() -> None:
    solver = fixed_step.solver('euler', 1e-3)
    assert solver.walk is None
    once, often = make('plain', solver), make('plain', solver)
    assert advance(once, 1) == advance(often, 4001)
    assert once.sample() == often.sample()


@pytest.mark.parametrize('kind', ['held', 'periods'])
def test_a_simulator_begun_anew_does_what_a_new_one_does(kind: str) -> None:
    others, inputs = profiles('others'), profiles(kind)
    at = instants(Fraction(3, 500), 0, 500)
    initial = InitialState(1e-3, -0.02, 0.0)
    rows = np.empty((3, 500, len(Sample._fields)))
    used = Simulator(AXIS, InitialState(), *others)
    used.take_samples(at, rows[0])
    used.restart(initial, *inputs)
    used.take_samples(at, rows[1])
    Simulator(AXIS, initial, *inputs).take_samples(at, rows[2])
    assert np.array_equal(rows[1], rows[2])
    assert not np.array_equal(rows[0], rows[2])


def test_a_simulator_is_begun_anew_with_no_more_than_it_has_room_for() -> None:
    """More sinusoids than at its start were taken without a word; a load at the start did not count."""
    shaken = replace(constant(0.0), sinusoids=sinusoids('force', [1.0, 2.0], [3.0, 5.0]))
    simulator = Simulator(AXIS, InitialState(), constant(2e-3), constant(0.0))
    before = simulator.checkpoint()
    with pytest.raises(InputError, match=r'force\.sinusoids = 2 is refused: must be at most 0'):
        simulator.restart(InitialState(), constant(2e-3), shaken)
    assert simulator.checkpoint() == before
    pressed = paper_axis(COMPLIANT)
    held = InitialState(deflection=1.5 * pressed.normal_force * pressed.friction.static.limit / COMPLIANT.stiffness)
    loaded = Simulator(pressed, held, constant(0.0), constant(0.0), load=constant(pressed.normal_force))
    loaded.restart(held, constant(0.0), constant(0.0))
