# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The arguments RUN and RUN_OR_SCENE."""

import os
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..recording import RecordedRun
    from ..runs import Run

_OF_RUNS, _OF_SCENES = ('.mcap',), ('.yaml', '.yml')
_OF_A_GLOB = '*?['
_A_RUN = 'a recorded run, a folder or an .mcap file'


def is_recorded(source: str) -> bool:
    """Return whether this is a recorded run, a folder or an .mcap file; the name of a shipped scene is the scene.

    Raises InputError when it is neither, nor the file of a scene.
    """
    from ..scene import scene_names

    path = Path(source)
    if source in scene_names():
        return False
    if not os.path.lexists(path):
        raise _is_not_there('RUN_OR_SCENE', source, 'a recorded run or a scene', scene_names(), _OF_RUNS + _OF_SCENES)
    return path.is_dir() or path.suffix in _OF_RUNS


def recorded_run(path: str) -> 'RecordedRun':
    """Return a recorded run; each verb says in its own words what is missing of it.

    Raises RecordingError, and InputError where nothing is.
    """
    from ..core.errors import RecordingWarning
    from ..recording import read_run
    from .progress import progress_bar

    check_run(path)
    with warnings.catch_warnings(), progress_bar('reading'):
        warnings.simplefilter('ignore', RecordingWarning)
        return read_run(path)


def file_stem(run: 'Run') -> str:
    """Return the name of a run as that of a file, without an ending: sweep_1.0 stays sweep_1.0."""
    from ..scene.text import file_name

    return file_name(run.name.removesuffix(_OF_RUNS[0]) if run.is_recorded else run.name)


def check_run(path: str) -> None:
    """Raise InputError unless something is where a recorded run should be."""
    from ..core.errors import InputError
    from ..scene import scene_names

    if os.path.lexists(path):
        return
    if path in scene_names():
        raise InputError('RUN', path, _A_RUN, f'this is a scene: record it with stickslip simulate {path} --duration 10'
                         ' --bag FOLDER')
    raise _is_not_there('RUN', path, _A_RUN, [], _OF_RUNS)


def _is_not_there(name: str, source: str, allowed: str, known: list[str], endings: tuple[str, ...]) -> Exception:
    """Return what is wrong with a path or name that nothing has, with the nearest one."""
    from ..core.did_you_mean import paths_beside, suggestion
    from ..core.errors import InputError

    if any(letter in source for letter in _OF_A_GLOB):
        return InputError(name, source, allowed, 'no such run: nothing matches it')
    words = [] if os.sep in source else known
    beside = paths_beside(Path(source), endings, folders=True)
    written = [f'.{os.sep}{word}' if source.startswith(f'.{os.sep}') else word for word in beside]
    what = 'no such file' if source.endswith(_OF_SCENES) else 'no such run' if not words else 'no such run or scene'
    meant = suggestion(source, [*words, *written], '')
    return InputError(name, source, allowed, f'{what}; {meant}' if meant else f'{what}: check the name')
