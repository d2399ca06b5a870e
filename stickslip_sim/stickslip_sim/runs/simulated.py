# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Run a scene as fast as the machine can, and keep what happened: events, samples, receipt."""

import math
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Columns
from ..core.errors import InputError
from ..core.time_grid import Instants, decimal, instant_of, instants, multiples
from ..core.types import EnergyBalance, Event, Instant, Mode, Progress, Sample
from ..figures.cycles import Summary, miss_note, summary, touch_note
from ..report.values import plain, versions
from ..scene import Scene
from ..simulation import Rig
from ..simulation.simulator import Simulator
from ..simulation.step_result import Mark, marks_of_faults
from .run import Views, normal_force_of
from .samples import GATHERED, MOST_HELD, HeldSamples, RemadeSamples, Samples

# The receipt of an offline run: what ran, with which versions, what came out, what it cost.  JSON values only.

class CostMeter:
    """What a run costs, from `begin` on; it begins at once."""

    def __init__(self) -> None:
        self.begin()

    def begin(self) -> None:
        """Begin to count anew."""
        self._cpu, self._wall = time.process_time(), time.perf_counter()

    def so_far(self) -> tuple[float, float]:
        """Return the CPU and the wall time, s."""
        return time.process_time() - self._cpu, time.perf_counter() - self._wall


def receipt_of(scene: Scene, duration: float, sample_period: float | None, figures: Summary, root_iterations: int,
               final: Sample, energy: EnergyBalance | None, cpu_time: float, wall_time: float) -> dict[str, Any]:
    """Return the receipt of a run of `duration` s that took `cpu_time` and `wall_time` s.

    `results` and `energy` (J; None when the solver keeps no account) are the same on every machine; `versions` and
    `cost` are not.  An infinite number is the text 'inf'.
    """
    note = '; '.join(filter(None, (touch_note(figures), miss_note(scene))))
    receipt = {
        'scene': scene.name,
        'scene_hash': scene.hash,
        'solver': scene.solver.name,
        'solver_settings': scene.solver.settings,
        'duration': duration,
        'sample_period': sample_period,
        **profiles_from_files(scene),
        'versions': versions(),
        'results': {**figures._asdict(), **({'note': note} if note else {}), 'root_iterations': root_iterations,
                    'final_state': final},
        'energy': energy and {**energy._asdict(), 'residual': energy.residual,
                              'relative_residual': energy.relative_residual},
        'cost': {'cpu_time_s': cpu_time, 'cpu_time_per_simulated_second': cpu_time / duration,
                 'wall_time_s': wall_time},
    }
    result: dict[str, Any] = plain(receipt)
    return result


def profiles_from_files(scene: Scene) -> dict[str, Any]:
    """Return the profiles that were in files: their points, and where these came from; nothing without any."""
    names = ('course', 'times', 'velocities', 'positions', 'slopes', 'forces', 'period')
    profiles = {section: {**source._asdict(), **{name: scene.values[f'{section}.{name}'] for name in names
                                                 if f'{section}.{name}' in scene.values}}
                for section, source in scene.sources.items()}
    return {'profiles': profiles} if profiles else {}


MAX_DURATION = 1e9         # s
MAX_SAMPLES = 1_000_000_000   # 120 GB as a bag, made block by block
MAX_EVENTS = 5_000_000     # 1 GB
_PARTS = 200               # of a run: progress is reported, and Ctrl-C heard, this often


@dataclass(frozen=True, eq=False, repr=False)
class SimulatedRun(Views):
    """A run that was simulated just now; `samples` have the exact instants too, as `second` and `fraction`."""

    scene: Scene
    end: float
    sample_period: Fraction | None   # s; None: without samples, or not evenly spaced
    events: list[Event]
    sampled: Samples
    summary: Summary
    receipt: dict[str, Any] = field(default_factory=dict)
    begin: float = 0.0
    notes: tuple[str, ...] = ()
    setpoint: Columns = field(default_factory=dict)
    is_recorded: ClassVar[bool] = False
    is_commanded: ClassVar[bool] = False
    is_complete: ClassVar[bool] = True
    is_changed: ClassVar[bool] = False
    missing_steps: ClassVar[int] = 0

    @property
    def name(self) -> str:
        """Of the scene."""
        return self.scene.name

    @property
    def source(self) -> str:
        """How long it was simulated, and by which solver."""
        return f'simulated for {self.duration:g} s with the {self.scene.solver.name} solver'

    @property
    def samples(self) -> Columns:
        """The samples as columns, in memory."""
        return self.sampled.columns

    @property
    def states(self) -> Columns:
        """The samples."""
        return self.samples

    @property
    def commands(self) -> Columns:
        """None: the scene decides."""
        return {'time': np.empty(0), 'velocity': np.empty(0)}

    @property
    def marks(self) -> list[Mark]:
        """When the faults of the scene were in force."""
        return marks_of_faults(self.scene.rig.faults, self.end)

    def sample_blocks(self) -> Iterator[Columns]:
        """Yield the samples block by block."""
        return self.sampled.blocks()

    def command_blocks(self) -> Iterator[Columns]:
        """Yield the commands as one block."""
        yield self.commands

    def sample_rows(self) -> Iterator[Sample]:
        """Yield the samples one by one."""
        for block in self.sample_blocks():
            for second, fraction, mode, direction, *rest in zip(*(block[name].tolist() for name in Sample._fields)):
                yield Sample(second, fraction, Mode(int(mode)), int(direction), *rest)


def simulate(scene: Scene, duration: float, sample_period: float | Fraction | None = None,
             progress: Progress = None) -> SimulatedRun:
    """Simulate `duration` seconds of a scene, with a sample every `sample_period` seconds from 0 on (None: each step).

    `progress` is called with the share that is done.  Raises InputError on times without a meaning and on a run too
    long to hold, SolverError when the solver gives up.
    """
    return _simulated(scene, duration, scene.time.step if sample_period is None else sample_period, progress)


def simulate_events(scene: Scene, duration: float, progress: Progress = None) -> SimulatedRun:
    """Simulate as `simulate` does, without any sample: for long runs, and where events say all."""
    return _simulated(scene, duration, None, progress)


def columns_at(axis: Rig | Simulator, at: Instants) -> Columns:
    """Return the samples of an axis at instants as columns by name, with the time as one number."""
    rows = np.empty((len(at.seconds), len(Sample._fields)))
    axis.take_samples(at, rows)
    return columns_of_rows(rows)


def columns_of_rows(rows: NDArray[np.float64]) -> Columns:
    """Return rows, each with the fields of a sample, as columns by name, with the time as one number."""
    columns = {name: rows[:, i] for i, name in enumerate(Sample._fields)}
    return {**columns, 'time': columns['second'] + columns['fraction']}


def _simulated(scene: Scene, duration: float, sample_period: float | Fraction | None,
               progress: Progress) -> SimulatedRun:
    check_run_times(duration, sample_period)
    rig = _loaded_rig(scene)
    simulator = rig.simulator
    start = simulator.sample().mode
    period = _decimal(sample_period) if sample_period else None
    few = _sample_count(duration, period) <= MOST_HELD
    events: list[Event] = []
    held: list[NDArray[np.float64]] = []
    cost = CostMeter()
    for new_events, rows in _passage(rig, duration, period, progress):
        events += new_events
        _check_count(events, duration)
        if few:
            held.append(rows)
    spent = cost.so_far()
    simulator.require_sound()
    figures = summary(events, duration, start)
    receipt = receipt_of(scene, duration, float(sample_period) if sample_period else None, figures,
                         simulator.root_iterations, simulator.sample(), simulator.energy, *spent)
    samples: Samples = (HeldSamples(_columns(scene, np.concatenate(held), period, 0)) if few
                        else RemadeSamples(lambda: _blocks(scene, duration, period),
                                           _sample_count(duration, period)))
    return SimulatedRun(scene, duration, period, events, samples, figures, receipt)


def _passage(rig: Rig, duration: float, period: Fraction | None, progress: Progress = None
             ) -> Iterator[tuple[list[Event], NDArray[np.float64]]]:
    """Bring a rig through a run; yield its events, and a row for each sample, block by block."""
    done = 0
    for part in range(1, _PARTS + 1):
        end = _decimal(duration) * part / _PARTS
        taken = int(end / period) + 1 if period else 0
        for first in range(done, taken, GATHERED):
            at = instants(period or Fraction(0), first, min(first + GATHERED, taken))
            rows = np.empty((len(at.seconds), len(Sample._fields)))
            yield rig.take_samples(at, rows), rows
        yield rig.advance(instant_of(end)), np.empty((0, len(Sample._fields)))
        done = taken
        if progress:
            progress(part / _PARTS)


def _blocks(scene: Scene, duration: float, period: Fraction | None) -> Iterator[Columns]:
    """Run a scene again for its samples: the same to the last bit."""
    done = 0
    for _, rows in _passage(_loaded_rig(scene), duration, period):
        if len(rows):
            yield _columns(scene, rows, period, done)
            done += len(rows)


def check_run_times(duration: float, sample_period: float | Fraction | None) -> None:
    """Raise InputError unless a run of `duration` s with a sample every `sample_period` s can be made."""
    if not 0.0 < duration <= MAX_DURATION:
        raise InputError('duration', duration, f'> 0 and <= {MAX_DURATION:.0e} s', 'give the seconds to simulate')
    if sample_period is None:
        return
    if not 0.0 < sample_period < math.inf:
        raise InputError('sample period', float(sample_period), 'finite and > 0 s',
                         'give the seconds between two samples')
    count = _sample_count(duration, sample_period)
    if count > MAX_SAMPLES:
        raise InputError('sample period', float(sample_period), f'long enough for at most {MAX_SAMPLES} rows',
                         f'this would be {count} rows: sample less often or simulate a shorter time')


def warm_up(scene: Scene) -> None:
    """Call every function of the hot path once, so that it is compiled into the cache, or loaded from there."""
    _loaded_rig(scene).simulator.change_axis(scene.axis)


def _loaded_rig(scene: Scene) -> Rig:
    """Return a rig at time 0 whose code was loaded, so that this does not count as the cost of a run."""
    rig = scene.make_rig()
    simulator = rig.simulator
    simulator.advance(Instant(0.0, 0.0))
    simulator.command_drive(simulator.sample().drive_velocity)
    _ = simulator.energy
    rig.reset()
    return rig


def _sample_count(duration: float, sample_period: float | Fraction | None) -> int:
    return int(_decimal(duration) / _decimal(sample_period)) + 1 if sample_period else 0


def _decimal(number: float | Fraction) -> Fraction:
    """Return a time as it was written, so that 10 s hold 10000 periods of 0.001 s exactly."""
    return number if isinstance(number, Fraction) else decimal(float(number))


def _check_count(events: list[Event], duration: float) -> None:
    if len(events) > MAX_EVENTS:
        raise InputError('duration', duration, f'short enough for at most {MAX_EVENTS} events',
                         f'they were reached at t = {events[-1].time:.6g} s: simulate a shorter time')


def _columns(scene: Scene, rows: NDArray[np.float64], period: Fraction | None, first: int) -> Columns:
    """Return rows, the first of them at `first` periods, as columns by name."""
    times = multiples(period or Fraction(0), first, first + len(rows))
    return {'time': times, **{name: rows[:, i] for i, name in enumerate(Sample._fields)},
            **normal_force_of(scene, times)}
