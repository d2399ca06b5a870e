# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The states and the friction of the same steps: of columns, or block by block as they stand in a bag."""

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from ..runs import Columns
from ..runs.samples import GATHERED, joined
from .topics import FRICTION_FORCE, SLIDER_STATE, Topic

Pair = tuple[Columns, Columns]   # states, friction


class OutOfOrderError(Exception):
    """What was recorded does not come in the order of its steps: it must be looked at as a whole."""


def of_the_same_steps(states: Columns, friction: Columns) -> Pair:
    """Return the rows of both whose steps are in both, in the order of the steps, each once."""
    if _rise(states) and len(states['step']) == len(friction['step']) and (states['step'] == friction['step']).all():
        return states, friction
    _, rows, others = np.intersect1d(states['step'], friction['step'], return_indices=True)
    return _taken(states, rows), _taken(friction, others)


def paired_blocks(blocks: Iterable[tuple[Topic, Columns]]) -> Iterator[Pair]:
    """Yield what `of_the_same_steps` returns block by block; raises OutOfOrderError where steps do not rise."""
    waiting: dict[Topic, list[Columns]] = {SLIDER_STATE: [], FRICTION_FORCE: []}
    rows, end = dict.fromkeys(waiting, 0), -1
    for topic, block in blocks:
        waiting[topic].append(block)
        rows[topic] += len(block['step'])
        if min(rows.values()) >= GATHERED:
            pair, waiting, end = _split(waiting, end)
            rows = {topic: len(held[0]['step']) for topic, held in waiting.items()}
            yield pair
    if all(rows.values()):
        yield _split(waiting, end)[0]


def _split(waiting: dict[Topic, list[Columns]], after: int) -> tuple[Pair, dict[Topic, list[Columns]], int]:
    """Return the pairs in what waits, all of steps after another; what goes on waiting; the last step of the pairs."""
    columns = {topic: joined(held) for topic, held in waiting.items()}
    if not all(int(held['step'][0]) > after and _rise(held) for held in columns.values()):
        raise OutOfOrderError
    end = min(int(held['step'][-1]) for held in columns.values())
    counts = {topic: int(np.searchsorted(held['step'], end, 'right')) for topic, held in columns.items()}
    states, friction = (_taken(held, slice(counts[topic])) for topic, held in columns.items())
    return (of_the_same_steps(states, friction),
            {topic: [_taken(held, slice(counts[topic], None))] for topic, held in columns.items()}, end)


def _rise(columns: Columns) -> bool:
    return bool((np.diff(columns['step'].astype(np.int64)) > 0).all())


def _taken(columns: Columns, rows: slice | NDArray[np.intp]) -> Columns:
    return {name: column[rows] for name, column in columns.items()}
