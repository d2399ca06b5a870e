# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Writes a run that was measured into a bag: what was measured, and nothing else."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.version import __version__
from . import topics
from .bag import BagWriter
from .message_rows import MessageRows
from .offline_bag import interleaved
from .schemas import flat_layout

MEASURED = 'measured'            # the origin in the metadata of such a bag, and there the names of what was measured
NO_MODE = 255                    # of a state whose mode nobody measured
OF_STATE = ('position', 'velocity', 'acceleration', 'drive_position', 'drive_velocity', 'drive_force')
OF_FORCES = {'friction_force': topics.FRICTION_FORCE, 'external_force': topics.EXTERNAL_FORCE}
_LATEST = 9.2e9                   # s: log times are whole nanoseconds of 64 bits


def write_measured(folder: Path | str, times: Numbers, columns: Mapping[str, Numbers], facts: Mapping[str, str]
                   ) -> None:
    """Write columns over time (s, rising) in SI, named as in OF_STATE and OF_FORCES; a state that is lacking is NaN.

    `facts` say where they come from.  Raises InputError on times that no bag can have, and RecordingError.
    """
    if not 0.0 <= times[0] <= times[-1] <= _LATEST:
        raise InputError('time', float(times[0]), f'0 to {_LATEST:g} s', 'let time begin at 0 or later')
    stamps = np.rint(times * 1e9).astype(np.int64)
    used = [topics.SLIDER_STATE, *(topic for name, topic in OF_FORCES.items() if name in columns)]
    steps = np.arange(len(times), dtype=np.int64)
    numbers = _numbers(steps, times, columns)
    rows = []
    for channel, topic in enumerate(used, 1):
        own = numbers if topic != topics.EXTERNAL_FORCE else {'force': columns['external_force']}
        rows.append(MessageRows(channel, flat_layout(topic.type)).packed(stamps, stamps, steps, own))
    metadata = {'version': __version__, 'origin': MEASURED, MEASURED: ','.join(columns), **facts}
    bag = BagWriter(folder, [topic.resolved() for topic in used], {}, metadata)
    try:
        bag.write_block(interleaved(rows, stamps, []))
        bag.close()
    except BaseException:
        bag.abandon()
        raise


def _numbers(steps: NDArray[np.int64], times: Numbers, columns: Mapping[str, Numbers]) -> dict[str, NDArray[Any]]:
    """Return the fields of the messages of states and friction."""
    count = len(times)
    unknown = np.full(count, np.nan)
    return {
        'step': steps, 'time': times, **{name: columns.get(name, unknown) for name in OF_STATE},
        'rest_time': unknown, 'mode': np.full(count, NO_MODE), 'direction': np.zeros(count, np.int64),
        'force': columns.get('friction_force', unknown), 'coefficient': unknown, 'contact_deflection': unknown,
    }
