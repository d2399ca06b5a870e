# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The memory that can be had within limits of containers, on files laid out as Linux shows them."""

from pathlib import Path

import pytest

from stickslip_sim.study.free_memory import free_memory

MACHINE = {'proc/meminfo': 'MemTotal: 9000 kB\nMemAvailable:    8000 kB\n'}


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    return laid_out(tmp_path, MACHINE)


def laid_out(root: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


def first(folder: str, limit: object, usage: int, cached: int) -> dict[str, str]:
    """Return the files of a group of version 1."""
    folder = f'sys/fs/cgroup/memory{folder}'
    return {f'{folder}/memory.limit_in_bytes': f'{limit}\n', f'{folder}/memory.usage_in_bytes': f'{usage}\n',
            f'{folder}/memory.stat': f'cache 7\ninactive_file 1\ntotal_inactive_file {cached}\n'}


def second(folder: str, limit: object, usage: int, cached: int) -> dict[str, str]:
    """Return the files of a group of version 2."""
    folder = f'sys/fs/cgroup{folder}'
    return {f'{folder}/memory.max': f'{limit}\n', f'{folder}/memory.current': f'{usage}\n',
            f'{folder}/memory.stat': f'anon 7\ninactive_file {cached}\n'}


def test_of_this_machine() -> None:
    assert 0 < free_memory() < 1 << 50


def test_without_groups(machine: Path) -> None:
    assert free_memory(machine) == 8_192_000


@pytest.mark.parametrize(('group', 'files', 'free'), [
    ('0::/\n', second('', 1_000_000, 400_000, 50_000), 650_000),
    ('0::/\n', second('', 1_000_000, 1_400_000, 0), 0),
    ('0::/\n', second('', 1 << 40, 0, 0), 8_192_000),
    ('0::/a/b\n', second('/a/b', 'max', 10, 0) | second('/a', 1_000_000, 10, 0), 999_990),
    ('0::/a/b\n', second('/a/b', 500_000, 10, 0) | second('/a', 1_000_000, 10, 0), 499_990),
    ('9:name=systemd:/\n4:memory:/a\n0::/\n', first('/a', 1_000_000, 10, 4), 999_994),
    ('4:cpu,memory:/docker/4f1c\n', first('', 1_000_000, 10, 0), 999_990),     # seen from within the container
    ('4:memory:/a\n', first('/a', 9223372036854771712, 10, 0), 8_192_000),     # none
], ids=['container', 'overdrawn', 'wide', 'above', 'own', 'v1', 'v1 container', 'v1 none'])
def test_in_a_group(machine: Path, group: str, files: dict[str, str], free: int) -> None:
    laid_out(machine, {'proc/self/cgroup': group, **files})
    assert free_memory(machine) == free
