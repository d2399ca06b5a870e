# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Fits from many starts: on several processes at once, and kept, so that an interrupted identification goes on.

Which fits there are and in which order they end does not depend on the processes: the result is the same to the last
bit.
"""

import hashlib
import json
import os
import shutil
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import ExitStack, suppress
from copy import deepcopy
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, Protocol
from zipfile import BadZipFile

import numpy as np

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..report.values import versions
from ..runs import Run
from ..scene import Scene
from ..study.folder import KEPT
from ..study.sweep import processes
from .fit_problem import FitProblem
from .least_squares import Solution
from .readings import hash_of
from .stages import Ended, fit_from

_Arrays = Mapping[str, Numbers]


class Keeper(Protocol):
    """Keeps the arrays of fits that are done, each under a key."""

    def found(self, key: str) -> _Arrays | None:
        """Return what is kept, None where there is nothing."""

    def keep(self, key: str, arrays: _Arrays) -> None:
        """Keep the arrays of a fit."""


class KeyedFit(NamedTuple):
    """A fit to be made, of a problem from a start, and the key under which it is kept."""

    key: str
    problem: FitProblem
    start: Numbers


class _Fitted(NamedTuple):
    """The end of a fit, and how many simulations it took."""

    end: Ended
    runs: int


def fits_from(problem: FitProblem, starts: Iterator[Numbers], workers: int, keeper: Keeper | None, name: str = 'fit'
              ) -> Generator[Ended, None, None]:
    """Yield the fit from each start, in their order; the first is made alone, for it may be good enough."""
    keyed = (KeyedFit(f'{name}_{k}', problem, start) for k, start in enumerate(starts))
    yield from kept_fits([next(keyed)], 1, keeper)
    yield from kept_fits([*keyed], workers, keeper)


def kept_fits(fits: Sequence[KeyedFit], workers: int, keeper: Keeper | None) -> Generator[Ended, None, None]:
    """Yield where fits end, in their order; those that are kept are not made again."""
    with ExitStack() as stack:
        works: list[Callable[[], _Fitted]] = [partial(_fit, one.problem, one.start) for one in fits]
        if min(workers, len(fits)) > 1:
            pool = stack.enter_context(processes(min(workers, len(fits)))).pool
            works = [pool.submit(work).result for work in works]
        for one, work in zip(fits, works, strict=True):
            yield _kept(one.problem, one.key, work, keeper)


def _kept(problem: FitProblem, key: str, work: Callable[[], _Fitted], keeper: Keeper | None) -> Ended:
    arrays = None if keeper is None else keeper.found(key)
    fitted = work() if arrays is None else _of_arrays(arrays)
    if arrays is None and keeper is not None:
        keeper.keep(key, _arrays(fitted))
    problem.model.runs += fitted.runs
    return fitted.end


def _fit(problem: FitProblem, start: Numbers) -> _Fitted:
    """Return the fit of a copy of a problem: what one fit leaves in it changes no other, as between processes."""
    own = deepcopy(problem)
    end = fit_from(own, start)
    return _Fitted(end, own.model.runs - problem.model.runs)


def _arrays(fitted: _Fitted) -> _Arrays:
    end = fitted.end
    numbers = np.array([end.solution.cost, end.is_off, end.is_lost, end.tolerance or 0.0, end.solution.is_settled,
                        fitted.runs], dtype=np.float64)
    return {'start': end.start, 'point': end.solution.point, 'information': end.solution.information,
            'numbers': numbers}


def _of_arrays(arrays: _Arrays) -> _Fitted:
    cost, is_off, is_lost, tolerance, is_settled, runs = arrays['numbers'].tolist()
    solution = Solution(arrays['point'], cost, arrays['information'], bool(is_settled))
    return _Fitted(Ended(arrays['start'], solution, bool(is_off), bool(is_lost), tolerance or None), int(runs))


# The folder of an identification while it works: fits that are done, so that an interrupted one goes on.
#
# `identify.json` says what is identified; each fit that is done is a file of arrays beside it.  When all is done the
# results take the place of the folder.

_SIDECAR = 'identify.json'
_FORM = 'stickslip identification 1'
_LONGEST = 1 << 24   # bytes of a description


def facts_of(runs: Sequence[Run], start: Scene, free: str) -> dict[str, Any]:
    """Return what an identification is of, by hashes of the readings, the scene and the text of what is free."""
    return {'form': _FORM, 'run': ' '.join(map(hash_of, runs)), 'scene': start.hash,
            'free': hashlib.sha256(free.encode()).hexdigest(), 'versions': versions()}


class WorkFolder:
    """The folder `path` of an identification; it is made with the first fit.  Raises InputError."""

    def __init__(self, path: str | Path, described: Mapping[str, Any], resume: bool) -> None:
        self.path = Path(path)
        self._described = dict(described)
        if resume:
            self._check_same()

    @property
    def exists(self) -> bool:
        """Whether there is something to go on with."""
        return (self.path / _SIDECAR).is_file()

    def found(self, key: str) -> _Arrays | None:
        """Return the arrays of a fit that was kept; None without any, or of a file that a crash left damaged."""
        if self.exists:
            with (suppress(OSError, ValueError, KeyError, EOFError, BadZipFile),
                  np.load(self.path / f'{key}.npz', allow_pickle=False) as file):
                return {name: file[name] for name in file.files}
        return None

    def keep(self, key: str, arrays: _Arrays) -> None:
        """Put the arrays of a fit into a file: whole, or not at all."""
        temporary = self.path / f'.{os.getpid()}.npz'
        try:
            self._begin()
            np.savez(temporary, **arrays)   # type: ignore[arg-type]
            temporary.replace(self.path / f'{key}.npz')
        except OSError as error:
            raise InputError('--out', str(self.path), 'a writable place',
                             f'{error.strerror or error}; {KEPT}') from None

    @property
    def results(self) -> str:
        """Where to make the folder of results: beside this one while there is one, else in its place."""
        return str(self.path.with_name(f'.{os.getpid()}.{self.path.name}.results') if self.exists else self.path)

    def finish(self) -> None:
        """Put the folder of results in the place of this one, if they are beside it."""
        if self.exists:
            results = Path(self.results)
            shutil.rmtree(self.path)
            results.rename(self.path)

    def _begin(self) -> None:
        if not self.exists:
            self.path.mkdir(parents=True)
            text = json.dumps(self._described, indent=1) + '\n'
            (self.path / _SIDECAR).write_text(text, encoding='utf-8')

    def _check_same(self) -> None:
        file = self.path / _SIDECAR
        found: object = None
        with suppress(OSError, ValueError, RecursionError):
            if file.stat().st_size <= _LONGEST:
                found = json.loads(file.read_text(encoding='utf-8'))
        if not isinstance(found, dict) or found.get('form') != _FORM:
            raise InputError('--resume', str(self.path), f'the folder of an interrupted identification, with '
                             f'{_SIDECAR} in it', 'a finished one has its results; else leave --resume out')
        for name, value in self._described.items():
            if found.get(name) != value:
                raise InputError('--resume', str(self.path), f'the folder of this identification; its {name} is '
                                 'another', 'give the same run, scene and file, or another folder')
