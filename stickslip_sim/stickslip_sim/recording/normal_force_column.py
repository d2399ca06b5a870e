# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The normal force beside the friction forces of a bag, where its scene lets it vary: no message has it."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ..core.errors import RecordingError
from ..runs import Columns
from ..runs.normal_force import recorded_normal_force
from .reader import Bag
from .topics import FRICTION_FORCE, PARAMETER_EVENTS


def is_changed(bag: Bag) -> bool:
    """Whether parameters were changed while a run was recorded."""
    return any(bag.counts.get(name) for name, kind in bag.topics.items() if kind == PARAMETER_EVENTS.type)


def normal_force_beside(bag: Bag, topic: str) -> Callable[[Mapping[str, Any]], Columns]:
    """Return what makes the column for columns of a topic; none for other topics, or where N does not vary."""
    try:
        varies = bag.topics[bag.resolved(topic)] == FRICTION_FORCE.type and bag.scene.normal_load is not None
    except RecordingError:   # no scene that this version can read
        varies = False
    if not varies:
        return lambda _: {}
    changed = is_changed(bag)
    return lambda columns: recorded_normal_force(bag.scene, {
        'time': np.asarray(columns['log_time']) / 1e9, 'friction_force': np.asarray(columns['force']),
        'friction_coefficient': np.asarray(columns['coefficient'])}, changed)
