# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Bags with something wrong: a recorded run, written anew with a change."""

from collections.abc import Callable
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from stickslip_sim.bags.bag import METADATA

Rename = Callable[[str], str | None]
Replace = Callable[[str, int, bytes], bytes | None]   # topic, sequence and data of a message


def rewritten(source: Path, target: Path, topic: Rename = lambda name: name, definition: Rename = lambda text: text,
              attachment: Rename = lambda name: name, compression: CompressionType = CompressionType.ZSTD,
              since: float = 0.0, message: Replace = lambda topic, sequence, data: data,
            contents: Callable[[str, bytes], bytes] = lambda name, data: data,
            metadata: Callable[[dict[str, str]], dict[str, str]] = lambda facts: facts) -> Path:
    """Copy the bag in the folder `source`, from a time (s) on; what becomes None is left out."""
    target.mkdir()
    with next(source.glob('*.mcap')).open('rb') as stream, (target / 'run_0.mcap').open('wb') as out:
        reader, writer = make_reader(stream), Writer(out, chunk_size=64 * 1024, compression=compression)
        writer.start(profile='ros2', library='test')
        for item in reader.iter_attachments():
            if (name := attachment(item.name)) is not None:
                writer.add_attachment(item.create_time, item.log_time, name, item.media_type,
                                      contents(item.name, item.data))
        for record in reader.iter_metadata():
            writer.add_metadata(record.name, metadata(record.metadata) if record.name == METADATA else record.metadata)
        channels: dict[int, int] = {}
        schemas: dict[int, int] = {}
        for schema, channel, found in reader.iter_messages():
            if (name := topic(channel.topic)) is None or schema is None or found.log_time < since * 1e9:
                continue
            if schema.id not in schemas:
                text = definition(schema.data.decode()) or ''
                schemas[schema.id] = writer.register_schema(schema.name, schema.encoding, text.encode())
            if channel.id not in channels:
                channels[channel.id] = writer.register_channel(name, 'cdr', schemas[schema.id], channel.metadata)
            if (data := message(channel.topic, found.sequence, found.data)) is not None:
                writer.add_message(channels[channel.id], found.log_time, data, found.publish_time, found.sequence)
        writer.finish()  # type: ignore[no-untyped-call]
    return target
