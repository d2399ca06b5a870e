# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The arguments RUN and RUN_OR_SCENE."""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..recording import RecordedRun


def is_recorded(source: str) -> bool:
    """Return whether this is a recorded run, a folder or an .mcap file; the name of a shipped scene is the scene."""
    from ..scene import scene_names

    path = Path(source)
    return source not in scene_names() and (path.is_dir() or path.suffix == '.mcap')


def recorded_run(path: str) -> 'RecordedRun':
    """Return a recorded run; each verb says in its own words what is missing of it.  Raises RecordingError."""
    from ..core.errors import RecordingWarning
    from ..recording import read_run

    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RecordingWarning)
        return read_run(path)
