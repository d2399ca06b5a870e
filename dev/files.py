# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The files of the repository."""

import subprocess
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]


def files(*patterns: str) -> Iterator[Path]:
    """Yield the files that git's patterns match, also those that are not yet committed."""
    listed = subprocess.run(['git', 'ls-files', '-z', '--cached', '--others', '--exclude-standard', '--', *patterns],
                            cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return (ROOT / name for name in sorted({*listed.split('\0')} - {''}) if (ROOT / name).is_file())
