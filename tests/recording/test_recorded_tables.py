# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""States and transitions read back from runs: of any namespace, and refused when another version wrote them."""

from pathlib import Path
from typing import Any

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer

from stickslip_sim.core.errors import RecordingError
from stickslip_sim.core.types import EventKind, Mode
from stickslip_sim.recording import (
    RECORDED,
    BagWriter,
    open_bag,
    recorded_topics,
    schema,
)
from stickslip_sim.recording.messages import Packer
from stickslip_sim.recording.schemas import store_of
from stickslip_sim.recording.topics import MODE_EVENT, SLIDER_STATE
from tests.support.recorded_runs import events


def with_events(folder: Path, namespace: str, **changes: Any) -> Path:
    """Write the transitions of the made-up run, with other fields."""
    packer = Packer(MODE_EVENT)
    writer = BagWriter(folder, recorded_topics(namespace), {}, {})
    for event in events():
        writer.write(RECORDED.index(MODE_EVENT), packer.pack(0, 1, event._replace(**changes)), 0, 0, 1)
    writer.close()
    return folder


def test_transitions_come_back_as_they_were(tmp_path: Path) -> None:
    found = open_bag(with_events(tmp_path / 'run', '/cell/press')).events
    for event, expected in zip(found, events(), strict=True):
        assert event.kind is expected.kind
        for name in set(event._fields) - {'drive_position'}:
            assert getattr(event, name) == getattr(expected, name), name


@pytest.mark.parametrize('changes', [{'kind': len(EventKind)}, {'mode': len(Mode)}])
def test_transitions_of_unknown_kinds(changes: dict[str, int], tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match='unknown kinds; recorded by another version'):
        _ = open_bag(with_events(tmp_path / 'run', '/', **changes)).events


def test_messages_of_another_version(tmp_path: Path) -> None:
    text = schema(SLIDER_STATE.type).text.replace('float64 drive_position', 'float64 spindle_position')
    with Writer(tmp_path / 'old', version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        writer.add_connection('/slider_state', SLIDER_STATE.type, typestore=store_of({SLIDER_STATE.type: text}))
    run = open_bag(tmp_path / 'old')
    assert run.columns_of(SLIDER_STATE, ['time'])['time'].size == 0
    with pytest.raises(RecordingError, match='/slider_state has no drive_position; recorded by another version'):
        run.columns_of(SLIDER_STATE, ['time', 'drive_position'])
