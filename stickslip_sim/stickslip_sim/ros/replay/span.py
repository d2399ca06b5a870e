# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What of a recording is played: its topics, and from when to when."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

from ...core.errors import InputError
from ...core.time_grid import NANOSECONDS
from ...recording.reader import Recording
from ...scene.parameter import Parameter

# The parameters of the replay, in the words of `ros2 bag play`, and what they make.

STATES_MODE, COMMANDS_MODE = 'states', 'commands'

REPLAY_PARAMETERS = (
    Parameter('bag', 'string', '', '', 'Folder of the run, or its .mcap file.'),
    Parameter('mode', 'string', STATES_MODE, '', 'states plays every recorded topic; commands sends the recorded'
              ' commands to a live axis.', choices=(STATES_MODE, COMMANDS_MODE)),
    Parameter('rate', 'double', 1.0, '', 'Speed: seconds of the recording per second.', 0.0, 1e6, low_open=True,
              live=True),
    Parameter('loop', 'bool', False, '', 'Start again at the end.'),
    Parameter('start_offset', 'double', 0.0, 's', 'Time to skip at the start of the recording.', 0.0, 1e9),
    Parameter('playback_duration', 'double', -1.0, 's', 'Time of the recording to play; -1: to its end.', -1.0, 1e9),
    Parameter('delay', 'double', 0.0, 's', 'Wait before playing, each time.', 0.0, 1e6),
    Parameter('start_paused', 'bool', False, '', 'Wait for ~/resume at the start.'),
    Parameter('clock', 'double', 0.0, 'Hz', 'Rate of /clock; 0 does not publish it.', 0.0, 1e4),
    Parameter('topics', 'string_array', (), '', 'Topics to play. Default: all.'),
    Parameter('axis', 'string', '', '', 'Node that receives the commands of mode: commands; empty: feed_axis in'
              ' the namespace of the recorded commands.'),
)


@dataclass(frozen=True)
class Settings:
    """The parameters, checked together."""

    bag: str
    mode: str
    rate: float
    loop: bool
    start_offset: float
    playback_duration: float
    delay: float
    start_paused: bool
    clock: float
    topics: tuple[str, ...]
    axis: str

    @classmethod
    def of(cls, values: Mapping[str, object]) -> 'Settings':
        """Return the settings; raises InputError on those that have no meaning together."""
        settings = cls(**{field.name: values[field.name] for field in fields(cls)})  # type: ignore[arg-type]
        if not settings.bag:
            raise InputError('bag', '', 'the folder of a run', 'give it: --ros-args -p bag:=RUN_FOLDER')
        if settings.mode == COMMANDS_MODE and settings.clock:
            raise InputError('clock', settings.clock, '0 with mode: commands', 'the axis has the clock')
        if settings.mode == STATES_MODE and settings.axis:
            raise InputError('axis', settings.axis, 'omitted with mode: states', 'it belongs to mode: commands')
        return settings


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
