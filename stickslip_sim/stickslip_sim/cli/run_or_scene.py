# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The argument RUN_OR_SCENE."""

from pathlib import Path


def is_recorded(source: str) -> bool:
    """Return whether this is a recorded run, a folder or an .mcap file; the name of a shipped scene is the scene."""
    from ..scene import scene_names

    path = Path(source)
    return source not in scene_names() and (path.is_dir() or path.suffix == '.mcap')
