# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What is fuzzed, by name: what is made up, and who reads it."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from stickslip_sim.scene import scene_names
from tests.support import made_up_bags, made_up_texts, small_recordings
from tests.support.repository import ROOT
from tests.support.time_and_memory import within

from . import engine, judge, made_up_axes, readers, studies

_PATIENCE = 20.0   # s for one input; the host may stand still for a while


class Target(NamedTuple):
    """Inputs, and what must get along with each of them."""

    inputs: SearchStrategy[object]
    read: Callable[[object], None]


def targets(folder: Path) -> Mapping[str, Target]:
    """Return all targets; bags are put into a folder."""
    scenes = [(ROOT / f'stickslip_sim/stickslip_sim/scenes/{name}.yaml').read_text() for name in scene_names()]
    limits = [(ROOT / 'examples/limits.yaml').read_text()]
    changes = st.tuples(st.sampled_from(scene_names()), made_up_texts.OVERRIDES, made_up_texts.OVERRIDES)
    file = folder / 'run.mcap'

    def bag(data: bytes) -> None:
        file.write_bytes(data)
        readers.bag(file)

    found: dict[str, tuple[SearchStrategy[Any], Callable[..., None]]] = {
        'scene': (made_up_texts.changed(scenes) | made_up_texts.ANYTHING, readers.scene),
        'limits': (made_up_texts.changed(limits) | made_up_texts.ANYTHING, readers.limits),
        'override': (changes, lambda given: readers.override(*given)),
        'bag': (made_up_bags.changed(small_recordings.files(folder)), bag),
        'distributions': (studies.DISTRIBUTIONS, readers.distributions),
        'options': (studies.OPTIONS, lambda given: readers.options(*given)),
        'study': (studies.folders(folder), lambda given: readers.study(given, folder / 'study')),
        'engine': (made_up_axes.machines() | made_up_axes.shaken(), engine.holds),
        'reference': (made_up_axes.machines() | made_up_axes.shaken(), judge.equals_the_reference),
    }
    return {name: Target(inputs, _bounded(read)) for name, (inputs, read) in found.items()}


def _bounded(read: Callable[..., None]) -> Callable[[object], None]:
    def bounded(given: object) -> None:
        with within(_PATIENCE):
            read(given)

    return bounded
