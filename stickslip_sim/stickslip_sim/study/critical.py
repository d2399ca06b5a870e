# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Critical values: where an axis that starts from rest begins to stick and slip, and where steady sliding is lost.

From rest: the scene as it is, run by the exact engine until its motion settles; is that stick-slip?  From sliding:
steady sliding at the drive's velocity, slightly disturbed; it is lost where h + N mu_k′(v) < 0.  Between the two values
both motions go on, and the start decides.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from ..axis import Axis, RigidContact
from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.types import Progress
from ..figures.point_figures import Motion, figures_of_runs
from ..friction import KineticTable, StaticLaw, StaticLawKind
from ..scene import Scene
from . import answer_changes
from .points import Values, batches, runs_in_batches, scene_at, sliding_slope, works_in_batches
from .sample import Saltelli
from .study import Study
from .sweep import Workers
from .uncertainty import Index, percentiles, sobol_indices
from .variation import Variation, checked, number_at, parameter_of

# Critical feeds in closed form: from which feed on a slider no longer sticks, where the theory says it.
#
# m ẍ = c (v t − x) + h (v − ẋ) − F, with ω = √(c/m), ζ = h/(2 √(cm)) and s = √(1 − ζ²).  Friction drops by ΔF as the
# slip begins; A = ΔF/(v √(cm)) is that drop over what the feed v stands for.

_NO_REST = 0.9999   # damping ratio from which on no slip of a double comes to rest: A_c beyond 1e190


class SliderOnDrive(NamedTuple):
    """The slider on its drive: mass m kg, stiffness c N/m, damping h N s/m."""

    mass: float
    stiffness: float
    damping: float = 0.0

    @property
    def frequency(self) -> float:
        """The undamped angular frequency ω, rad/s."""
        return math.sqrt(self.stiffness / self.mass)

    @property
    def impedance(self) -> float:
        """√(cm), N s/m."""
        return math.sqrt(self.stiffness * self.mass)

    @property
    def damping_ratio(self) -> float:
        """The damping over the critical one, ζ."""
        return 0.5 * self.damping / self.impedance


def critical_drop(damping_ratio: float) -> float:
    """Return A_c, at which the slip only just comes to rest: A above it is stick-slip; 0 < ζ < 1.

    (ζ/s) [2π − asin ζ − atan((A − ζ)/s)] = ½ ln(1 − 2 A ζ + A²).
    """
    zeta = damping_ratio
    s = math.sqrt(1.0 - zeta * zeta)

    def beyond(a: float) -> float:
        angle = 2.0 * math.pi - math.asin(zeta) - math.atan((a - zeta) / s)
        return zeta / s * angle - 0.5 * math.log1p(a * a - 2.0 * a * zeta)

    return float(brentq(beyond, zeta, 2.0 * zeta + math.exp(2.0 * math.pi * zeta / s), xtol=1e-16, rtol=1e-15))


def critical_feed(slider: SliderOnDrive, drop: float) -> float:
    """Return the feed v_c (m/s) from which on constant friction slides: ΔF/(A_c √(cm))."""
    return drop / (critical_drop(slider.damping_ratio) * slider.impedance)


def healing_critical_feed(stiffness: float, growth: float) -> float:
    """Return v_c = 2 S′(0)/c (m/s) of friction that only grows with rest, at `growth` S′(0) N/s from the arrest on.

    For a concave growth S and h = 0.
    """
    return 2.0 * growth / stiffness


def feed_of_theory(axis: Axis) -> float | None:
    """Return the critical feed (m/s, perhaps infinite or 0) of an axis, None where no closed form is known.

    It is known for a rigid contact without acceleration dependence whose kinetic friction is constant or rises
    linearly, the same both ways: with constant static friction, where a damper N mu_k′ stands beside the drive's; and
    without any damping, where static friction begins at the kinetic one and its growth is concave.
    """
    friction, kinetic = axis.friction, axis.friction.kinetic
    if not isinstance(axis.contact, RigidContact) or friction.excess or len(kinetic.velocities) > 1 or kinetic.law:
        return None
    if friction.backward is not None:
        return None
    damped = SliderOnDrive(axis.mass, axis.drive_stiffness, axis.drive_damping + axis.normal_force * kinetic.end_slope)
    if damped.stiffness == 0.0:
        return None
    if friction.static.kind == StaticLawKind.CONSTANT:
        return _feed_of_a_drop(damped, axis.normal_force * (friction.static.initial - kinetic.coefficients[0]))
    return _feed_of_growth(damped, friction.static, kinetic, axis.normal_force)


def _feed_of_a_drop(slider: SliderOnDrive, drop: float) -> float:
    if drop == 0.0 or slider.damping_ratio >= _NO_REST:
        return 0.0
    return critical_feed(slider, drop) if slider.damping_ratio > 0.0 else math.inf


def _feed_of_growth(slider: SliderOnDrive, static: StaticLaw, kinetic: KineticTable, normal: float) -> float | None:
    convex = static.kind == StaticLawKind.KATO and static.exponent > 1.0
    if slider.damping > 0.0 or kinetic.coefficients[0] != static.initial or convex or static.delay > 0.0:
        return None
    if static.kind == StaticLawKind.KATO and static.exponent < 1.0:
        return math.inf
    return healing_critical_feed(slider.stiffness,
                                 normal * (static.limit - static.initial) / static.time_constant)


# Critical values that a given table of friction decides: by a breakpoint, or by the straight segment between two.
#
# Sliding is lost by the slope of mu_k at the drive's speed.  On a table that slope is the same all along a segment and
# jumps at a breakpoint; so a critical feed lies on a breakpoint, wherever a smooth curve through the same points would
# have it.  With a smooth law its own slope decides, and it has none of this.

_MOVING = ('drive.velocity', 'friction.kinetic.velocities', 'friction.kinetic.backward.velocities')
_CLOSE = 2.0   # times the accuracy: the value is the middle of what is left open


class TableFact(NamedTuple):
    """A critical `value` from rest or `from_sliding`: the drive's speed is that of a breakpoint, or in a segment.

    `breakpoint` counts from 0 in the velocities of friction.kinetic in the direction of the drive, None: in the segment
    from `low` to `high`, m/s.
    """

    from_sliding: bool
    value: float
    breakpoint: int | None
    low: float
    high: float
    table: str     # the parameter that has the breakpoints


def table_fact(values: Values, name: str, value: float, accuracy: float, from_sliding: bool) -> TableFact | None:
    """Return what the table of mu_k has to do with a critical value of a parameter; None where nothing.

    From rest the motion passes through many segments: there only a breakpoint counts, and only where the parameter
    moves the drive past it.
    """
    if not from_sliding and not name.startswith(_MOVING):
        return None
    scene = scene_at(values, [name], np.array([value]))
    kinetic = scene.axis.friction.along(scene.drive.values[0]).kinetic
    speeds = kinetic.velocities
    if kinetic.law is not None or len(speeds) < 2:
        return None
    speed, table = abs(scene.drive.values[0]), _table_of(scene)
    for k, at in enumerate(speeds[1:], 1):
        if abs(speed - at) <= _CLOSE * accuracy * at:
            return TableFact(from_sliding, value, k, at, at, table)
    above = sum(at <= speed for at in speeds)
    high = speeds[above] if above < len(speeds) else math.inf
    return TableFact(from_sliding, value, None, speeds[above - 1], high, table) if from_sliding else None


def _table_of(scene: Scene) -> str:
    """Return the parameter with the breakpoints of mu_k in the direction of the drive."""
    back = 'friction.kinetic.backward.velocities'
    return back if scene.drive.values[0] < 0.0 and back in scene.values else 'friction.kinetic.velocities'


def breakpoints_between(scene: Scene) -> int:
    """Return how many breakpoints, rest and the last one apart, a given table of mu_k has."""
    kinetic = scene.axis.friction.along(scene.drive.values[0]).kinetic
    return max(len(kinetic.velocities) - 2, 0) if kinetic.law is None else 0


_PATIENCE = 20_000   # cycles that a motion is given to settle
_DOUBLINGS = 20      # of its first run
_WIDTH = 100.0       # times up and down from the scene's own value, where no range is given
FINEST = 1e-15


@dataclass(frozen=True)
class Critical:
    """Where the motion changes over a parameter: YES is stick-slip `from_rest`, and lost sliding `from_sliding`.

    `by_table` says which of the values a table of friction decides by its breakpoints and straight segments.
    """

    over: Variation
    accuracy: float
    from_rest: answer_changes.Findings
    from_sliding: answer_changes.Findings
    by_table: tuple[TableFact, ...] = ()

    @property
    def both(self) -> list[tuple[float, float]]:
        """Stretches in which stick-slip goes on from rest, and sliding from sliding."""
        marks = (*self.from_rest.marks, *self.from_sliding.marks)
        ends = sorted({self.over.low, *marks, self.over.high})
        return _joined([(a, b) for a, b in pairwise(ends) if self.from_rest.at(0.5 * (a + b)) == answer_changes.YES
                        and self.from_sliding.at(0.5 * (a + b)) == answer_changes.NO])


def critical_of(scene: Scene, over: Variation, accuracy: float, progress: Progress = None) -> Critical:
    """Return the critical values of a parameter of a scene; raises InputError."""
    if not FINEST <= accuracy < 1.0:
        raise InputError('--accuracy', accuracy, f'>= {FINEST:g} and < 1', 'give the relative width, as 1e-9')
    if not works_in_batches(scene):
        raise InputError('scene', scene.name, 'one with constant inputs, without faults or a normal load, and with the '
                         'solver exact',
                         'a critical value belongs to a motion that settles')
    for end in (over.low, over.high):
        scene_at(scene.values, [over.name], np.array([end]))
    ask = _Questions(scene.values, over.name)
    limits = over.low, over.high, over.log, accuracy
    rest = answer_changes.find_transitions(ask.sticks, *limits, progress)    # it takes nearly all the time
    sliding = answer_changes.find_transitions(ask.loses_sliding, *limits)
    facts = [table_fact(scene.values, over.name, one.value, accuracy, found is sliding)
             for found in (rest, sliding) for one in found.transitions if one.resolved]
    return Critical(over, accuracy, rest, sliding, tuple(fact for fact in facts if fact is not None))


def default_range(scene: Scene, name: str) -> Variation:
    """Return the range of a parameter from a hundredth to a hundred times its value in the scene; raises InputError."""
    entry, index = parameter_of(name)
    value = number_at(scene.values, name)
    if value is None or not 0.0 < value < np.inf:
        raise InputError('--between', None, f'given for {name}, which is no number above 0 in this scene, so that the '
                         'range around it is not known', 'add --between LOW:HIGH' + (
                             f', or --set {name}=… to look from 1/100 to 100 times that' if index is None else ''))
    low, high = value / _WIDTH, value * _WIDTH
    return checked(Variation(name, max(low, entry.low or low), min(high, entry.high or high), 0, True))


@dataclass(frozen=True)
class _Questions:
    """What is asked of values of one parameter of a scene."""

    values: Mapping[str, object]
    name: str

    def sticks(self, numbers: Numbers) -> answer_changes.Answers:
        """Whether stick-slip goes on, from the start of the scene."""
        return stick_answers(self.values, [self.name], numbers[:, None])

    def loses_sliding(self, numbers: Numbers) -> answer_changes.Answers:
        """Whether a disturbance of steady sliding grows."""
        return lost_answers(self.values, [self.name], numbers[:, None])


def stick_answers(values: Mapping[str, object], names: Sequence[str], points: Numbers) -> answer_changes.Answers:
    """Return for each point whether stick-slip goes on, from the start of the scene."""
    runs = runs_in_batches(values, names, points, None, _PATIENCE, _DOUBLINGS)
    figures = figures_of_runs(runs)
    answers = np.where(figures.motion == Motion.STICK_SLIP, answer_changes.YES, answer_changes.NO)
    answers[(figures.motion == Motion.UNDECIDED) | runs.late] = answer_changes.OPEN   # late: another may never slide
    answers[figures.motion == Motion.FAILED] = answer_changes.FAILED
    return answers


def lost_answers(values: Mapping[str, object], names: Sequence[str], points: Numbers) -> answer_changes.Answers:
    """Return for each point whether a disturbance of steady sliding grows."""
    slopes = np.empty(len(points))
    for members, scene, inputs in batches(values, names, points):
        slopes[members] = sliding_slope(scene.axis, inputs)
    return np.where(np.isnan(slopes), answer_changes.OPEN, np.where(
        slopes < 0.0, answer_changes.YES, answer_changes.NO))


def _joined(stretches: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return stretches with those put together that touch."""
    joined: list[tuple[float, float]] = []
    for begin, end in stretches:
        if joined and joined[-1][1] == begin:
            joined[-1] = (joined[-1][0], end)
        else:
            joined.append((begin, end))
    return joined


# The critical value of a parameter where others are known only roughly: one at each point of a sample.
#
# It is the highest value at which stick-slip from rest begins or ends, and the highest at which steady sliding is lost
# (`critical`).

ACCURACY = 1e-4        # of the value
STARTS = ('from_rest', 'from_sliding')
_IN_A_CHUNK = 64       # points


@dataclass(frozen=True)
class CriticalStudy:
    """The critical values of the parameter `over` at the points of a study of distributions."""

    study: Study
    over: Variation

    def __post_init__(self) -> None:
        if self.over.name in self.study.names:
            raise InputError('--of', self.over.name, 'another parameter than those that are drawn',
                             'drop it from the file of distributions')

    @property
    def stretches(self) -> list[tuple[int, int]]:
        """The first point of each chunk, and the one after its last."""
        return [(first, min(first + _IN_A_CHUNK, self.study.count))
                for first in range(0, self.study.count, _IN_A_CHUNK)]

    def values(self, first: int, last: int) -> Numbers:
        """Return a row for each point from `first` on, up to `last`, a column for each of STARTS."""
        points = self.study.points(first, last)
        names = (*self.study.names, self.over.name)

        def sticks(rows: answer_changes.Places, numbers: Numbers) -> answer_changes.Answers:
            return stick_answers(self.study.values, names, np.column_stack([points[rows], numbers]))

        def loses_sliding(rows: answer_changes.Places, numbers: Numbers) -> answer_changes.Answers:
            return lost_answers(self.study.values, names, np.column_stack([points[rows], numbers]))

        return np.column_stack([answer_changes.highest_changes(question, last - first, self.over, ACCURACY)
                                for question in (sticks, loses_sliding)])


class CriticalSpread(NamedTuple):
    """How the critical value of one start spreads over the independent points of a sample.

    `all_over` and `nowhere` of the `points` stick and slip (or lose sliding) all over the range, or nowhere; of
    `unknown` the value is not known; the `percentiles` are of all others, None without any.  `indices` are None where
    not every point has a value, or parameters are correlated.
    """

    points: int
    all_over: int
    nowhere: int
    unknown: int
    values: Numbers
    percentiles: list[float] | None
    indices: Mapping[str, Index] | None


def critical_values(study: CriticalStudy, workers: Workers | None = None, progress: Progress = None) -> Numbers:
    """Return the critical values of all points, a row each and a column for each of STARTS."""
    parts = []
    for (_, last), part in zip(study.stretches, _parts(study, workers)):
        parts.append(part)
        if progress:
            progress(last / study.study.count)
    return np.concatenate(parts)


def _parts(study: CriticalStudy, workers: Workers | None) -> Iterator[Numbers]:
    if workers is None:
        yield from (study.values(*stretch) for stretch in study.stretches)
        return
    waiting: list[Future[Numbers]] = [workers.pool.submit(study.values, *stretch) for stretch in study.stretches]
    yield from (future.result() for future in waiting)


def spreads_of(sample: Saltelli, values: Numbers) -> dict[str, CriticalSpread]:
    """Return the spread of each of STARTS from the values of all points of a sample."""
    return {start: _spread(sample, column.reshape(sample.samples, sample.each))
            for start, column in zip(STARTS, values.T, strict=True)}


def _spread(sample: Saltelli, values: Numbers) -> CriticalSpread:
    drawn = values[:, :2]
    known = drawn[np.isfinite(drawn)]
    indices = None if sample.correlations else sobol_indices(np.where(np.isfinite(values), values, np.nan))
    names = [one.name for one in sample.variations]
    return CriticalSpread(
        drawn.size, int((drawn == answer_changes.ALL_OVER).sum()), int((drawn == answer_changes.NOWHERE).sum()),
        int(np.isnan(drawn).sum()), known, percentiles(known),
        dict(zip(names, indices, strict=True)) if indices else None)
