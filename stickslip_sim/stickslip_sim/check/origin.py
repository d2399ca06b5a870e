# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Where a recorded run came from: what it began with, and what is doubtful about it."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from fractions import Fraction
from typing import Any, NamedTuple

from ..bags.bag import METADATA
from ..core.errors import RecordingError, one_line
from ..core.version import __version__
from ..recording import MeasuredRun, RecordedRun
from ..recording.run import CHECKPOINT_FILE, SCENE_FILE, RunFacts, checkpoint_file

_MAKERS = 'version', 'python', 'platform', 'numpy', 'hot_path'


class Offline(NamedTuple):
    """How long an offline run was, and how often it was sampled."""

    duration: float            # s
    sample_period: Fraction    # s


def doubts_about(run: RecordedRun) -> tuple[str, ...]:
    """Return what is doubtful about a run, for people; raises RecordingError when it cannot be run again."""
    bag = run.bag
    if isinstance(run, MeasuredRun):
        raise RecordingError(f'{bag.path}: it was measured; only what was simulated can be verified')
    if not bag.is_complete and not bag.topics:
        raise RecordingError(f'{bag.path}: cut off before its first message was written')
    facts = _facts_of(run)
    if part := facts.get('part'):
        raise RecordingError(f'{bag.path}: part {part} of a recording that was split, which begins with another file; '
                             'give the folder of the whole bag')
    _ = run.scene, checkpoint_of(run), offline_of(run)
    return tuple(map(one_line, _doubts(run, facts)))


def checkpoint_of(run: RecordedRun) -> Mapping[str, Any] | None:
    """Return the checkpoint that a run began from; None when it began at the start of its scene."""
    return run.bag.values(CHECKPOINT_FILE) if CHECKPOINT_FILE in run.bag.attachments else None


def begins_in_mid_run(run: RecordedRun) -> bool:
    """Return whether a run began elsewhere than its scene does: not so after a reset, while time stands still at 0."""
    checkpoint = checkpoint_of(run)
    if checkpoint is None:
        return False
    rig = run.scene.make_rig()
    rig.make_step()
    return bool(json.loads(checkpoint_file(rig.checkpoint())[CHECKPOINT_FILE]) != checkpoint)


def offline_of(run: RecordedRun) -> Offline | None:
    """Return how an offline run was carried out; None for a node's.  Raises RecordingError when it does not say."""
    facts = _facts_of(run)
    if facts.get('origin') == 'node':
        return None
    try:
        return Offline(float(facts['duration']), Fraction(facts['sample_period']))
    except (KeyError, ValueError, ZeroDivisionError):
        raise RecordingError(f'{run.bag.path}: it does not say whether a node or the tool made it; recorded by another '
                             'version?') from None


def made_with(run: RecordedRun) -> str:
    """Return what of the recording's versions and machine is not as here, and what is here instead; for people."""
    recorded, here = _facts_of(run), RunFacts.of(run.scene).as_metadata()
    others = [f'{name} {recorded[name]} (here {here[name]})' for name in _MAKERS
              if recorded.get(name, here[name]) != here[name]]
    return one_line(', '.join(others)) or 'the same versions on the same kind of machine'


def _facts_of(run: RecordedRun) -> Mapping[str, str]:
    if METADATA not in run.bag.metadata:
        raise RecordingError(f'{run.bag.path}: it does not say what it was simulated with; give a run that stickslip '
                             'recorded')
    return run.bag.metadata[METADATA]


def _doubts(run: RecordedRun, facts: Mapping[str, str]) -> Iterator[str]:
    if facts.get('version') != __version__:
        yield f'recorded by stickslip {facts.get("version")}, this is {__version__}: the numbers may differ'
    if hashlib.sha256(run.bag.attachments[SCENE_FILE]).hexdigest() != facts.get('scene_hash'):
        yield f'{SCENE_FILE} was changed after the recording'
    elif run.scene.hash != facts.get('scene_hash'):
        yield f'{SCENE_FILE} means something else in this version'
    if run.bag.next_file:
        yield f'the recording {run.bag.continuation}'
    elif not run.is_complete:
        yield 'the recording has no end: cut off, or still being written'
    if dropped := run.receipt.get('dropped_messages'):
        yield f'{dropped} messages were dropped while recording'
