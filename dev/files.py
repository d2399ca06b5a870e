# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The files of the repository, as git lists them, and those that are not yet committed."""

import subprocess
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
_NO_TEXT = {'.png', '.svg'}


def texts(*patterns: str) -> Iterator[Path]:
    """Yield the text files that git's patterns match, all of them by default."""
    return (path for path in files(*patterns) if path.suffix not in _NO_TEXT)


def files(*patterns: str) -> Iterator[Path]:
    """Yield the files that git's patterns match, all of them by default."""
    listed = subprocess.run(['git', 'ls-files', '-z', '--cached', '--others', '--exclude-standard', '--', *patterns],
                            cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in sorted(filter(None, listed.split('\0'))):
        path = ROOT / name
        if path.is_file():
            yield path
