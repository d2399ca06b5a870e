# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`python3 -m dev.links` finds links that lead nowhere in the pages outside docs/, and named paths where no file is.

MkDocs checks the links within docs/ (`mkdocs build`).  Nothing outside the repository is looked at.
"""

import re
import sys
from pathlib import Path

from .files import ROOT, files

_FENCE = re.compile(r'^```.*?^```', re.MULTILINE | re.DOTALL)
_LINK = re.compile(r'`[^`\n]*`|\]\((?![a-z]+:)([^)#\s]*)#?([^)\s]*)\)')
_HEADING = re.compile(r'^#+ +(.*)$', re.MULTILINE)
_PATH = re.compile(r'(?<![\w/.*-])(?:\.ci|\.github|benchmarks|dev|docker|docs|examples|ros2_ws|stickslip_msgs'
                   r'|stickslip_sim|tests)/[\w/.-]*\.(?:csv|in|json|md|msg|png|py|srv|svg|txt|xacro|xml|ya?ml)\b')


def headings(page: Path) -> set[str]:
    """Return the anchors of a page's headings, as GitHub and MkDocs name them."""
    text = _FENCE.sub('', page.read_text(encoding='utf-8'))
    return {re.sub(r'[^\w\- ]', '', heading.lower()).strip().replace(' ', '-') for heading in _HEADING.findall(text)}


def broken_links(page: Path, text: str) -> list[str]:
    """Return the links in the text of a page that lead nowhere."""
    targets = [(page.parent / place if place else page, anchor, f'{place}#{anchor}'.rstrip('#'))
               for place, anchor in _LINK.findall(_FENCE.sub('', text)) if place or anchor]
    return [link for target, anchor, link in targets
            if not target.exists() or (anchor and anchor not in headings(target))]


def missing_paths(text: str) -> list[str]:
    """Return the paths that a text names, from the top of the repository or of the package, where nothing is."""
    return sorted({path for path in _PATH.findall(text)
                   if not (ROOT / path).exists() and not (ROOT / 'stickslip_sim' / path).exists()})


def main() -> int:
    """Print what leads nowhere; return the exit code."""
    wrong = [f'{page.relative_to(ROOT)}: the link {link} leads nowhere' for page in files('*.md', ':!docs')
             for link in broken_links(page, page.read_text(encoding='utf-8'))]
    # Tests name files that are not there on purpose; a changelog names those of its time.
    wrong += [f'{file.relative_to(ROOT)}: there is no {path}'
              for file in files(':!tests', ':!CHANGELOG.md', ':!*/CHANGELOG.rst', ':!*.png', ':!*.svg')
              for path in missing_paths(file.read_text(encoding='utf-8'))]
    print(*wrong, sep='\n', file=sys.stderr, end='\n' if wrong else '')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
