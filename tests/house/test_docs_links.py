# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The pages: what finds links that lead nowhere, and the site that is made of the pages.  No network."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from dev.links import broken, links, main, missing
from tests.support.repository import ROOT
from tests.support.tool import Capture

PAGES = sorted([*ROOT.glob('*.md'), *(ROOT / 'docs').glob('*.md')])


def test_nothing_leads_nowhere(capsys: Capture) -> None:
    """As `make check` looks."""
    assert main() == 0, capsys.readouterr().err


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_fences_stand_at_the_left(page: Path) -> None:
    """Python-Markdown, which makes the site, takes none within a list for one."""
    assert re.findall(r'^ +```.*$', page.read_text(encoding='utf-8'), re.MULTILINE) == []


def test_what_is_broken_is_found() -> None:
    text = ('[a](nowhere.md) [b](docs/model.md#nowhere) [c](#nowhere) ![d](docs/images/nowhere.png)'
            ' [good](docs/security.md#sros-2) [good](#stickslip) [good](https://example.org/x) `[code](nowhere)`')
    assert broken(ROOT / 'README.md', text) == ['nowhere.md', 'docs/model.md#nowhere', '#nowhere',
                                                'docs/images/nowhere.png']


def test_paths_are_looked_for_at_the_top_and_in_the_package() -> None:
    text = ('docs/model.md, `launch/sim.launch.py`, stickslip_sim/core/errors.py, tests/test_*.py, tests/nowhere.py,'
            ' https://example.org/docs/nowhere.md and my_docs/nowhere.md, but docs/nowhere.md.')
    assert missing(text) == ['docs/nowhere.md', 'tests/nowhere.py']


def test_every_page_of_the_docs_is_on_their_front_page() -> None:
    front = (ROOT / 'docs/index.md').read_text(encoding='utf-8')
    assert {page.name for page in (ROOT / 'docs').glob('*.md')} - {'index.md'} == {
        link for link in links(front) if link.endswith('.md')}


def test_the_site_is_made_without_a_warning(tmp_path: Path) -> None:
    """As `make docs` does it.  (mkdocs --quiet would not even count its warnings.)"""
    done = subprocess.run([sys.executable, '-m', 'mkdocs', 'build', '--site-dir', tmp_path], cwd=ROOT, timeout=60,
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert 'WARNING' not in done.stderr
    assert (tmp_path / 'index.html').is_file()
