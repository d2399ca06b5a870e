# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`python3 -m dev.links`: every file and heading that a page links to is there, and every path that a text names.

Looks at nothing outside of the repository.
"""

import re
import sys
from pathlib import Path

from .files import ROOT, texts

_CODE = re.compile(r'^```.*?^```|`[^`\n]*`', re.MULTILINE | re.DOTALL)
_FENCE = re.compile(r'^```.*?^```', re.MULTILINE | re.DOTALL)
_LINK = re.compile(r'!?\[[^\]]*\]\(([^)\s]+)\)')
_HEADING = re.compile(r'^#+ +(.*)$', re.MULTILINE)
_FOLDERS = ('.ci', '.github', 'benchmarks', 'dev', 'docker', 'docs', 'examples', 'ros2_ws', 'stickslip_msgs',
            'stickslip_sim', 'tests')
_PATH = re.compile(r'(?<![\w/.*-])(?:' + '|'.join(map(re.escape, _FOLDERS)) +
                   r')/[\w/.-]*\.(?:csv|in|json|md|msg|png|py|srv|svg|txt|xacro|xml|ya?ml)\b')


def links(text: str) -> list[str]:
    """Return where the links of a page lead."""
    return _LINK.findall(_CODE.sub('', text))


def headings(page: Path) -> set[str]:
    """Return the headings of a page as GitHub and MkDocs name them."""
    text = _FENCE.sub('', page.read_text(encoding='utf-8'))
    return {re.sub(r'[^\w\- ]', '', heading.lower()).strip().replace(' ', '-') for heading in _HEADING.findall(text)}


def broken(page: Path, text: str) -> list[str]:
    """Return the links in the text of a page that lead nowhere."""
    found = []
    for link in links(text):
        if re.match(r'[a-z]+:', link):    # elsewhere
            continue
        place, _, heading = link.partition('#')
        target = page.parent / place if place else page
        if not target.exists() or (heading and heading not in headings(target)):
            found.append(link)
    return found


def missing(text: str) -> list[str]:
    """Return the paths that a text names, from the top of the repository or of the package, where nothing is."""
    return sorted({path for path in _PATH.findall(text)
                   if not (ROOT / path).exists() and not (ROOT / 'stickslip_sim' / path).exists()})


def main() -> int:
    """Print what leads nowhere; return the exit code."""
    wrong = [(page, f'the link {link} leads nowhere') for page in texts('*.md')
             for link in broken(page, page.read_text(encoding='utf-8'))]
    # Tests name files that are not there on purpose.
    wrong += [(file, f'there is no {path}') for file in texts(':!tests', ':!CHANGELOG.md', ':!*/CHANGELOG.rst')
              for path in missing(file.read_text(encoding='utf-8'))]
    for file, fault in wrong:
        print(f'{file.relative_to(ROOT)}: {fault}', file=sys.stderr)
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
