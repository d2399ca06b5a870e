# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Links within the repository: every file, folder and heading that a page points to is there.  No network."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
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


def test_what_is_broken_is_found() -> None:
    text = ('[a](nowhere.md) [b](docs/model.md#nowhere) [c](#nowhere) ![d](docs/images/nowhere.png)'
            ' [good](docs/security.md#sros-2) [good](#stickslip) [good](https://example.org/x) `[code](nowhere)`')
    assert broken(ROOT / 'README.md', text) == ['nowhere.md', 'docs/model.md#nowhere', '#nowhere',
                                                'docs/images/nowhere.png']


def test_every_page_of_the_docs_is_on_their_front_page() -> None:
    front = (ROOT / 'docs/index.md').read_text(encoding='utf-8')
    assert {page.name for page in (ROOT / 'docs').glob('*.md')} - {'index.md'} == {
        link for link in _LINK.findall(front) if link.endswith('.md')}
