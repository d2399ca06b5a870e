# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a page that a program writes, between markers."""

import pathlib


def replace_generated(page: pathlib.Path, text: str, name: str = 'generated') -> None:
    """Put the text between the markers `<!-- NAME: begin -->` and `<!-- NAME: end -->` of a page."""
    begin, end = f'<!-- {name}: begin -->', f'<!-- {name}: end -->'
    before, found, rest = page.read_text(encoding='utf-8').partition(begin)
    _, closed, after = rest.partition(end)
    if not found or not closed:
        raise SystemExit(f'{page} lacks {begin} or {end}')
    page.write_text(f'{before}{begin}\n\n{text}\n{end}{after}', encoding='utf-8')
    print(f'written: {page}, {name}')
