# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Completion in a real bash: verbs, options, scenes and parameters, by the line that docs/tool.md has."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.repository import ROOT

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
