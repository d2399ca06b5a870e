# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Opens bags, also those of a process that was killed or of a disk that was full, and takes in what they hold."""

import re
import warnings
from pathlib import Path

import numpy as np
from mcap.records import Attachment, Channel, Footer, McapRecord, Metadata, Schema

from ..bags.bag import METADATA, NEXT_FILE
from ..bags.mcap_chunk import Messages
from ..bags.mcap_records import contents
from ..core.errors import RecordingError, RecordingWarning
from .measured_run import MEASURED, MeasuredRun
from .reader import OVERHEAD, Bag
from .recorded_run import RecordedRun

MOST_BESIDE = 64 << 20   # bytes of all that a file holds beside messages
_PART = re.compile(r'(?P<name>.*)_(?P<number>0|[1-9]\d{0,8})\.mcap')


def open_bag(path: Path | str) -> Bag:
    """Return the bag in a folder, or in an MCAP file by itself; raises RecordingError when there is none, or damaged.

    One without an end (its process was killed, its disk was full, or it is still being written) is read as far as it
    goes, with a RecordingWarning.
    """
    bag = bag_in(path)
    for shortfall in bag.shortfalls:
        warnings.warn(shortfall, RecordingWarning, stacklevel=2)
    return bag


def bag_in(path: Path | str) -> Bag:
    """Return what `open_bag` does, without a warning."""
    files = files_of(Path(path))
    bag = Bag(files[0] if len(files) == 1 else Path(path), files)
    ends = [_take(bag, file) for file in files]
    next_file = ends[-1] or ''
    bag.is_complete = None not in ends and not next_file
    bag.next_file = '' if goes_on_empty(files[-1]) else next_file
    return bag


def _take(bag: Bag, file: Path) -> str | None:
    """Take what a file says of the bag; return in which file the bag goes on, None when this one has no end."""
    names: dict[int, str] = {}
    channels: dict[int, str] = {}
    next_file: str | None = None
    beside = 0
    for record in contents(file):
        if isinstance(record, Messages):
            _count(bag, file, record, channels)
            continue
        beside += _size(record)
        if beside > MOST_BESIDE:
            raise RecordingError(f'{file}: more than {MOST_BESIDE >> 20} MiB beside its messages; no run has that')
        _note(bag, record, names, channels)
        if isinstance(record, Footer):
            next_file = bag.metadata.pop(NEXT_FILE, {}).get('file', '')
    bag.channels.update(channels.items())
    return next_file


def _count(bag: Bag, file: Path, messages: Messages, channels: dict[int, str]) -> None:
    for channel, count in enumerate(np.bincount(messages.channels).tolist()):
        if count and channel not in channels:
            raise RecordingError(f'{file}: damaged: a message on channel {channel}, which is nowhere')
        if count:
            bag.counts[channels[channel]] += count


def _note(bag: Bag, record: McapRecord, names: dict[int, str], channels: dict[int, str]) -> None:
    """Take what a record says of the bag; `names` of schemas and topics of `channels` by their numbers in its file."""
    if isinstance(record, Schema) and record.id not in names:    # the index repeats them
        names[record.id] = record.name
        if record.encoding == 'ros2msg':
            bag.schemas[record.name] = record.data.decode(errors='replace')
    elif isinstance(record, Channel) and record.id not in channels:
        channels[record.id] = record.topic
        bag.topics[record.topic] = names.get(record.schema_id, '')    # other programs may give none
        bag.channel_metadata[record.topic] = record.metadata
        bag.counts.setdefault(record.topic, 0)
    elif isinstance(record, Attachment):
        bag.attachments[record.name] = record.data
    elif isinstance(record, Metadata) and not (record.name == METADATA and METADATA in bag.metadata):
        bag.metadata[record.name] = record.metadata


def _size(record: McapRecord) -> int:
    """Return about how many bytes of a record are kept."""
    if isinstance(record, (Attachment, Schema)):
        return len(record.name) + len(record.data)
    if isinstance(record, (Channel, Metadata)):
        return sum(len(key) + len(value) for key, value in record.metadata.items()) + OVERHEAD
    return 0


def files_of(path: Path) -> list[Path]:
    """Return the MCAP files of a bag in their order, given by its folder, or one of them by itself.

    Raises RecordingError when there is none, or one in between is missing, or they are not of one bag.
    """
    files = sorted(path.glob('*.mcap')) if path.is_dir() else [path]
    for foreign in [*path.glob('*.mcap.*'), *path.glob('*.db3*')] if not files else []:
        raise RecordingError(f'{path}: {foreign.name} is not read, only .mcap is; decompress or convert it first '
                             '(zstd -d, ros2 bag convert)')
    if not files or not files[0].is_file():
        raise RecordingError(f'{path}: no recorded run there; give the folder of a run or an .mcap file')
    return files if len(files) == 1 else _parts(path, files)


def _parts(path: Path, files: list[Path]) -> list[Path]:
    """Return the files of a bag that was split in the order of their numbers; raises RecordingError.

    The last one may be empty: its process was killed as it began the file, or is just about to write.  It is left out.
    """
    found = [_PART.fullmatch(file.name) for file in files]
    numbered = {int(match['number']): file for match, file in zip(found, files) if match}
    if len(numbered) < len(files) or len({match['name'] for match in found if match}) > 1:
        raise RecordingError(f'{path}: {len(files)} .mcap files; give the one to read')
    first, last = min(numbered), max(numbered)
    for number in range(first, last):
        if number not in numbered:
            name = numbered[first].name.rpartition('_')[0]
            raise RecordingError(f'{path}: {name}_{number}.mcap is missing; give a part of the bag by itself')
    parts = [numbered[number] for number in range(first, last + 1)]
    return parts[:-1] if goes_on_empty(parts[-2]) else parts


def goes_on_empty(part: Path) -> bool:
    """Return whether the next part of a bag is there, and empty."""
    match = _PART.fullmatch(part.name)
    behind = part.with_name(f'{match["name"]}_{int(match["number"]) + 1}.mcap') if match else part
    return behind.is_file() and behind.stat().st_size == 0


# Reads any run folder: of a simulation, or of a measurement.

def read_run(path: Path | str) -> RecordedRun:
    """Return the run in a folder, or in an MCAP file by itself; raises RecordingError when there is none, or damaged.

    A run without an end (its process was killed, its disk was full, or it is still being written) is read as far as it
    goes, with a RecordingWarning; its `notes` say so too.  One that was measured is a MeasuredRun.
    """
    bag = bag_in(path)
    is_measured = bag.metadata.get(METADATA, {}).get('origin') == MEASURED
    run = MeasuredRun(bag, path) if is_measured else RecordedRun(bag, path)
    for note in bag.shortfalls:
        warnings.warn(note, RecordingWarning, stacklevel=2)
    return run
