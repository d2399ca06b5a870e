# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A thousand closed loops: how many pass, which limit decides, and the worst of them."""

import os
import pickle
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..controllers.own_controller import parse_gain
from ..core.arrays import Flags, Numbers, data_frame
from ..core.errors import InputError
from ..core.paths import check_picture_name, replacing
from ..core.types import Progress
from ..inputs import SceneOrName, scene_of
from ..report.values import json_text
from ..study.folder import Folder, process_count, refusing
from ..study.sample import Distribution, EvenGrid, Sobol
from ..study.sweep import Workers, carry_out, columns_of, processes
from ..study.table import in_words
from ..study.uncertainty import PERCENTS, load_uncertain, percentiles
from ..study.variation import GAIN, Variation, variation
from .loop import ClosedLoopRun, Given, measured_scene, setpoints_at, steps_of
from .study import FOLDER_FORM, Attempt, LoopStudy, Outcome, loop_parameter, repr_of

Range = Any    # LOW:HIGH[:N][:log], or a tuple of these numbers
RESULT, WORST, MAP = 'result.json', 'worst', 'map.png'
_CONFIDENCE = 0.95
_MOST_REASONS = 20   # of points that failed, which are run again to say them


class PassRate(NamedTuple):
    """How many of the points passed, and Wilson's interval of 95 % of the share that it is drawn from."""

    passed: int
    points: int
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class ClosedLoops:
    """The points of a study of closed loops: a column for each number that varies, and for each figure."""

    study: LoopStudy
    columns: dict[str, Numbers]
    ran: int

    @property
    def outcomes(self) -> list[str]:
        """What each point came to: passed, limits missed, controller failed, solver gave up, refused."""
        return in_words(self.study, self.columns['outcome'])

    @cached_property
    def pass_rate(self) -> PassRate:
        """How many points passed; those that failed in any way did not."""
        from scipy.stats import binomtest

        passed = int((self.columns['outcome'] == Outcome.PASSED).sum())
        low, high = binomtest(passed, self.study.count).proportion_ci(_CONFIDENCE, 'wilson')
        return PassRate(passed, self.study.count, float(low), float(high))

    @cached_property
    def matrix(self) -> Flags:
        """Whether each point (rows) kept each limit (columns)."""
        limits = self.study.limits
        kept = [one.is_kept(self.columns[one.name]) for one in (limits.limits if limits else ())]
        return np.array(kept, dtype=bool).reshape(len(kept), self.study.count).T

    @cached_property
    def percentiles(self) -> dict[str, dict[int, float] | None]:
        """The percentiles of each figure, of the points that have it."""
        found = {name: percentiles(self.columns[name]) for name in self.study.figure_names[1:]}
        return {name: dict(zip(PERCENTS, values)) if values else None for name, values in found.items()}

    @cached_property
    def worst(self) -> dict[str, int]:
        """The point at which each limit is exceeded most, or kept least; none of a limit that no point has."""
        limits = self.study.limits.limits if self.study.limits else ()
        return {one.name: int(np.nanargmin(values) if one.kind.is_least else np.nanargmax(values)) for one in limits
                if not np.isnan(values := self.columns[one.name]).all()}

    @cached_property
    def reasons(self) -> dict[int, str]:
        """Why the first points failed that missed no limit; they are run again for it."""
        failed = np.flatnonzero(self.columns['outcome'] > Outcome.MISSED).tolist()
        return {i: self.attempt(i).reason or 'did not fail when it was run again: the controller is not deterministic'
                for i in failed[:_MOST_REASONS]}

    def point(self, i: int) -> dict[str, float]:
        """Return the numbers of a point by name."""
        return {name: float(self.columns[name][i]) for name in self.study.names}

    def attempt(self, i: int) -> Attempt:
        """Run a point again: the run, the outcome of each limit, and why it failed."""
        return self.study.attempt(np.array(list(self.point(i).values())))

    def run(self, i: int) -> ClosedLoopRun:
        """Return the run of a point, made again; raises InputError where it has none."""
        run = self.attempt(i).run
        if run is None:
            raise InputError('point', i, 'one that ran', self.attempt(i).reason)
        return run

    def frame(self) -> Any:
        """Return the columns as a pandas.DataFrame, the outcomes in words; raises InputError without pandas."""
        return data_frame({**self.columns, 'outcome': self.outcomes}, 'columns')

    def plot(self, path: Path | str, over: tuple[str, str] | None = None) -> None:
        """Draw which points pass `over` two of the numbers that vary, without it the first two; raises InputError."""
        check_picture_name('path', path)
        names = over or self.study.names[:2]
        if len(names) != 2 or len(set(names)) != 2 or not set(names) <= set(self.study.names):
            raise InputError('over', names, f'two of {", ".join(self.study.names)}', 'a map needs two that vary')
        from ..plots.stability_map import plot_pass_map  # matplotlib takes half a second
        from ..plots.style import Scale

        variations = {one.name: one for one in self.study.sample.variations}
        scales = [Scale(name, variations[name].unit, isinstance(one := variations[name], Variation) and one.log)
                  for name in names]
        x, y = (self.columns[name] for name in names)
        rate = self.pass_rate
        plot_pass_map((scales[0], scales[1]), x, y, self.outcomes, list(self.study.words.values()),
                      f'{rate.passed} of {rate.points} pass: {rate.low:.1%} to {rate.high:.1%}', path)

    def values(self) -> dict[str, Any]:
        """Return all that was found as JSON values."""
        kept = self.matrix.sum(axis=0).tolist()
        return {'scene': self.study.scene.name, 'scene_hash': self.study.scene.hash, 'points': self.study.count,
                'pass_rate': {**self.pass_rate._asdict(), 'confidence': _CONFIDENCE},
                'outcomes': {word: self.outcomes.count(word) for word in self.study.words.values()},
                'limits': {name: {'kept': number, 'worst_point': self.worst.get(name),
                                  'worst': float(self.columns[name][self.worst[name]]) if name in self.worst else None,
                                  'at': self.point(self.worst[name]) if name in self.worst else None}
                           for name, number in zip(self.study.limit_names, kept)},
                'percentiles': self.percentiles,
                'reasons': {str(i): {'at': self.point(i), 'reason': reason} for i, reason in self.reasons.items()}}

    def keep(self, folder: Path | str) -> None:
        """Write the result, the worst run of each limit (bag and picture) and the map into the folder of the study.

        What is there already stays.  Raises RecordingError, OSError.
        """
        place = Path(folder)
        for name, i in self.worst.items():
            bag = place / WORST / ''.join(letter if letter.isalnum() or letter in '-_.' else '_' for letter in name)
            if not bag.exists() and (run := self.attempt(i).run) is not None:
                bag.parent.mkdir(exist_ok=True)
                run.save(bag)
                with replacing(bag.with_name(f'{bag.name}.png')) as picture:
                    run.plot(picture)
        if len(self.study.names) > 1:
            with replacing(place / MAP) as picture:
                self.plot(picture)
        with replacing(place / RESULT) as temporary:
            temporary.write_text(json_text(self.values()), encoding='utf-8')


def close_loops(controller: Any, scene: SceneOrName, duration: float, over: Mapping[str, Range] | None = None, *,
                samples: int | None = None, known: str | os.PathLike[str] | None = None, rate: float | None = None,
                setpoint: Given | None = None, limits: str | os.PathLike[str] | None = None,
                gains: Mapping[str, object] | None = None, vectorized: bool = False, workers: int = 1,
                out: str | os.PathLike[str] | None = None, resume: bool = False, seed: int | None = None,
                progress: Progress = None) -> ClosedLoops:
    """Let a controller drive the axis of a scene at many values of its parameters; return what becomes of each.

    `over` has a range for each parameter of the axis and its rig: (LOW, HIGH), (LOW, HIGH, N), or 'LOW:HIGH[:N][:log]';
    `gains` the same for keyword arguments of the controller, or values that stay.  With `samples` that many points are
    drawn between the ends (Sobol, from `seed`: without it that of the scene, or of `known`); else every combination of
    N values runs.  `known` is a file of distributions, as `stickslip uncertainty --with` takes it.

    `controller` is a class or, with gains, a function that makes one; it is made anew for each point.  A function
    without gains is the controller itself, an object is copied.  As 'FILE.py:NAME' it can go to `workers`, which are
    processes.  `limits` is a limits file.  A `vectorized` controller gets and answers arrays, one entry an axis.

    A folder `out` gets the table, the worst run of each limit and a map; `resume` goes on with one that was
    interrupted.  Raises InputError before anything runs; a point that fails counts as failed, and the rest goes on.
    """
    study = loop_study(controller, scene, duration, over or {}, samples, known, rate, setpoint, limits, gains or {},
                       vectorized, seed)
    if isinstance(workers, bool) or not isinstance(workers, int):
        raise InputError('workers', workers, 'a whole number of processes', 'leave it out for 1')
    count = process_count(str(workers))
    if count > 1 and not _can_be_sent(controller):
        raise InputError('controller', repr_of(controller), 'one that other processes can import',
                         "put it in a file and give 'FILE.py:NAME', or leave workers out")
    members: AbstractContextManager[Workers | None] = processes(count) if count > 1 else nullcontext()
    return run_loops(study, None if out is None else os.fspath(out), members, resume, '', progress)


def run_loops(study: LoopStudy, out: str | None, workers: AbstractContextManager[Workers | None], resume: bool,
              command: str, progress: Progress = None) -> ClosedLoops:
    """Run a study, into a folder where there is one; raises as `close_loops` does."""
    if out is None:
        with workers as members:
            return ClosedLoops(study, columns_of(study, members, progress), study.count)
    swept = carry_out(study, Folder(out, FOLDER_FORM), workers, resume, command, progress)
    found = ClosedLoops(study, swept.columns, swept.ran)
    with refusing(Path(out)):
        found.keep(out)
    return found


def loop_study(controller: Any, scene: SceneOrName, duration: float, over: Mapping[str, Range], samples: int | None,
               known: str | os.PathLike[str] | None, rate: float | None, setpoint: Given | None,
               limits: str | os.PathLike[str] | None, gains: Mapping[str, object], vectorized: bool,
               seed: int | None) -> LoopStudy:
    """Return the study that `close_loops` runs; raises InputError."""
    scene = measured_scene(scene_of(scene))
    ranges = {name: given for name, given in gains.items() if isinstance(given, tuple) or is_range(given)}
    fixed = {name: given for name, given in gains.items() if name not in ranges}
    drawn = samples is not None
    variations = tuple(_variation(name, given, drawn) for name, given in
                       [*over.items(), *((f'{GAIN}.{name}', given) for name, given in ranges.items())])
    uncertain = None if known is None else load_uncertain(known, loop_parameter)
    laws: tuple[Distribution, ...] = uncertain.distributions if uncertain else ()
    first_seed = uncertain.seed if uncertain else scene.seed
    if samples is None and uncertain:
        raise InputError('samples', None, 'given with distributions', 'say how many points to draw: 256')
    if samples is not None and (isinstance(samples, bool) or not isinstance(samples, int) or not 1 <= samples <= 2**24):
        raise InputError('samples', samples, '1 to 16777216', 'preferably a power of two')
    if not variations and not laws:
        raise InputError('over', None, 'a range of at least one parameter or gain',
                         'for example friction.scale=0.8:1.2')
    sample: EvenGrid | Sobol = EvenGrid(variations) if samples is None else Sobol(
        (*laws, *variations), samples, first_seed if seed is None else seed,
        uncertain.correlations if uncertain else None)
    times = steps_of(scene, duration)
    wanted = None if setpoint is None else setpoints_at(setpoint, times.seconds + times.fractions)
    limits_file = None if limits is None else os.path.abspath(limits)
    return LoopStudy(scene.values, sample, controller, float(duration), rate, wanted, limits_file, fixed, vectorized)


def arguments_of(texts: Sequence[str]) -> dict[str, object]:
    """Return arguments of a controller as `--gain` gives them: values, and ranges as texts; raises InputError."""
    return {name.strip(): word for name, _, word in (text.partition('=') for text in texts) if is_range(word)} | dict(
        parse_gain(text) for text in texts if not is_range(text.partition('=')[2]))


def ranges_of(texts: Sequence[str]) -> dict[str, str]:
    """Return ranges of parameters as `--over` gives them; raises InputError."""
    found: dict[str, str] = {}
    for text in texts:
        name, _, given = map(str.strip, text.partition('='))
        if not name or not given or name in found:
            raise InputError('--over', text, 'A.B=LOW:HIGH[:N][:log], once for each parameter',
                             'for example friction.scale=0.8:1.2')
        found[name] = given
    return found


def is_range(given: object) -> bool:
    """Whether what is given for an argument is a range: numbers with colons between."""
    if not isinstance(given, str) or ':' not in given:
        return False
    try:
        return bool([float(word) for word in given.split(':')[:2]])
    except ValueError:
        return False


def _can_be_sent(controller: object) -> bool:
    if getattr(controller, '__module__', '') == '__main__':
        return False
    try:
        pickle.dumps(controller)
    except (AttributeError, TypeError, pickle.PicklingError):
        return False
    return True


def _variation(name: str, given: Range, drawn: bool) -> Variation:
    """Return the range of a name; raises InputError."""
    if not isinstance(given, str):
        try:
            given = ':'.join(f'{number!r}' if i < 2 else f'{number}' for i, number in enumerate(given))
        except TypeError:
            raise InputError(name, given, '(LOW, HIGH), (LOW, HIGH, N) or LOW:HIGH[:N][:log]',
                             'for example (0.8, 1.2)') from None
    return variation(f'{name}={given}', drawn, loop_parameter)


