# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Opens bags, also those of a process that was killed or of a disk that was full, and takes in what they hold."""

import warnings
from pathlib import Path

import numpy as np
from mcap.records import Attachment, Channel, Footer, McapRecord, Metadata, Schema

from ..core.errors import RecordingError, RecordingWarning
from .message_places import Messages
from .reader import OVERHEAD, Bag
from .records import contents

MOST_BESIDE = 64 << 20   # bytes of all that a file holds beside messages


def open_bag(path: Path | str) -> Bag:
    """Return the bag in a folder, or in an MCAP file by itself; raises RecordingError when there is none, or damaged.

    One without an end (its process was killed, its disk was full, or it is still being written) is read as far as it
    goes, with a RecordingWarning.
    """
    bag = bag_in(path)
    for shortfall in shortfalls(bag):
        warnings.warn(shortfall, RecordingWarning, stacklevel=2)
    return bag


def bag_in(path: Path | str) -> Bag:
    """Return what `open_bag` does, without a warning."""
    bag = Bag(file_of(Path(path)))
    names: dict[int, str] = {}
    beside = 0
    for record in contents(bag.path):
        if isinstance(record, Messages):
            _count(bag, record)
            continue
        beside += _size(record)
        if beside > MOST_BESIDE:
            raise RecordingError(f'{bag.path}: more than {MOST_BESIDE >> 20} MiB beside its messages; no run has that')
        _note(bag, record, names)
    return bag


def _count(bag: Bag, messages: Messages) -> None:
    for channel, count in enumerate(np.bincount(messages.channels).tolist()):
        if count and channel not in bag.channels:
            raise RecordingError(f'{bag.path}: damaged: a message on channel {channel}, which is nowhere')
        if count:
            bag.counts[bag.channels[channel]] += count


def shortfalls(bag: Bag) -> tuple[str, ...]:
    """Return what is missing of a bag, for people."""
    if bag.is_complete:
        return ()
    return (f'{bag.path} has no end: cut off, or still being written; {sum(bag.counts.values())} messages are'
            ' whole, and metadata.yaml does not count them',)


def _note(bag: Bag, record: McapRecord, names: dict[int, str]) -> None:
    """Take what a record says of the bag; `names` of schemas by their numbers."""
    if isinstance(record, Schema) and record.id not in names:    # the index repeats them
        names[record.id] = record.name
        if record.encoding == 'ros2msg':
            bag.schemas[record.name] = record.data.decode(errors='replace')
    elif isinstance(record, Channel) and record.id not in bag.channels:
        bag.channels[record.id] = record.topic
        bag.topics[record.topic] = names.get(record.schema_id, '')    # other programs may give none
        bag.channel_metadata[record.topic] = record.metadata
        bag.counts.setdefault(record.topic, 0)
    elif isinstance(record, Attachment):
        bag.attachments[record.name] = record.data
    elif isinstance(record, Metadata):
        bag.metadata[record.name] = record.metadata
    elif isinstance(record, Footer):
        bag.is_complete = True


def _size(record: McapRecord) -> int:
    """Return about how many bytes of a record are kept."""
    if isinstance(record, (Attachment, Schema)):
        return len(record.name) + len(record.data)
    if isinstance(record, (Channel, Metadata)):
        return sum(len(key) + len(value) for key, value in record.metadata.items()) + OVERHEAD
    return 0


def file_of(path: Path) -> Path:
    """Return the MCAP file of a bag, given by its folder or by itself; raises RecordingError when there is no one."""
    files = sorted(path.glob('*.mcap')) if path.is_dir() else [path]
    for foreign in [*path.glob('*.mcap.*'), *path.glob('*.db3*')] if not files else []:
        raise RecordingError(f'{path}: {foreign.name} is not read, only .mcap is; decompress or convert it first '
                             '(zstd -d, ros2 bag convert)')
    if not files or not files[0].is_file():
        raise RecordingError(f'{path}: no recorded run there; give the folder of a run or an .mcap file')
    if len(files) > 1:
        raise RecordingError(f'{path}: {len(files)} .mcap files; give the one to read')
    return files[0]
