# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""X15, X24 and X26: what is said of the order of fixed steps, of the error of a run, and of stick-slip by studies.

An estimate is held against the true error, that of the reference.  Looked at are the events up to the time `until_s`
that it speaks of: they must be those of the reference, and no further off than it says.  An `until_s` before the end
must have its reason.
"""

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from statistics import median
from typing import NamedTuple

import numpy as np

from ...axis import InitialState
from ...core.errors import InputError, SolverError
from ...core.types import Event, EventKind, Mode
from ...figures.distance import lasting, seconds_between
from ...inputs import load_scene
from ...reference import simulate
from ...runs import SimulatedRun, simulate_events
from ...runs.error_estimate import ErrorEstimate, error_estimate
from ...scene import Scene, SolverSettings, scene_names
from ...simulation.simulator import Simulator
from ...solvers import Solver, exact, fixed_step
from ...study import EvenGrid, Motion, Study, Variation
from ...study.answer_changes import Transition
from ...study.critical import critical_of
from ...study.points import scene_at
from ..axes import CONTACTS, RIGID, Contact, instant, make, of_kind, paper_axis, random_axis, random_profiles
from ..judges import DIGITS, Measurement, Setup, Tally, require

# as `solvers.fixed_step` declares it: inside a mode, and across events, which it sees at the end of a step
DECLARED = {'euler': (1, 1), 'rk4': (4, 1)}
_NEAR = 0.35   # how far a measured order may be from the declared one
_SHIFTS = (1.0, 0.95, 0.9, 0.85, 0.8, 0.75, 0.7, 0.65)
_Make = Callable[[Solver], Simulator]
_DURATION = 2.0   # s
_TOLERANCES = (1e-3, 1e-6, 1e-9, 1e-12)
_STEPS = (1e-2, 1e-3, 1e-4, 1e-5)   # s
_PER_RTOL = 1e-2   # atol, m and m/s
_TIGHT, _CLAIMED = 0.9, 0.5   # no estimate is to be honest by claiming too much, or nothing
_FEW = ('paper_fig7', 'paper_fig8')


def orders(setup: Setup) -> Measurement:
    """X15: the order from errors at steps that halve, over a slip and over a second with all its events."""
    tally = Tally(_NEAR, 'off the declared order')
    shown = []
    for method, (inside, across) in DECLARED.items():
        measured: list[float] = []
        tally.measure(_order_inside, method, inside, measured)
        for contact in CONTACTS:
            tally.measure(_order_across, method, across, contact, setup.choose(8, 6), measured)
        shown.append(f'{method} ' + ', '.join(f'{order:.2f}' for order in measured))
    return tally.finding('with another order', 'measured in a mode and across events: ' + '; '.join(shown))


def _order_inside(method: str, declared: int, measured: list[float]) -> float:
    """One decelerating slip, read before it ends: the slope between two steps."""
    axis = paper_axis(RIGID, branches=False)

    def begin(solver: Solver) -> Simulator:
        return make(axis, 0.0, initial=InitialState(velocity=0.2), solver=solver)

    errors = [_error(begin, method, step, 0.015) for step in (1e-3, 5e-4)]
    measured.append(math.log2(errors[0] / errors[1]))
    return abs(measured[-1] - declared)


def _order_across(method: str, declared: int, contact: Contact, halvings: int, measured: list[float]) -> float:
    """Several cycles in which friction drops at once: the slope of a line through the errors, which scatter.

    With the branches of the paper the force has no jump, and a compliant contact may do better than what is declared.
    """
    axis = paper_axis(contact, branches=False)

    def begin(solver: Solver) -> Simulator:
        return make(axis, 0.002, solver=solver)

    points = []
    for k in range(halvings):
        step = 2.5e-4 * 0.5 ** k
        mean = math.fsum(_error(begin, method, step * shift, 1.4) for shift in _SHIFTS) / len(_SHIFTS)
        points.append((math.log2(step), math.log2(mean)))
    x = math.fsum(a for a, _ in points) / len(points)
    y = math.fsum(b for _, b in points) / len(points)
    slope = math.fsum((a - x) * (b - y) for a, b in points) / math.fsum((a - x) ** 2 for a, _ in points)
    measured.append(slope)
    return abs(slope - declared)


def _error(begin: _Make, method: str, step: float, end: float) -> float:
    """Return the error of the position at the end, m, against the exact solver."""
    stepped, wanted = begin(fixed_step.solver(method, step)), begin(exact.SOLVER)
    for simulator in (stepped, wanted):
        simulator.advance(instant(end))
    one, other = stepped.sample(), wanted.sample()
    require(one.mode != Mode.STICK or other.mode == Mode.STICK, 'it sticks elsewhere')
    return abs(one.position - other.position)


class _Worth(NamedTuple):
    """The worth of an estimate of steps: the error over it, and how many of the events it covered."""

    ratio: float
    covered: int
    events: int


def estimates(setup: Setup) -> Measurement:
    """X26: shipped and random scenes with every solver and setting; the true error over the estimate."""
    tally = Tally(1.0, 'of the estimate')
    worths: list[_Worth] = []
    for scene in _scenes(setup):
        wanted = simulate(scene.axis, scene.initial, scene.drive, scene.force, _DURATION, DIGITS).events
        if not wanted:
            continue
        for solver in _settings(setup):
            run = _run(replace(scene, solver=solver))
            if run:
                tally.measure(_ratio, f'{scene.name} with {solver.name} {solver.settings}', run, wanted, worths)
    half = median(case.ratio for case in worths if case.covered)
    share = sum(case.covered for case in worths) / sum(case.events for case in worths)
    return tally.finding('with an error beyond the estimate', f'of steps half are at least {half:.3g} of it, for '
                         f'{share:.0%} of the events', kept=half >= _TIGHT and share >= _CLAIMED)


def _scenes(setup: Setup) -> Iterator[Scene]:
    for name in setup.choose(tuple(scene_names()), _FEW):
        yield _with_table(load_scene(name))
    for seed in range(setup.choose(40, 1)):
        rng = random.Random(seed)
        axis = random_axis(rng)
        drive, force = random_profiles(rng)
        yield replace(load_scene(_FEW[0]), name=f'random {seed}', axis=axis, drive=drive, force=force)


def _with_table(scene: Scene) -> Scene:
    """Return the scene with the table for all solvers, which is what the reference knows, also where it has a law."""
    friction = scene.axis.friction.with_tables(lambda table: replace(table, law=None))
    return replace(scene, axis=replace(scene.axis, friction=friction))


def _settings(setup: Setup) -> Iterator[SolverSettings]:
    yield SolverSettings('exact')
    for method in ('DOP853', 'RK45'):
        for rtol in setup.choose(_TOLERANCES, _TOLERANCES[1:3]):
            yield SolverSettings('adaptive', method, rtol=rtol, atol=rtol * _PER_RTOL)
    for method in ('euler', 'rk4'):
        for step in setup.choose(_STEPS, _STEPS[1:3]):
            yield SolverSettings('fixed_step', method, step)


def _run(scene: Scene) -> SimulatedRun | None:
    """Return the run; None where a step is too long for the axis, or a guard of the adaptive solver fires for ever."""
    try:
        return simulate_events(scene, _DURATION)
    except (InputError, SolverError):
        return None


def _ratio(_: str, run: SimulatedRun, wanted: Sequence[Event], worths: list[_Worth]) -> float:
    """Return the largest error of an event over its estimate."""
    solver = run.scene.solver.name
    with_knots = solver != 'fixed_step'   # which finds no such events
    left = [event for event in wanted if with_knots or event.kind != EventKind.KNOT]
    events, wanted = (run.events, left) if solver == 'exact' else (lasting(run.events), lasting(left))
    estimate = error_estimate(run)
    sure = [(a, b) for a, b in zip(events, wanted) if a.time < estimate.until_s or estimate.until_s == _DURATION]
    for a, b in sure:
        require((a.kind, a.direction) == (b.kind, b.direction), f'{a.kind.name} at {a.time} s is none')
    before = [event for event in wanted if event.time < estimate.until_s - 2.0 * estimate.event_time_s]
    require(len(before) <= len(sure), f'{len(before) - len(sure)} events missed before {estimate.until_s} s')
    require(estimate.until_s == _DURATION or _has_reason(estimate, events, wanted),
            f'events differ from {estimate.until_s} s, it says')
    time = max((seconds_between(a, b) for a, b in sure), default=0.0)
    position = max((abs(a.position - b.position) for a, b in sure), default=0.0)
    if solver != 'exact':
        worths.append(_Worth(time / estimate.event_time_s, len(sure), len(wanted)))
    return max(time / estimate.event_time_s, position / estimate.position_m if position > 0.0 else 0.0)


def _has_reason(estimate: ErrorEstimate, events: Sequence[Event], wanted: Sequence[Event]) -> bool:
    """Whether two runs differ by more than an estimate says."""
    return len(events) != len(wanted) or any(
        (a.kind, a.direction) != (b.kind, b.direction) or seconds_between(a, b) > estimate.event_time_s
        for a, b in zip(events, wanted))


# The stick-slip that studies report, and the values where it begins and ends, against long runs.

_LONG, _LATE = 1e4, 5e3    # s: a run, and its last part that sticks are counted in
_ACCURACY = 1e-9
_STEPS = (0.0, 1e-7, 1e-4, 1e-2)   # beyond the reported end, of the value
_HEAVY = 20000.0, 32000.0          # kg, on which a slip reverses before it sticks
_CONVENTIONAL = {'contact.model': 'compliant', 'contact.stiffness': 5e6, 'contact.damping': 15000.0}
_BORDERS: tuple[tuple[str, Mapping[str, object], str, float, float], ...] = (
    ('paper_fig4_constant', {}, 'axis.mass', 5.0, 500.0),
    ('paper_fig8', {'drive.velocity': 0.02}, 'axis.normal_force', 500.0, 5000.0),
    ('paper_fig8', {'drive.velocity': 0.01}, 'axis.drive_damping', 1e3, 4e4),
    ('paper_fig8', {}, 'axis.drive_damping', 1e3, 4e4),    # the longest to narrow down
    ('paper_fig8', {}, 'axis.normal_force', 500.0, 5000.0),
    ('paper_fig8', {}, 'drive.velocity', 1e-3, 0.1),
    ('paper_fig7', {}, 'drive.velocity', 1e-3, 0.1),
    ('paper_fig7', {}, 'axis.drive_damping', 1e3, 4e4),
    ('paper_fig7', {'drive.velocity': 0.025}, 'axis.normal_force', 500.0, 5000.0),
    ('paper_fig4_falling', {}, 'axis.drive_damping', 1e3, 4e4),
    ('paper_fig4_falling', {}, 'axis.normal_force', 500.0, 5000.0),
    ('paper_fig4_falling', {}, 'drive.velocity', 1e-3, 0.1),
    ('paper_fig4_falling', _CONVENTIONAL, 'axis.drive_damping', 1e3, 4e4),
    ('paper_fig4_constant', {}, 'drive.velocity', 1e-3, 0.1),
    ('paper_fig4_constant', {'drive.velocity': 0.005}, 'axis.drive_damping', 100.0, 1e4),
)


def answers(setup: Setup) -> Measurement:
    """X24: sticks and reversals by turns, sticks after long pauses, cycles about to vanish; sweep and critical."""
    tally = Tally(0.0)
    for mass in np.linspace(*_HEAVY, setup.choose(41, 2)).tolist():
        tally.measure(_motion, setup.solver, 'paper_fig7', 0.02, mass)
    for seed in range(setup.choose(40, 2)):
        rng = random.Random(seed)
        tally.measure(_motion, setup.solver, rng.choice(('paper_fig7', 'paper_fig8', 'paper_fig4_falling')),
                    10.0 ** rng.uniform(-3.0, -1.3), 10.0 ** rng.uniform(1.5, 4.5))
    for k in range(setup.choose(len(_BORDERS), 1)):
        for side in (-1, 1):
            for step in setup.choose(_STEPS, _STEPS[:1]):
                tally.measure(_border, setup.solver, k, side, step)
    return tally.finding('contradicted by a run of 10,000 s')


def _motion(solver: Solver, name: str, feed: float, mass: float) -> None:
    """Run a scene as a point of a sweep; the reported motion should go on."""
    scene = load_scene(name, {'drive.velocity': feed})
    study = Study(scene.values, EvenGrid((Variation('axis.mass', mass, 1.1 * mass, 2),)))
    motion = study.figures(0, 1).motion[0]
    count = _sticks(solver, scene_at(scene.values, ['axis.mass'], np.array([mass])))
    require(motion not in (Motion.AT_REST, Motion.FAILED), f'a motion without a run: {motion}')
    require(motion == Motion.UNDECIDED or (motion == Motion.STICK_SLIP) == (count > 0),
            f'called {Motion(int(motion)).name}, with {count} sticks late')


def _border(solver: Solver, k: int, side: int, step: float) -> None:
    """Run a scene beside, or a share of the value beyond, an end that `critical` reports."""
    name, changes, parameter, low, high = _BORDERS[k]
    transition = _transition(k)
    value = transition.low * (1.0 - step) if side < 0 else transition.high * (1.0 + step)
    require(low < value < high, 'beyond the range')
    scene = load_scene(name, dict(changes))
    count = _sticks(solver, scene_at(scene.values, [parameter], np.array([value])))
    require((count > 0) == ((side > 0) == transition.rises), f'{count} sticks late at {value!r}')


@cache
def _transition(k: int) -> Transition:
    name, changes, parameter, low, high = _BORDERS[k]
    found = critical_of(load_scene(name, dict(changes)), Variation(parameter, low, high, log=True), _ACCURACY).from_rest
    require(len(found.transitions) == 1, f'{len(found.transitions)} transitions')
    return found.transitions[0]


def _sticks(solver: Solver, scene: Scene) -> int:
    """Return how many sticks begin in the last part of a long run."""
    simulator = make(scene.axis, scene.drive, scene.force, scene.initial, solver)
    simulator.skip(instant(_LONG - _LATE))
    return sum(event.mode == Mode.STICK for event in of_kind(simulator.advance(instant(_LONG)), EventKind.STICK))
