# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What of a recording is played: its topics, and from when to when."""

from collections.abc import Sequence
from typing import NamedTuple

from ...core.errors import InputError
from ...core.time_grid import NANOSECONDS
from ...recording.playback import Recording
from .replay_settings import Settings


class PlayedSpan(NamedTuple):
    """Log times, ns; both belong to it."""

    begin: int
    end: int


def span_of(recording: Recording, settings: Settings) -> PlayedSpan:
    """Return the span that the settings ask for; raises InputError when there is nothing in it."""
    begin = recording.begin + round(settings.start_offset * NANOSECONDS)
    if begin > recording.end:
        raise InputError('start_offset', settings.start_offset,
                         f'at most {recording.length:g} s, the length of the recording', 'begin earlier')
    if settings.playback_duration < 0.0:
        return PlayedSpan(begin, recording.end)
    return PlayedSpan(begin, min(recording.end, begin + round(settings.playback_duration * NANOSECONDS)))


def chosen_topics(recording: Recording, wanted: Sequence[str]) -> list[str]:
    """Return the topics that are wanted, all when none is named; raises InputError on one that is not there.

    A name without a leading slash is that of the one topic that ends so.
    """
    return [_topic(recording, name) for name in wanted] or list(recording.topics)


def _topic(recording: Recording, wanted: str) -> str:
    found = [name for name in recording.topics if name == wanted or name.endswith(f'/{wanted}')]
    if len(found) != 1:
        raise InputError('topics', wanted, f'in the recording: {", ".join(recording.topics)}', 'give one of them')
    return found[0]
