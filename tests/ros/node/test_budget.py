# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The budget of a step is measured on the node as it is: each part of it is found, and takes its time."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.ros


def test_each_part_of_a_step_is_found(tmp_path: Path) -> None:
    page = tmp_path / 'loop.md'
    page.write_text('# Before\n\n## The budget of a step\n\nold\n')
    subprocess.run([sys.executable, '-m', 'benchmarks.budget', '--seconds', '1', '--out', str(page)], check=True)
    text = page.read_text()
    assert text.startswith('# Before\n\n## The budget of a step\n\n`python3 -m benchmarks.budget')
    assert 'old' not in text
    rows = re.findall(r'^\| ([^|]+) \| [^|]+ \| ([\d.]+) \| ([\d.]+) \|', text, re.MULTILINE)
    found = {name: float(median) for name, median, _ in rows}
    parts = ('hear', 'take', 'simulate', 'rig events', 'pack', 'publish', 'record', 'statistics')
    assert all(found[part] > 0.0 for part in parts)
    assert sum(found[part] for part in parts) < 2.0 * found['**the whole step**']
