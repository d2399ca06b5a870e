# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip compare` on what is no run of ours, or only part of one: one clear line, or as far as it goes."""

import struct
from pathlib import Path

import pytest
from mcap.writer import CompressionType, Writer
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as BagWriter
from rosbags.typesys import Stores, get_typestore

from stickslip_sim.cli.main import run
from stickslip_sim.recording import open_bag, read_run
from tests.support import tool
from tests.support.rewritten_bags import rewritten
from tests.support.tool import Capture

pytestmark = pytest.mark.usefixtures('blank_pictures')


def refused(capsys: Capture, tmp_path: Path, *arguments: str | Path) -> str:
    """Compare; return the one line that is said on standard error.  Nothing is left behind."""
    err = tool.refused(capsys, 'compare', *arguments, '--out', tmp_path / 'out')
    assert not [path for path in tmp_path.iterdir() if 'out' in path.name]
    return err


@pytest.mark.parametrize('storage', list(StoragePlugin))
def test_a_bag_of_something_else(storage: StoragePlugin, tmp_path: Path, capsys: Capture) -> None:
    store = get_typestore(Stores.ROS2_JAZZY)
    with BagWriter(tmp_path / 'foreign', version=9, storage_plugin=storage) as writer:
        text = store.types['std_msgs/msg/String']
        connection = writer.add_connection('/chatter', 'std_msgs/msg/String', typestore=store)
        writer.write(connection, 0, store.serialize_cdr(text('hello'), 'std_msgs/msg/String'))
    line = refused(capsys, tmp_path, tmp_path / 'foreign')
    if storage == StoragePlugin.MCAP:
        assert 'no topic of type stickslip_msgs/msg/SliderState' in line
        assert '/chatter' in line
    else:
        assert 'foreign.db3 is not read' in line


def test_an_mcap_file_of_another_kind(tmp_path: Path, capsys: Capture) -> None:
    """With a binary schema, and a channel without any."""
    with (tmp_path / 'robot.mcap').open('wb') as out:
        writer = Writer(out)
        writer.start()
        schema = writer.register_schema('robot.Pose', 'protobuf', b'\xff\x00\xfe')
        for topic, number in (('/pose', schema), ('/raw', 0)):
            writer.add_message(writer.register_channel(topic, 'protobuf', number), 0, b'\x00', 0)
        writer.finish()  # type: ignore[no-untyped-call]
    assert 'no topic of type stickslip_msgs/msg/SliderState' in refused(capsys, tmp_path, tmp_path / 'robot.mcap')


def test_two_axes(fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
    names = {'/slider_state': '/left/slider_state', '/friction_force': '/right/friction_force'}
    both = rewritten(fig8_bag, tmp_path / 'both', lambda name: names.get(name, name))
    assert len(read_run(both).cycles()) > 0    # in any one namespace, but not in two of the same kind
    with (tmp_path / 'two.mcap').open('wb') as out:
        writer = Writer(out)
        writer.start()
        for name in ('/left/slider_state', '/right/slider_state'):
            schema = writer.register_schema('stickslip_msgs/msg/SliderState', 'ros2msg', b'float64 time')
            writer.add_message(writer.register_channel(name, 'cdr', schema), 0, b'\0\1\0\0' + bytes(8), 0)
        writer.finish()  # type: ignore[no-untyped-call]
    assert '/left/slider_state and /right/slider_state' in refused(capsys, tmp_path, tmp_path / 'two.mcap')


def test_messages_of_another_version(fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
    rewritten(fig8_bag, tmp_path / 'old', definition=lambda text: text.replace('float64 drive_force', 'float64 spring'))
    line = refused(capsys, tmp_path, tmp_path / 'old')
    assert '/slider_state has no drive_force' in line
    assert 'recorded by another version?' in line


def test_a_cut_file_is_used_as_far_as_it_goes(fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
    data = next(fig8_bag.glob('*.mcap')).read_bytes()
    (tmp_path / 'cut.mcap').write_bytes(data[:len(data) * 2 // 3])
    assert run(['compare', str(tmp_path / 'cut.mcap'), '--out', str(tmp_path / 'out')]) == 0
    assert 'has no end: cut off' in capsys.readouterr().out
    assert 'has no end: cut off' in (tmp_path / 'out' / 'report.html').read_text()
    (tmp_path / 'stump.mcap').write_bytes(data[:9000])
    assert 'cut off before the first' in refused(capsys, tmp_path / 'out', tmp_path / 'stump.mcap')


@pytest.mark.parametrize('compression', [CompressionType.LZ4, CompressionType.NONE])
def test_other_compressions(compression: CompressionType, fig8_bag: Path, tmp_path: Path) -> None:
    other = rewritten(fig8_bag, tmp_path / 'other', compression=compression)
    assert open_bag(other).counts['/slider_state'] == open_bag(fig8_bag).counts['/slider_state']


def test_unreadable_compressions(fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
    data = next(fig8_bag.glob('*.mcap')).read_bytes()
    name = struct.pack('<I', 4) + b'zstd'
    (tmp_path / 'odd.mcap').write_bytes(data.replace(name, struct.pack('<I', 4) + b'lzma'))
    assert "compressed with 'lzma'" in refused(capsys, tmp_path, tmp_path / 'odd.mcap')
    (tmp_path / 'packed').mkdir()
    (tmp_path / 'packed' / 'run_0.mcap.zstd').write_bytes(b'')
    assert 'run_0.mcap.zstd is not read' in refused(capsys, tmp_path, tmp_path / 'packed')


@pytest.mark.parametrize('option', [['--duration', '1'], ['--set', 'axis.mass=1.0']])
def test_options_for_scenes_alone(option: list[str], fig8_bag: Path, tmp_path: Path, capsys: Capture) -> None:
    assert 'applies to scenes' in refused(capsys, tmp_path, fig8_bag, *option)


def test_a_failure_leaves_nothing(tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also half-way, when the pictures are drawn and the disk is full."""
    def full(*_: object) -> str:
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr('stickslip_sim.compare.report.page', full)
    assert 'No space left on device' in refused(capsys, tmp_path, 'paper_fig7', '--duration', '1')
    assert list(tmp_path.iterdir()) == []
