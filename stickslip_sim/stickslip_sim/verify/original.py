# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run that is to be run again: what it began from, and what is doubtful about it."""

import hashlib
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

from .. import __version__
from ..core.errors import RecordingError, RecordingWarning, one_line
from ..recording import Run, read_run
from ..recording.bag import METADATA
from ..recording.run import CHECKPOINT_FILE, SCENE_FILE, RunFacts
from ..scene import Scene

_MAKERS = 'version', 'python', 'platform', 'numpy', 'numba'


class Offline(NamedTuple):
    """How long an offline run was, and how often it was sampled."""

    duration: float            # s
    sample_period: Fraction    # s


@dataclass(frozen=True)
class Original:
    """A run, its scene, and what it began from: a checkpoint, or the start (None); `offline` is None for a node's."""

    run: Run
    scene: Scene
    checkpoint: Mapping[str, Any] | None
    offline: Offline | None
    notes: tuple[str, ...]   # for people


def open_original(path: Path | str) -> Original:
    """Return the original in a run folder or an MCAP file; raises RecordingError when it cannot be run again."""
    with warnings.catch_warnings():
        warnings.simplefilter('ignore', RecordingWarning)   # told by the notes
        run = read_run(path)
    if not run.is_complete and not run.topics:
        raise RecordingError(f'{run.path}: cut off before its first message was written')
    facts = run.metadata.get(METADATA)
    if facts is None:
        raise RecordingError(f'{run.path}: it does not say what it was simulated with; give a run that stickslip '
                             'recorded')
    return Original(run, run.scene, _checkpoint(run), _offline(run, facts), tuple(map(one_line, _notes(run, facts))))


def made_with(original: Original) -> str:
    """Return what of the recording's versions and machine is not as here, and what is here instead; for people."""
    recorded, here = original.run.metadata[METADATA], RunFacts.of(original.scene).as_metadata()
    others = [f'{name} {recorded[name]} (here {here[name]})' for name in _MAKERS
              if recorded.get(name, here[name]) != here[name]]
    return one_line(', '.join(others)) or 'the same versions on the same kind of machine'


def _checkpoint(run: Run) -> Mapping[str, Any] | None:
    return run.values(CHECKPOINT_FILE) if CHECKPOINT_FILE in run.attachments else None


def _offline(run: Run, facts: Mapping[str, str]) -> Offline | None:
    if facts.get('origin') == 'node':
        return None
    try:
        return Offline(float(facts['duration']), Fraction(facts['sample_period']))
    except (KeyError, ValueError, ZeroDivisionError):
        raise RecordingError(f'{run.path}: it does not say whether a node or the tool made it; recorded by another '
                             'version?') from None


def _notes(run: Run, facts: Mapping[str, str]) -> Iterator[str]:
    if facts.get('version') != __version__:
        yield f'recorded by stickslip {facts.get("version")}, this is {__version__}: the numbers may differ'
    if hashlib.sha256(run.attachments[SCENE_FILE]).hexdigest() != facts.get('scene_hash'):
        yield f'{SCENE_FILE} was changed after the recording'
    elif run.scene.hash != facts.get('scene_hash'):
        yield f'{SCENE_FILE} means something else in this version'
    if not run.is_complete:
        yield 'the recording has no end: cut off, or still being written'
    if dropped := run.receipt.get('dropped_messages'):
        yield f'{dropped} messages were dropped while recording'
