# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The friction curve of a run: the force on the slider less its inertia, in bins of its velocity, for each direction.

    F = F_d + F_e − m ẍ

Velocity and acceleration are those of cubic polynomials through the position (Savitzky and Golay, 1964).  They are as
long as noise of the acceleration asks for: until it makes no more force than the noise of the force sensor, or a
hundredth of the force.
"""

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..axis import Axis
from ..core.arrays import Numbers, data_frame
from ..core.errors import InputError
from ..core.types import Mode
from ..figures.slips import SlipRows, stretches_of
from ..inputs.scene_files import SceneOrName, load_scene, scene_of
from ..recording import MeasuredRun, run_of
from ..report.html import Shown
from ..report.model import Part, Table
from ..report.quantity import counted, quantity
from ..runs import Run
from .curve.measured_curve import FrictionCurve, Units, units_of
from .measured_friction import FEWEST_ROWS, even, friction_force, motion, threshold_of, window_of
from .readings import own_noise_of, quantum_of

if TYPE_CHECKING:
    from .curve.report import FittedCurve

_BINS = 24          # of each direction
_IN_A_BIN = 8       # readings, or more
_GAP = 3.0          # periods: rows further apart have none between them
_QUIET = 0.01       # of the force
_WITHOUT_DRIVE = {'axis.drive_stiffness': 0.0, 'axis.drive_damping': 0.0}
_TELLING = 10**6    # rows that say the noise
_OF_POSITION, _OF_VELOCITY = 720.0, 75.0   # variance of an acceleration from w rows: this over w^5, over w^3


@dataclass(frozen=True, repr=False)
class RunFriction(Shown):
    """Friction in bins of the velocity: `velocities` (m/s, backwards negative) rise; forces (N) have their sign.

    `friction` is the median of each bin, `lower` and `upper` are its quartiles, `counts` how many readings it has;
    `notes` say how it was found.
    """

    name: str
    velocities: Numbers
    friction: Numbers
    lower: Numbers
    upper: Numbers
    counts: Numbers
    notes: tuple[str, ...]

    def _shown(self) -> Iterator[Part]:
        yield f'RunFriction of {self.name}: {counted(len(self.velocities), "bin")} of {self.counts.sum():.0f} readings'
        yield Table(('velocity / (m/s)', 'friction / N', 'lower quartile', 'upper quartile', 'readings'),
                    [[f'{value:.4g}' for value in row] for row in zip(*self.columns.values(), strict=True)], texts=())
        yield from self.notes

    @property
    def columns(self) -> dict[str, Numbers]:
        """The columns of its table."""
        return {'velocity': self.velocities, 'friction_force': self.friction, 'lower_quartile': self.lower,
                'upper_quartile': self.upper, 'readings': self.counts}

    def frame(self) -> Any:
        """Return it as a pandas.DataFrame; raises InputError without pandas."""
        return data_frame(self.columns, 'columns')

    def curve(self, normal_force: float | None = None) -> FrictionCurve:
        """Return the points that laws are fitted to, over a normal force, N, or in N; raises InputError.

        Friction has to be against the motion.
        """
        self.units(normal_force)
        forward, scale = self.velocities > 0.0, 1.0 if normal_force is None else normal_force
        sign = np.where(forward, 1.0, -1.0) / scale
        points = np.stack([sign * one for one in (self.friction, self.lower, self.upper)])
        if (points[0] < 0.0).any():
            bad = int(np.argmin(points[0]))
            raise InputError('friction', f'{self.friction[bad]:g} N at {self.velocities[bad]:g} m/s',
                             'against the motion, for laws to be fitted', 'a weight, an offset of the force, its sign '
                             'or the mass is wrong: check the table (--csv)')
        order = np.argsort(np.abs(self.velocities), kind='stable')
        return FrictionCurve(np.abs(self.velocities)[order], points[0][order], forward[order],
                             spread=np.sort(points[1:], axis=0)[:, order])

    def fit(self, law: str = 'best', normal_force: float | None = None) -> 'FittedCurve':
        """Return the laws that fit it, best first, and the chosen one; raises InputError.

        Over a normal force, N, they are those of a coefficient, which `scene` puts into a scene.
        """
        from .curve.report import fitted_curve

        return fitted_curve(self.name, self.curve(normal_force), self.units(normal_force), law, self.notes)

    @staticmethod
    def units(normal_force: float | None) -> Units:
        """Return those of its curve; raises InputError on a normal force that is none."""
        return units_of('m/s', 'N', normal_force)


def friction_curve(run: Run | str | os.PathLike[str], mass: float | None = None, scene: SceneOrName | None = None,
                   slowest: float | None = None) -> RunFriction:
    """Return the friction of a run, or of that in a folder, faster than `slowest` (m/s; None: its threshold of a slip).

    A measured force is that on a slider of `mass` (kg; None: of the `scene`, whose drive spring gives the force where
    none was measured).  A measured friction force, and that of a simulation, is taken as it is.  Raises InputError.
    """
    run = run_of(run)
    if slowest is not None and not 0.0 < slowest < np.inf:
        raise InputError('slowest', slowest, '> 0 m/s, and finite', 'for example 1e-4')
    columns = {name: np.asarray(column) for name, column in run.samples.items() if np.isfinite(column).any()}
    if isinstance(run, MeasuredRun):
        velocity, force, rows, notes = _measured(run, columns, _axis_of(columns, mass, scene), slowest)
    else:
        velocity, force, notes = columns['velocity'], columns['friction_force'], ['the friction of the simulation']
        slips = columns['mode'] != Mode.STICK    # in which a compliant contact moves, too
        rows = np.flatnonzero(slips & (np.abs(velocity) > (slowest or threshold_of(run, velocity))))
    velocity, force = velocity[rows], force[rows]
    slow = slowest or (float(np.abs(velocity).min()) if len(velocity) else 0.0)
    parts = [part for sign in (-1.0, 1.0) for part in _bins(velocity, sign)]
    if not parts:
        raise InputError('RUN', run.name, f'with motion of {_IN_A_BIN} readings or more', 'look at its threshold: '
                         'slowest, --slowest' if slowest is None else 'state a slower velocity')
    middle, lower, upper = np.array([np.percentile(force[part], (50.0, 25.0, 75.0)) for part in parts]).T
    counts = np.array([len(part) for part in parts])
    if left := len(velocity) - int(counts.sum()):
        notes.append(f'{counted(left, "reading")} in bins of fewer than {_IN_A_BIN} are left out')
    notes.append(f'{counted(len(velocity), "reading")} faster than {quantity(slow, "m/s", 3)}')
    return RunFriction(run.name, np.array([np.median(velocity[part]) for part in parts]), middle, lower, upper,
                       counts, tuple(notes))


def _axis_of(columns: Mapping[str, Numbers], mass: float | None, given: SceneOrName | None) -> Axis:
    """Return what the force acts on; without a scene nothing but a mass."""
    if 'friction_force' not in columns and mass is None and given is None:
        raise InputError('mass', None, 'given in kg (--mass), or by a scene: friction is the force less m a',
                         'of a motor with a screw add its inertia times (2 pi / lead)^2')
    if given is None and not {'friction_force', 'drive_force'} & set(columns):
        raise InputError('RUN', ', '.join(columns), 'with a drive_force or a friction_force', 'import one, or give '
                         'the scene whose drive spring it follows from')
    scene = load_scene('paper_fig8', _WITHOUT_DRIVE) if given is None else scene_of(given)
    return scene.axis if mass is None else replace(scene.axis, mass=mass)


def _measured(run: MeasuredRun, columns: Mapping[str, Numbers], axis: Axis, slowest: float | None
              ) -> tuple[Numbers, Numbers, Any, list[str]]:
    """Return velocity, friction force, the rows in motion, and how they were found."""
    name = 'position' if 'position' in run.measured else 'velocity'
    times, drawn = even({one: column for one, column in columns.items() if one != 'position' or one == name})
    if len(times) < 2 * FEWEST_ROWS:
        raise InputError('RUN', f'{len(times)} readings', f'{2 * FEWEST_ROWS} readings or more', 'measure longer')
    period = float(times[1] - times[0])
    rough = motion(drawn, FEWEST_ROWS, period)[0]
    least = slowest or threshold_of(run, rough)
    moves = list(stretches_of(rough, least))
    longest = window_of(moves) if moves else FEWEST_ROWS
    mass = 0.0 if 'friction_force' in columns else axis.mass
    window, noise = _window(drawn, name, mass, period, longest)
    velocity, acceleration = motion(drawn, window, period)
    force = friction_force(drawn, axis, velocity, acceleration, window, period)
    if force is None:
        raise InputError('RUN', ', '.join(columns), 'with a force, or with the positions of both ends of the spring',
                         'import drive_force, friction_force or drive_position')
    is_whole = _near_readings(columns['time'], times, period, window)
    rows = [row[is_whole[row]] for row in _inside(stretches_of(velocity, least), window, len(times))]
    notes = ['the measured friction force' if 'friction_force' in columns else
             f'force less inertia of {axis.mass:g} kg', 'velocity and acceleration: cubic polynomials through '
             f'{window} rows of the {name}, {quantity(window * period, "s", 3)}; noise makes {quantity(noise, "N", 2)}']
    return velocity, force, np.concatenate([*rows, np.empty(0, np.int64)]), notes


def _window(drawn: Mapping[str, Numbers], name: str, mass: float, period: float, longest: int) -> tuple[int, float]:
    """Return how many rows a polynomial has, and the force that noise of its acceleration makes, N."""
    values, force = drawn[name][:_TELLING], drawn.get('drive_force', np.zeros(1))[:_TELLING]
    inertia = mass * own_noise_of(values, quantum_of(values)) / period**(2 if name == 'position' else 1)
    quiet = max(own_noise_of(force, quantum_of(force)), _QUIET * float(np.median(np.abs(force))), 1e-300)
    factor, power = (_OF_POSITION, 5) if name == 'position' else (_OF_VELOCITY, 3)
    rows = (factor * (inertia / quiet)**2)**(1.0 / power)
    window = 2 * int(min(max(rows, FEWEST_ROWS), longest) / 2.0) + 1
    return window, float(inertia * (factor / window**power)**0.5)


def _near_readings(readings: Numbers, times: Numbers, period: float, window: int) -> Any:
    """Return which times have readings all around them, as far as a polynomial goes."""
    gaps = np.flatnonzero(np.diff(readings) > _GAP * period)
    is_near, around = np.ones(len(times), np.bool_), window // 2 * period
    for begin, end in zip(readings[gaps].tolist(), readings[gaps + 1].tolist()):
        is_near[slice(*np.searchsorted(times, (begin - around, end + around)))] = False
    return is_near


def _inside(moves: Iterator[SlipRows], window: int, count: int) -> Iterator[Any]:
    """Yield the rows of each move whose polynomials lie within it."""
    half = window // 2
    return (np.arange(max(move.first, 0) + half, min(move.end, count) - half) for move in moves)


def _bins(velocity: Numbers, sign: float) -> Iterator[Any]:
    """Yield the rows of each bin of a direction, by rising velocity; their edges have even ratios."""
    rows = np.flatnonzero(sign * velocity > 0.0)
    if not len(rows):
        return
    speeds = np.abs(velocity[rows])
    edges = np.geomspace(speeds.min(), speeds.max(), _BINS + 1)[1:-1]
    places = np.searchsorted(edges, speeds, 'right')
    for place in range(_BINS) if sign > 0.0 else reversed(range(_BINS)):
        if np.count_nonzero(places == place) >= _IN_A_BIN:
            yield rows[places == place]
