# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""CONTRIBUTING.md: its table of rooms has those of the package, in groups of floors."""

import re
from itertools import chain, pairwise

from tests.support.floors import floors
from tests.support.repository import ROOT


def test_the_rooms_are_those_of_the_floors() -> None:
    """From the top, as import-linter keeps them; __main__ is no room."""
    rooms = floors('stickslip_sim')[1:]
    page = (ROOT / 'CONTRIBUTING.md').read_text(encoding='utf-8')
    _, _, table = page.partition('| floors in groups, from the top | rooms |\n|---|---|\n')
    shown = [re.findall(r'`(\w+)`', row) for row in table.partition('\n\n')[0].splitlines()]
    assert sorted(chain(*shown)) == sorted(chain(*rooms))
    # A group of the table is one or more floors of the contract, whole.
    order = {room: number for number, floor in enumerate(rooms) for room in floor}
    assert [max(order[room] for room in row) < min(order[room] for room in following)
            for row, following in pairwise(shown)] == [True] * (len(shown) - 1)
