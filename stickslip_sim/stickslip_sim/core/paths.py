# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Places in the file system."""

import os
from pathlib import Path


def nearest_existing(path: Path) -> Path:
    """Return an absolute path, or the closest of the folders around it that is there."""
    return next(place for place in (path, *path.parents) if os.path.lexists(place))
