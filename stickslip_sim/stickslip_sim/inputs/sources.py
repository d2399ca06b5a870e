# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a user names as a source: a recorded run, a folder or an .mcap file, or a scene."""

import os
import warnings
from pathlib import Path

from ..core.errors import InputError, RecordingWarning, paths_beside, suggestion
from ..recording import RecordedRun, read_run
from ..scene import scene_names
from ..scene.load import ENDINGS

_OF_RUNS = ('.mcap',)
_OF_A_GLOB = '*?['
_A_RUN = 'a recorded run, a folder or an .mcap file'


def names_recording(path: str) -> bool:
    """Return whether a path is that of a recorded run: a folder, or an .mcap file."""
    return os.path.isdir(path) or Path(path).suffix in _OF_RUNS


def is_recorded(source: str) -> bool:
    """Return whether a source is a recorded run; the name of a shipped scene is the scene.

    Raises InputError when it is neither a recorded run, nor the file of a scene.
    """
    if source in scene_names():
        return False
    if not os.path.lexists(source):
        raise _is_not_there('RUN_OR_SCENE', source, 'a recorded run or a scene', scene_names(), (*_OF_RUNS, *ENDINGS))
    return names_recording(source)


def recorded_run(path: str) -> RecordedRun:
    """Return a recorded run without warnings: each verb says in its own words what is missing of it.

    Raises RecordingError, and InputError where nothing is.
    """
    check_run(path)
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RecordingWarning)
        return read_run(path)


def check_run(path: str) -> None:
    """Raise InputError unless something is where a recorded run should be."""
    if os.path.lexists(path):
        return
    if path in scene_names():
        raise InputError('RUN', path, _A_RUN, f'this is a scene: record it with stickslip simulate {path} --duration 10'
                         ' --bag FOLDER')
    raise _is_not_there('RUN', path, _A_RUN, [], _OF_RUNS)


def _is_not_there(name: str, source: str, allowed: str, known: list[str], endings: tuple[str, ...]) -> InputError:
    """Return what is wrong with a path or name that nothing has, with the nearest one."""
    if any(letter in source for letter in _OF_A_GLOB):
        return InputError(name, source, allowed, 'no such run: nothing matches it')
    words = [] if os.sep in source else known
    beside = paths_beside(Path(source), endings, folders=True)
    written = [f'.{os.sep}{word}' if source.startswith(f'.{os.sep}') else word for word in beside]
    what = 'no such file' if source.endswith(ENDINGS) else 'no such run' if not words else 'no such run or scene'
    meant = suggestion(source, [*words, *written], '')
    return InputError(name, source, allowed, f'{what}; {meant}' if meant else f'{what}: check the name')
