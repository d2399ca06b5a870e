# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What is fuzzed, by name: what is made up, and who reads it, called as the product calls it.

Runs are the scenes of `tests.hostile`, with random numbers that hypothesis chooses: a find is made as small as it goes.
"""

import random
import shutil
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from hypothesis import assume
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from stickslip_sim.check.limits import limits_of
from stickslip_sim.check.observed_run import gaps_in, observed_motion, timing_of
from stickslip_sim.check.remake import doubts_about
from stickslip_sim.check.verification import verify
from stickslip_sim.cli.csv_tables import csv_lines
from stickslip_sim.core.errors import InputError, RecordingWarning, SolverError
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import Bag, RecordedRun, open_bag, read_run
from stickslip_sim.recording.reader import Recording
from stickslip_sim.scene import parse_override, parse_scene, scene_names
from stickslip_sim.scene.ros_yaml import read_yaml
from stickslip_sim.study import EvenGrid, Study, variation
from stickslip_sim.study.diagrams import check_drawable, point_of
from stickslip_sim.study.uncertainty import uncertain_of
from stickslip_sim.study.variation import range_of
from tests.hostile.attack import judge_again
from tests.hostile.case import Case, Undecided, run
from tests.hostile.generators import GENERATORS
from tests.hostile.judges import reference
from tests.support import made_up_bags, made_up_texts, small_recordings
from tests.support.made_up_texts import accepts_or_refuses
from tests.support.repository import ROOT
from tests.support.time_and_memory import within

from . import studies
from .studies import Edited, call_tool

_PATIENCE = 20.0   # s for one input; the host may stand still for a while


class Target(NamedTuple):
    """Inputs, and what must get along with each of them."""

    inputs: SearchStrategy[object]
    read: Callable[[object], None]


def targets(folder: Path) -> Mapping[str, Target]:
    """Return all targets; bags are put into a folder."""
    scenes = [(ROOT / f'stickslip_sim/stickslip_sim/scenes/{name}.yaml').read_text() for name in scene_names()]
    shipped = [(ROOT / 'examples/limits.yaml').read_text()]
    runs = st.builds(made_scene, st.sampled_from(list(GENERATORS)), st.randoms(use_true_random=False))
    changes = st.tuples(st.sampled_from(scene_names()), made_up_texts.OVERRIDES, made_up_texts.OVERRIDES)
    file = folder / 'run.mcap'

    def bag(data: bytes) -> None:
        file.write_bytes(data)
        read_bag(file)

    found: dict[str, tuple[SearchStrategy[Any], Callable[..., None]]] = {
        'scene': (made_up_texts.changed(scenes) | made_up_texts.ANYTHING, scene),
        'limits': (made_up_texts.changed(shipped) | made_up_texts.ANYTHING, limits),
        'override': (changes, lambda given: override(*given)),
        'bag': (made_up_bags.changed(small_recordings.files(folder)), bag),
        'distributions': (studies.DISTRIBUTIONS, distributions),
        'options': (studies.OPTIONS, lambda given: options(*given)),
        'study': (studies.folders(folder), lambda given: study(given, folder / 'study')),
        'engine': (runs, engine),
        'reference': (runs, automaton),
    }
    return {name: Target(inputs, _bounded(read)) for name, (inputs, read) in found.items()}


def _bounded(read: Callable[..., None]) -> Callable[[object], None]:
    def bounded(given: object) -> None:
        with within(_PATIENCE):
            read(given)

    return bounded


def scene(text: str) -> None:
    """Read a scene file, and what it came to once more."""
    found: Any = accepts_or_refuses(parse_scene, text)
    if found is not None:
        assert parse_scene(found.text).hash == found.hash


def limits(text: str) -> None:
    """Read a limits file."""
    accepts_or_refuses(lambda: limits_of(read_yaml(text)))


def override(name: str, *changes: str) -> None:
    """Change a shipped scene as --set does."""
    accepts_or_refuses(lambda: load_scene(name, dict(parse_override(change) for change in changes)))


def distributions(text: str) -> None:
    """Read a file of distributions."""
    accepts_or_refuses(lambda: uncertain_of(read_yaml(text)))


def options(over: str, between: str, pick: str, show: str) -> None:
    """Read what describes a study on a command line."""
    for drawn in (True, False):
        accepts_or_refuses(variation, over, drawn)
    accepts_or_refuses(range_of, '--between', over.partition('=')[0], between)
    values = load_scene('paper_fig7').values
    study: Any = accepts_or_refuses(lambda: Study(values, EvenGrid((variation(over),)), 1.0))
    if study is not None:
        accepts_or_refuses(check_drawable, study, show)
        accepts_or_refuses(point_of, study, pick)


def study(edited: Edited, folder: Path) -> None:
    """Draw what is in the folder of a study, and resume it."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for name, text in edited.files.items():
        (folder / name).write_text(text, encoding='utf-8', errors='surrogatepass', newline='')
    call_tool('map', str(folder), '--out', str(folder / 'map.svg'))
    call_tool(*edited.command, '--out', str(folder), '--resume')


def read_bag(path: Path) -> None:
    """Read a bag in every way that there is."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RecordingWarning)
        run = accepts_or_refuses(open_bag, path)
        if isinstance(run, Bag):
            for look in (lambda run: run.scene, lambda run: run.receipt, lambda run: run.events):
                accepts_or_refuses(look, run)
            for topic in run.topics:
                accepts_or_refuses(lambda run, topic: list(csv_lines(run.column_blocks(topic))), run, topic)
        recorded = accepts_or_refuses(read_run, path)
        if isinstance(recorded, RecordedRun):
            for use in (observed_motion, timing_of, lambda run: list(gaps_in(run)), doubts_about, verify,
                        lambda run: (run.samples, run.events), lambda run: (run.summary, run.cycles())):
                accepts_or_refuses(use, recorded)
        accepts_or_refuses(_play, path)


def _play(path: Path) -> None:
    """Take all messages out of a bag, as replay_node does."""
    recording = Recording(path)
    for message in recording.messages(recording.topics, recording.begin, recording.end):
        assert message.topic in recording.topics


def made_scene(name: str, rng: random.Random) -> Case:
    """Make up a scene; what its generator itself refuses is none."""
    try:
        return GENERATORS[name](rng)
    except InputError:
        assume(False)
        raise


def engine(case: Case) -> None:
    """Run a scene, and let all judges look at it."""
    try:
        found = judge_again(case, 'fuzz', reference_too=False)
    except (InputError, SolverError):
        return
    assert not found, (case, found)


def automaton(case: Case) -> None:
    """Run a scene, and compare its first events with those of the reference; raises Find."""
    try:
        reference.judge(run(case.parts))
    except (InputError, SolverError, Undecided):
        return
