# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Standard outputs that take nothing or not all (full, closed, reset, not read): one line, buffered or not."""

import os
import resource
import socket
import struct
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest


@pytest.mark.parametrize(('arguments', 'unbuffered'), [
    (['scenes'], ''), (['--help'], ''), (['simulate', 'paper_fig7', '--duration', '1'], ''),
    (['simulate', 'paper_fig7', '--duration', '9', '--samples', '-'], ''),
    (['simulate', 'paper_fig7', '--duration', '9', '--samples', '-'], '1'),
    (['extremes', '--only', 'X4', '--quick'], ''),
])
def test_full_standard_output_gets_one_line(arguments: list[str], unbuffered: str) -> None:
    with open('/dev/full', 'w') as full:
        done = subprocess.run([sys.executable, '-m', 'stickslip_sim', *arguments], stdout=full, stderr=subprocess.PIPE,
                              env={**os.environ, 'PYTHONUNBUFFERED': unbuffered}, text=True, timeout=60, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith('stickslip: ')
    assert 'standard output' in done.stderr
    assert 'No space left' in done.stderr
    assert done.stderr.count('\n') == 1


@pytest.mark.parametrize('unbuffered', ['', '1'])
def test_a_table_that_does_not_fit_on_the_disk_is_not_cut_in_silence(tmp_path: Path, unbuffered: str) -> None:
    with open(tmp_path / 'table.csv', 'w') as table:
        done = _into(table, unbuffered, prepare=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
    assert (done.returncode, done.stderr.count('\n')) == (2, 1)
    assert 'standard output cannot be written: File too large' in done.stderr


@pytest.mark.parametrize('unbuffered', ['', '1'])
def test_a_reader_that_breaks_off_or_does_not_read_gets_one_line(unbuffered: str) -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.setblocking(False)    # and nobody reads
        done = _into(theirs, unbuffered)
        assert (done.returncode, done.stderr.count('\n')) == (2, 1)
        assert 'standard output cannot be written' in done.stderr
    with socket.create_server(('127.0.0.1', 0)) as server, socket.create_connection(server.getsockname()) as reset:
        reader, _ = server.accept()
        reader.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        reader.close()
        done = _into(reset, unbuffered)
        assert (done.returncode, done.stderr.count('\n')) == (2, 1)
        assert 'standard output cannot be written' in done.stderr


def _into(out: Any, unbuffered: str, prepare: Callable[[], None] | None = None) -> subprocess.CompletedProcess[str]:
    """Write a long table into `out`, which does not take it."""
    environment = {**os.environ, 'PYTHONUNBUFFERED': unbuffered, 'PYTHONDONTWRITEBYTECODE': '1'}
    return subprocess.run([sys.executable, '-m', 'stickslip_sim', 'simulate', 'paper_fig7', '--duration', '9',
                           '--samples', '-'], stdout=out, stderr=subprocess.PIPE, env=environment, text=True,
                          timeout=60, check=False, preexec_fn=prepare)


def test_closed_standard_output() -> None:
    command = f'{sys.executable} -m stickslip_sim simulate paper_fig7 --duration 1'
    assert subprocess.run(['sh', '-c', f'{command} >&-'], timeout=60, check=False).returncode == 0
    done = subprocess.run(['sh', '-c', f'{command} --events - >&-'], stderr=subprocess.PIPE, text=True, timeout=60,
                          check=False)
    assert (done.returncode, done.stderr.count('\n')) == (2, 1)
    assert 'standard output' in done.stderr
