# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`python3 -m dev.pages` writes the files that are made from code and from other files; a test compares them."""

from collections.abc import Callable, Mapping
from functools import partial

from benchmarks import measured

from . import api, changelog, scene_page
from .files import ROOT

MADE: Mapping[str, Callable[[], str]] = {
    'docs/api.md': api.page,
    'docs/scene.md': scene_page.page,
    'docs/measured.md': measured.page,
    'docs/tool.md': api.tool_page,
    **{f'{package}/CHANGELOG.rst': partial(changelog.changelog, package) for package in changelog.PACKAGES},
}


def main() -> None:
    """Write the files."""
    for name, text in MADE.items():
        (ROOT / name).write_text(text(), encoding='utf-8')


if __name__ == '__main__':
    main()
