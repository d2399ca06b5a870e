# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The folder of an identification while it works: fits that are done, so that an interrupted one goes on.

`identify.json` says what is identified; each fit that is done is a file of arrays beside it.  When all is done the
results take the place of the folder.
"""

import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np

from ...core.arrays import Numbers
from ...core.errors import InputError
from ...runs import Run
from ...runs.receipt import versions
from ...scene import Scene
from ...study.folder import KEPT

_Arrays = Mapping[str, Numbers]

_SIDECAR = 'identify.json'
_FORM = 'stickslip identification 1'
_LONGEST = 1 << 24   # bytes of a description


def facts_of(run: Run, start: Scene, free: str) -> dict[str, Any]:
    """Return what an identification is of, by hashes of the readings, the scene and the text of what is free."""
    readings = hashlib.sha256()
    for name, column in sorted(run.samples.items()):
        readings.update(name.encode())
        readings.update(np.ascontiguousarray(column, dtype=np.float64).tobytes())
    return {'form': _FORM, 'run': readings.hexdigest(), 'scene': start.hash,
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
            raise InputError('--out', str(self.path), 'a place that can be written',
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
                raise InputError('--resume', str(self.path), f'the folder of this very identification; its {name} is '
                                 'another', 'give the same run, scene and file, or another folder')
