# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of the pages can be given one after the other in one folder, whichever page comes first."""

import re
from collections import Counter

from tests.support.repository import ROOT

NEW_FOLDER = re.compile(r'stickslip(?:_sim)? (?:compare|sweep|uncertainty|import|verify)\b[^`|#\n]*?'
                        r' --out (?P<name>\S+?)[`\s]')


def folders() -> Counter[str]:
    """Return how often a page makes each folder."""
    found: Counter[str] = Counter()
    for page in sorted((ROOT / 'docs').glob('*.md')):
        text = page.read_text(encoding='utf-8').replace('\\\n', ' ')
        found.update(match['name'] for match in NEW_FOLDER.finditer(text) if not match['name'].isupper())
    return found


def test_no_two_commands_make_the_same_folder() -> None:
    """What is there is never overwritten: the second one would be refused."""
    found = folders()
    assert {'my_axis_map', 'my_run_figures', 'slippery', 'runs/maps/load', 'measured'} <= set(found)
    assert [name for name, count in found.items() if count > 1] == []
