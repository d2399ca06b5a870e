# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Names of new folders: by the time of day, and none that is in use."""

import os
import time
from pathlib import Path


def stamped_folder(place: Path, name: str) -> Path:
    """Return the path of a folder that does not exist: `name` and the time of day, UTC to the second.

    A number follows where that is taken: axes may start in the same second.
    """
    first = place / f'{name}_{time.strftime("%Y%m%dT%H%M%SZ", time.gmtime())}'
    folder, number = first, 1
    while os.path.lexists(folder):
        number += 1
        folder = first.with_name(f'{first.name}_{number}')
    return folder
