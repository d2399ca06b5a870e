# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Standard outputs that take nothing or not all (full, closed, reset, not read): one line, buffered or not."""

import os
import resource
import shutil
import socket
import struct
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.support.repository import ROOT
from tests.support.tool import Capture, refused


@pytest.mark.parametrize(('arguments', 'unbuffered'), [
    (['--help'], ''), (['simulate', 'paper_fig7', '--duration', '1'], ''),
    (['simulate', 'paper_fig7', '--duration', '9', '--samples', '-'], '1'),
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


def test_a_table_that_does_not_fit_on_the_disk_is_not_cut_in_silence(tmp_path: Path) -> None:
    with open(tmp_path / 'table.csv', 'w') as table:
        done = _into(table, prepare=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
    assert (done.returncode, done.stderr.count('\n')) == (2, 1)
    assert 'standard output cannot be written: File too large' in done.stderr


def test_a_reader_that_breaks_off_or_does_not_read_gets_one_line() -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.setblocking(False)    # and nobody reads
        done = _into(theirs)
        assert (done.returncode, done.stderr.count('\n')) == (2, 1)
        assert 'standard output cannot be written' in done.stderr
    with socket.create_server(('127.0.0.1', 0)) as server, socket.create_connection(server.getsockname()) as reset:
        reader, _ = server.accept()
        reader.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack('ii', 1, 0))
        reader.close()
        done = _into(reset)
        assert (done.returncode, done.stderr.count('\n')) == (2, 1)
        assert 'standard output cannot be written' in done.stderr


def _into(out: Any, prepare: Callable[[], None] | None = None) -> subprocess.CompletedProcess[str]:
    """Write a long table into `out`, which does not take it."""
    environment = {**os.environ, 'PYTHONUNBUFFERED': '', 'PYTHONDONTWRITEBYTECODE': '1'}
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


# Completion in a real bash: verbs, options, scenes and parameters, by the line that docs/tool.md has.

BASH = """
{line}
words() {{ COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=(); _stickslip_completion stickslip
           echo "${{COMPREPLY[@]}}"; }}
words stickslip sc
words stickslip simulate paper_fig4
words stickslip simulate paper_fig8 --dur
words stickslip critical paper_fig8 --of axis.drive_
"""


@pytest.mark.skipif(shutil.which('bash') is None, reason='there is no bash')
def test_bash_completes_what_the_page_says(tmp_path: Path) -> None:
    page = (ROOT / 'docs' / 'tool.md').read_text(encoding='utf-8')
    (line,) = (line.partition('#')[0].strip() for line in page.splitlines() if '_COMPLETE=bash_source' in line)
    program = tmp_path / 'stickslip'
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -m stickslip_sim "$@"\n')
    program.chmod(0o755)
    done = subprocess.run(['bash', '-c', f'PATH={tmp_path}:$PATH\n{BASH.format(line=line)}'], capture_output=True,
                          text=True, timeout=60, check=True)
    assert done.stdout.splitlines() == ['scenes', 'paper_fig4_constant paper_fig4_falling', '--duration',
                                        'axis.drive_stiffness axis.drive_damping']


@pytest.mark.parametrize('content', [b'', b'\x89MCAP0\r\n', b'hello'])
def test_a_message_does_not_end_in_a_bare_colon(content: bytes, tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / 'bad.mcap').write_bytes(content)
    line = refused(capsys, 'verify', tmp_path / 'bad.mcap').strip()
    assert 'is not an MCAP file' in line
    assert not line.endswith(':')
