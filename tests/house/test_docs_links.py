# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The pages: every file, folder and heading that one points to is there, and the site is made of them.  No network."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.repository import ROOT

PAGES = sorted([*ROOT.glob('*.md'), *(ROOT / 'docs').glob('*.md')])
_CODE = re.compile(r'^```.*?^```|`[^`\n]*`', re.MULTILINE | re.DOTALL)
_LINK = re.compile(r'!?\[[^\]]*\]\(([^)\s]+)\)')
_HEADING = re.compile(r'^#+ +(.*)$', re.MULTILINE)


def anchors(page: Path) -> set[str]:
    """Return the headings of a page as GitHub and MkDocs name them."""
    text = re.sub(r'^```.*?^```', '', page.read_text(encoding='utf-8'), flags=re.MULTILINE | re.DOTALL)
    return {re.sub(r'[^\w\- ]', '', heading.lower()).strip().replace(' ', '-') for heading in _HEADING.findall(text)}


def broken(page: Path, text: str) -> list[str]:
    """Return the links in the text of a page that lead nowhere."""
    found = []
    for link in _LINK.findall(_CODE.sub('', text)):
        if re.match(r'[a-z]+:', link):    # elsewhere
            continue
        place, _, anchor = link.partition('#')
        target = page.parent / place if place else page
        if not target.exists() or (anchor and anchor not in anchors(target)):
            found.append(link)
    return found


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_links(page: Path) -> None:
    assert broken(page, page.read_text(encoding='utf-8')) == []


@pytest.mark.parametrize('page', PAGES, ids=lambda page: page.name)
def test_fences_stand_at_the_left(page: Path) -> None:
    """Python-Markdown, which makes the site, takes none within a list for one."""
    assert re.findall(r'^ +```.*$', page.read_text(encoding='utf-8'), re.MULTILINE) == []


def test_what_is_broken_is_found() -> None:
    text = ('[a](nowhere.md) [b](docs/model.md#nowhere) [c](#nowhere) ![d](docs/images/nowhere.png)'
            ' [good](docs/security.md#sros-2) [good](#stickslip) [good](https://example.org/x) `[code](nowhere)`')
    assert broken(ROOT / 'README.md', text) == ['nowhere.md', 'docs/model.md#nowhere', '#nowhere',
                                                'docs/images/nowhere.png']


def test_every_page_of_the_docs_is_on_their_front_page() -> None:
    front = (ROOT / 'docs/index.md').read_text(encoding='utf-8')
    assert {page.name for page in (ROOT / 'docs').glob('*.md')} - {'index.md'} == {
        link for link in _LINK.findall(front) if link.endswith('.md')}


def test_the_site_is_made_without_a_warning(tmp_path: Path) -> None:
    """As `make docs` does it.  (mkdocs --quiet would not even count its warnings.)"""
    done = subprocess.run([sys.executable, '-m', 'mkdocs', 'build', '--site-dir', tmp_path], cwd=ROOT, timeout=60,
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert 'WARNING' not in done.stderr
    assert (tmp_path / 'index.html').is_file()
